//! As rigid as possible.
//!
//! ```text
//! ψ = w/2 |F − R|²,   R the rotation nearest to F
//! ```
//!
//! The energy of projective dynamics (Bouaziz et al. 2014): its local step is the rotation, its global step linear with
//! a matrix that never changes.

use super::Energy;
use super::corotated::Corotated;
use crate::fem::material::Lame;

/// Cloth of springs in every direction, without a resistance to compression of its own.
#[derive(Clone, Copy, Debug)]
pub struct Arap(Corotated);

impl Arap {
    /// With the weight `w`, Pa.
    #[must_use]
    pub fn new(weight: f64) -> Self {
        Self(Corotated::new(Lame { mu: 0.5 * weight, lambda: 0.0 }))
    }
}

impl Energy for Arap {
    fn density(&self, s: [f64; 3]) -> f64 {
        self.0.density(s)
    }

    fn gradient(&self, s: [f64; 3]) -> [f64; 3] {
        self.0.gradient(s)
    }

    fn second(&self, s: [f64; 3]) -> [[f64; 3]; 3] {
        self.0.second(s)
    }

    fn flip(&self, s: [f64; 3], k: usize) -> f64 {
        self.0.flip(s, k)
    }

    fn twist(&self, s: [f64; 3], k: usize) -> f64 {
        self.0.twist(s, k)
    }
}
