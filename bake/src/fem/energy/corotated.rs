//! Co-rotated linear.
//!
//! ```text
//! ψ = μ|F − R|² + λ/2 tr(RᵀF − I)²,   R the rotation nearest to F
//! ```
//!
//! Linear elasticity in a frame that turns along (Müller, Gross 2004; the form of Sifakis, Barbič 2012). Where two
//! stretches cancel there is no nearest rotation and a twist has no stiffness: it is bounded there.

use super::{Energy, others};
use crate::fem::material::Lame;

/// A sum of two stretches counts as not below this.
const LEAST_SUM: f64 = 1e-6;

/// Linear flesh that turns.
#[derive(Clone, Copy, Debug)]
pub struct Corotated(Lame);

impl Corotated {
    /// With Lamé's parameters.
    #[must_use]
    pub fn new(material: Lame) -> Self {
        Self(material)
    }

    /// `λ tr(RᵀF − I)`.
    fn even(&self, [a, b, c]: [f64; 3]) -> f64 {
        self.0.lambda * (a + b + c - 3.0)
    }
}

impl Energy for Corotated {
    fn density(&self, s: [f64; 3]) -> f64 {
        let shear: f64 = s.iter().map(|s| (s - 1.0) * (s - 1.0)).sum();
        let trace: f64 = s.iter().sum::<f64>() - 3.0;
        self.0.mu * shear + 0.5 * self.0.lambda * trace * trace
    }

    fn gradient(&self, s: [f64; 3]) -> [f64; 3] {
        let even = self.even(s);
        s.map(|s| 2.0 * self.0.mu * (s - 1.0) + even)
    }

    fn second(&self, _: [f64; 3]) -> [[f64; 3]; 3] {
        let Lame { mu, lambda } = self.0;
        [0, 1, 2].map(|i| [0, 1, 2].map(|j| if i == j { 2.0 * mu + lambda } else { lambda }))
    }

    fn flip(&self, _: [f64; 3], _: usize) -> f64 {
        2.0 * self.0.mu
    }

    fn twist(&self, s: [f64; 3], k: usize) -> f64 {
        let (_, sum) = others(s, k);
        2.0 * self.0.mu + 2.0 * (self.even(s) - 2.0 * self.0.mu) / sum.max(LEAST_SUM)
    }
}
