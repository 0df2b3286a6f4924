//! Parts of the energy of a body: all that pushes and pulls its nodes.
//!
//! ```text
//! E(x) = Σ E_k(x),   force = −∂E/∂x
//! ```
//!
//! A solver minimizes a list of them and knows none. Each adds to what is handed in, over all nodes; which of them are
//! free is the solver's matter.

pub mod contact;
pub mod inertia;
pub mod load;
pub mod pull;
pub mod shell;
pub mod solid;
pub mod warped;

use super::assembly::Assembly;
use glam::DVec3;

/// An energy of the places of nodes.
pub trait Potential: Sync {
    /// Calls `visit` with the nodes of each stencil: those that share a Hessian.
    fn stencils(&self, visit: &mut dyn FnMut(&[u32]));

    /// `E(x)`, J.
    fn energy(&self, x: &[DVec3]) -> f64;

    /// Adds `∂E/∂x`, N, to `out`.
    fn gradient(&self, x: &[DVec3], out: &mut [DVec3]);

    /// Adds `∂²E/∂x²`, N/m, to `out`, or the nearest positive semi-definite one of each stencil.
    fn hessian(&self, x: &[DVec3], projected: bool, out: &mut Assembly<'_>);

    /// Calls `visit` with the nodes of each stencil that is there at `x` and not everywhere: of what touches.
    fn touching(&self, _x: &[DVec3], _visit: &mut dyn FnMut(&[u32])) {}

    /// The largest part of the step `d` of all nodes from `x`, at most 1, with which nothing meets that must not.
    fn limit(&self, _x: &[DVec3], _d: &[DVec3]) -> f64 {
        1.0
    }

    /// How many of its elements are inside out.
    fn inverted(&self, _x: &[DVec3]) -> usize {
        0
    }
}

/// The sum of the energies.
#[must_use]
pub fn energy(potentials: &[&dyn Potential], x: &[DVec3]) -> f64 {
    potentials.iter().map(|p| p.energy(x)).sum()
}

/// The sum of the gradients, N a node.
#[must_use]
pub fn gradient(potentials: &[&dyn Potential], x: &[DVec3]) -> Vec<DVec3> {
    let mut out = vec![DVec3::ZERO; x.len()];
    potentials.iter().for_each(|p| p.gradient(x, &mut out));
    out
}

/// The largest part of a step that all of them allow, at most 1.
#[must_use]
pub fn limit(potentials: &[&dyn Potential], x: &[DVec3], d: &[DVec3]) -> f64 {
    potentials.iter().map(|p| p.limit(x, d)).fold(1.0, f64::min)
}

/// Whether it has stencils at `x` that are not there everywhere.
#[must_use]
pub fn is_touching(potential: &dyn Potential, x: &[DVec3]) -> bool {
    let mut any = false;
    potential.touching(x, &mut |_| any = true);
    any
}
