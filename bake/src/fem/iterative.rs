//! Newton's directions by conjugate gradients with a multigrid cycle.
//!
//! ```text
//! ‖K d − r‖ in the preconditioner's norm ≤ 10⁻¹⁰ of ‖r‖
//! ```
//!
//! The runtime's own solver on blocks of 3×3, in f64. Grids follow from the pattern of `K`, as if all couplings were
//! alike; so a solution depends on `K` and `r` alone.

use super::cholesky::FactorError;
use super::stiffness::Stiffness;
use crate::multigrid::{Grids, Matrix, Scratch};
use glam::{DMat3, DVec3};
use sinew::kernel::cg::{End, Until};

/// Share of the residual at which a direction is good.
const SHARE: f64 = 1e-10;
/// Most iterations: far more than a sound matrix takes.
const ITERATIONS: usize = 400;

/// A 3×3 block, by rows.
type Block = [[f64; 3]; 3];

/// Grids for a [`Stiffness`].
#[derive(Debug)]
pub struct Iterative {
    grids: Grids<Block>,
    /// Of each entry of the whole matrix: its block in the lower triangle, and whether that is transposed.
    sources: Vec<(usize, bool)>,
    scratch: Scratch<[f64; 3]>,
    b: Vec<[f64; 3]>,
    x: Vec<[f64; 3]>,
    /// Iterations of the last solution.
    pub iterations: usize,
}

impl Iterative {
    /// For matrices with the pattern of `k`.
    #[must_use]
    pub fn new(k: &Stiffness) -> Self {
        let whole = whole(k);
        let numbers = alike(&whole);
        let grids = Grids::new(whole.map(|_| [[0.0; 3]; 3]), numbers);
        Self {
            scratch: grids.scratch(),
            grids,
            sources: whole.entries,
            b: vec![[0.0; 3]; k.len()],
            x: vec![[0.0; 3]; k.len()],
            iterations: 0,
        }
    }

    /// Rows of each grid, finest first.
    #[must_use]
    pub fn rows(&self) -> Vec<usize> {
        self.grids.rows()
    }

    /// Takes the numbers of `k`, which has the pattern of that at the beginning.
    ///
    /// # Errors
    ///
    /// If it is seen not to be positive definite.
    pub fn factorize(&mut self, k: &Stiffness) -> Result<(), FactorError> {
        let (_, _, blocks) = k.parts();
        for (entry, (source, transposed)) in self.grids.entries().iter_mut().zip(&self.sources) {
            let columns = blocks[*source];
            *entry = if *transposed { columns } else { columns.transpose() }.to_cols_array_2d();
        }
        self.grids.update().map_err(|_| FactorError)
    }

    /// Replaces `x` by `K⁻¹ x`.
    ///
    /// # Errors
    ///
    /// If the matrix turns out not to be positive definite, or the solution is not good after many iterations.
    pub fn solve(&mut self, x: &mut [DVec3]) -> Result<(), FactorError> {
        self.b.iter_mut().zip(x.iter()).for_each(|(b, x)| *b = x.to_array());
        self.x.fill([0.0; 3]);
        let until = Until { share: SHARE, iterations: ITERATIONS };
        let (iterations, end) = self.grids.solve(&self.b, &mut self.x, until, &mut self.scratch);
        self.iterations = iterations;
        x.iter_mut().zip(&self.x).for_each(|(x, found)| *x = DVec3::from_array(*found));
        if end == End::Converged { Ok(()) } else { Err(FactorError) }
    }
}

/// Both triangles: where each block comes from.
fn whole(k: &Stiffness) -> Matrix<(usize, bool)> {
    let mut rows: Vec<Vec<(usize, (usize, bool))>> = vec![Vec::new(); k.len()];
    let mut at = 0;
    k.each(|row, column, _: &DMat3| {
        let (i, j) = (row as usize, column as usize);
        rows[i].push((j, (at, false)));
        if i != j {
            rows[j].push((i, (at, true)));
        }
        at += 1;
    });
    let mut out = Matrix::new(k.len());
    rows.iter_mut().for_each(|row| out.push(row));
    out
}

/// The Laplacian of the graph, with a little more on the diagonal.
fn alike(whole: &Matrix<(usize, bool)>) -> Matrix<f64> {
    let mut out = whole.map(|_| -1.0);
    for i in 0..whole.rows() {
        let range = whole.starts[i] as usize..whole.starts[i + 1] as usize;
        #[expect(clippy::cast_precision_loss, reason = "neighbors of a node")]
        let degree = range.len() as f64;
        let own = whole.columns[range.clone()].iter().position(|j| *j as usize == i);
        if let Some(own) = own {
            out.entries[range.start + own] = degree;
        }
    }
    out
}
