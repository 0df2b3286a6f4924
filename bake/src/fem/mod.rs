//! Ground truth: finite elements that every system learns from.
//!
//! ```text
//! F = Σ xᵢ gᵢᵀ,   E(x) = Σ_e V_e ψ(F_e)
//! ```
//!
//! Tetrahedra and prisms differ in the number of nodes `i` alone; an energy `ψ` knows nothing of either. All in `f64`,
//! SI units or any others that go together, column vectors.

pub mod assembly;
pub mod blocks;
pub mod cholesky;
pub mod collision;
pub mod drive;
pub mod dynamics;
pub mod element;
pub mod energy;
pub mod iterative;
pub mod laplacian;
pub mod mass;
pub mod material;
pub mod newton;
pub mod poisson;
pub mod potential;
pub mod prism;
pub mod projective;
pub mod solver;
pub mod stiffness;
pub mod surface;
pub mod svd;
