//! Springs of no length, from nodes to places.
//!
//! ```text
//! E = Σ kᵢ/2 |xᵢ − yᵢ|²
//! ```

use super::Potential;
use crate::fem::assembly::Assembly;
use glam::{DMat3, DVec3};

/// One spring.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spring {
    /// Node at its end.
    pub node: u32,
    /// Stiffness `k`, N/m.
    pub stiffness: f64,
    /// Where it pulls to, `y`.
    pub to: DVec3,
}

/// Springs that hold flesh to bones without nailing it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Pull {
    /// All of them.
    pub springs: Vec<Spring>,
}

impl Potential for Pull {
    fn stencils(&self, _visit: &mut dyn FnMut(&[u32])) {}

    fn energy(&self, x: &[DVec3]) -> f64 {
        let of = |s: &Spring| 0.5 * s.stiffness * x[s.node as usize].distance_squared(s.to);
        self.springs.iter().map(of).sum()
    }

    fn gradient(&self, x: &[DVec3], out: &mut [DVec3]) {
        for Spring { node, stiffness, to } in &self.springs {
            out[*node as usize] += *stiffness * (x[*node as usize] - *to);
        }
    }

    fn hessian(&self, _x: &[DVec3], _projected: bool, out: &mut Assembly<'_>) {
        for s in &self.springs {
            out.add(s.node, s.node, DMat3::from_diagonal(DVec3::splat(s.stiffness)));
        }
    }
}
