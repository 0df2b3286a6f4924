//! The Laplacian of elements, one number a pair of nodes, and its Cholesky factor.
//!
//! ```text
//! Lᵢⱼ = Σ_e w V_e gᵢ·gⱼ  + (i = j) mᵢ
//! ```
//!
//! What tells all three coordinates apart is on the right side, so that one factor of a third of the size serves them.

use super::assembly::Free;
use super::cholesky::FactorError;
use super::element::Elements;
use super::stiffness::FIXED;
use faer::linalg::solvers::Solve;
use faer::sparse::linalg::solvers::Llt;
use faer::sparse::{SparseColMat, Triplet};
use faer::{Mat, Side};
use glam::DVec3;

/// The factor, for one set of free nodes.
#[derive(Clone, Debug)]
pub struct Laplacian {
    free: Free,
    factor: Llt<usize, f64>,
}

impl Laplacian {
    /// Of elements, each with the weight `weight`, and `mass` of each node, which may be none.
    ///
    /// # Errors
    ///
    /// If it is not positive definite, as where a part without a mass has no fixed node, or memory is short.
    pub fn new<const N: usize>(
        elements: &Elements<N>,
        free: Free,
        weight: f64,
        mass: &[f64],
    ) -> Result<Self, FactorError> {
        let row = |i: u32| (free.row[i as usize] != FIXED).then(|| free.row[i as usize] as usize);
        let mut entries = Vec::with_capacity(elements.len() * N * (N + 1) / 2);
        for ((nodes, g), volume) in elements.nodes.iter().zip(&elements.gradients).zip(&elements.volumes) {
            for (i, gi) in nodes.iter().zip(g) {
                for (j, gj) in nodes.iter().zip(g) {
                    if let (Some(i), Some(j)) = (row(*i), row(*j))
                        && i >= j
                    {
                        entries.push(Triplet::new(i, j, weight * volume * gi.dot(*gj)));
                    }
                }
            }
        }
        let masses = free.node.iter().enumerate().filter_map(|(r, i)| Some((r, *mass.get(*i as usize)?)));
        entries.extend(masses.map(|(r, m)| Triplet::new(r, r, m)));
        let n = free.node.len();
        let matrix =
            SparseColMat::<usize, f64>::try_new_from_triplets(n, n, &entries).map_err(|_| FactorError)?;
        let factor = matrix.sp_cholesky(Side::Lower).map_err(|_| FactorError)?;
        Ok(Self { free, factor })
    }

    /// Which nodes move.
    #[must_use]
    pub const fn free(&self) -> &Free {
        &self.free
    }

    /// Moves the free nodes of `x` by `L⁻¹ b`, with `b` of all nodes.
    pub fn correct(&self, x: &mut [DVec3], b: &[DVec3]) {
        let node = |r: usize| self.free.node[r] as usize;
        let right = Mat::from_fn(self.free.node.len(), 3, |r, c| b[node(r)][c]);
        let found = self.factor.solve(&right);
        for r in 0..self.free.node.len() {
            x[node(r)] += DVec3::new(found[(r, 0)], found[(r, 1)], found[(r, 2)]);
        }
    }
}
