//! How linear systems are solved: by a factor, or by iteration.

use super::cholesky::{Cholesky, FactorError};
use super::iterative::Iterative;
use super::stiffness::Stiffness;
use faer::Par;
use glam::DVec3;

/// Ways to solve.
#[derive(Clone, Copy, Debug)]
pub enum Method {
    /// A sparse Cholesky factor. With [`Par::Seq`] the same bits on every run; several threads may sum in another order.
    Direct(Par),
    /// Conjugate gradients with a multigrid cycle: slower for small bodies, and far less memory for large ones.
    Multigrid,
}

impl Method {
    /// A factor, on one thread.
    pub const DIRECT: Self = Self::Direct(Par::Seq);
}

/// A solver for one pattern.
#[derive(Debug)]
pub enum Solver {
    /// By a factor.
    Direct(Box<Cholesky>),
    /// By iteration.
    Multigrid(Box<Iterative>),
}

impl Solver {
    /// For matrices with the pattern of `k`.
    ///
    /// # Errors
    ///
    /// If there is not memory enough for the factor.
    pub fn new(k: &Stiffness, method: Method) -> Result<Self, FactorError> {
        Ok(match method {
            Method::Direct(parallel) => Self::Direct(Box::new(Cholesky::new(k, parallel)?)),
            Method::Multigrid => Self::Multigrid(Box::new(Iterative::new(k))),
        })
    }

    /// Replaces `x` by `K⁻¹ x`.
    ///
    /// # Errors
    ///
    /// If `k` is seen not to be positive definite.
    pub fn solve(&mut self, k: &Stiffness, x: &mut [DVec3]) -> Result<(), FactorError> {
        match self {
            Self::Direct(factor) => {
                factor.factorize(k)?;
                factor.solve(x);
                Ok(())
            }
            Self::Multigrid(grids) => {
                grids.factorize(k)?;
                grids.solve(x)
            }
        }
    }
}
