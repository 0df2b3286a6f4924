//! Newton's directions by a sparse Cholesky factor.
//!
//! ```text
//! P K Pᵀ = L Lᵀ
//! ```
//!
//! The order `P` and the structure of `L` follow from the pattern of `K` and are kept; numbers alone change.

use super::stiffness::Stiffness;
use faer::dyn_stack::{MemBuffer, MemStack};
use faer::sparse::linalg::cholesky::{LltRef, SymbolicCholesky, factorize_symbolic_cholesky};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMatRef};
use faer::{Conj, MatMut, Par, Side};
use glam::DVec3;

/// A matrix has no factor: it is not positive definite, or too large.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("the stiffness matrix has no Cholesky factor")]
pub struct FactorError;

/// The factor of a [`Stiffness`].
pub struct Cholesky {
    /// The lower triangle by scalars, as the factorization reads it.
    columns: Vec<usize>,
    rows: Vec<usize>,
    numbers: Vec<f64>,
    symbolic: SymbolicCholesky<usize>,
    factor: Vec<f64>,
    memory: MemBuffer,
    parallel: Par,
}

impl Cholesky {
    /// For matrices with the pattern of `k`. With [`Par::Seq`] the same bits on every run; several threads may sum in
    /// another order.
    ///
    /// # Errors
    ///
    /// If there is not memory enough.
    pub fn new(k: &Stiffness, parallel: Par) -> Result<Self, FactorError> {
        let (columns, rows) = by_scalars(k);
        let n = columns.len() - 1;
        let view = SymbolicSparseColMatRef::new_checked(n, n, &columns, None, &rows);
        let symbolic = factorize_symbolic_cholesky(view, Side::Lower, Default::default(), Default::default())
            .map_err(|_| FactorError)?;
        let scratch = symbolic.factorize_numeric_llt_scratch::<f64>(parallel, Default::default());
        let solve = symbolic.solve_in_place_scratch::<f64>(1, parallel);
        let memory = MemBuffer::try_new(scratch.or(solve)).map_err(|_| FactorError)?;
        let (numbers, factor) = (vec![0.0; rows.len()], vec![0.0; symbolic.len_val()]);
        Ok(Self { columns, rows, numbers, symbolic, factor, memory, parallel })
    }

    /// Numbers in the factor.
    #[must_use]
    pub fn len(&self) -> usize {
        self.factor.len()
    }

    /// Whether there is nothing to solve for.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.factor.is_empty()
    }

    /// Computes the factor of `k`, which has the pattern of that at the beginning.
    ///
    /// # Errors
    ///
    /// If it is not positive definite.
    pub fn factorize(&mut self, k: &Stiffness) -> Result<(), FactorError> {
        let (columns, _, blocks) = k.parts();
        let mut at = 0;
        for range in columns.windows(2) {
            for c in 0..3 {
                for (i, block) in blocks[range[0]..range[1]].iter().enumerate() {
                    let numbers = &block.col(c).to_array()[if i == 0 { c } else { 0 }..];
                    self.numbers[at..at + numbers.len()].copy_from_slice(numbers);
                    at += numbers.len();
                }
            }
        }
        if !self.numbers.iter().all(|x| x.is_finite()) {
            return Err(FactorError);
        }
        let n = self.columns.len() - 1;
        let pattern = SymbolicSparseColMatRef::new_checked(n, n, &self.columns, None, &self.rows);
        let matrix = SparseColMatRef::new(pattern, &self.numbers);
        let stack = MemStack::new(&mut self.memory);
        let (factor, parallel) = (&mut self.factor, self.parallel);
        self.symbolic
            .factorize_numeric_llt(
                factor,
                matrix,
                Side::Lower,
                Default::default(),
                parallel,
                stack,
                Default::default(),
            )
            .map_err(|_| FactorError)?;
        Ok(())
    }

    /// Replaces `x` by `K⁻¹ x`, with the factor of the last [`factorize`](Self::factorize).
    pub fn solve(&mut self, x: &mut [DVec3]) {
        let mut flat: Vec<f64> = x.iter().flat_map(|v| v.to_array()).collect();
        let columns = MatMut::from_column_major_slice_mut(&mut flat, 3 * x.len(), 1);
        let stack = MemStack::new(&mut self.memory);
        let factor = LltRef::new(&self.symbolic, &self.factor);
        factor.solve_in_place_with_conj(Conj::No, columns, self.parallel, stack);
        for (x, numbers) in x.iter_mut().zip(flat.as_chunks().0) {
            *x = DVec3::from_array(*numbers);
        }
    }
}

impl core::fmt::Debug for Cholesky {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        write!(f, "Cholesky factor of {} rows, {} numbers", self.columns.len() - 1, self.factor.len())
    }
}

/// Begin of columns and rows of the lower triangle.
fn by_scalars(k: &Stiffness) -> (Vec<usize>, Vec<usize>) {
    let (columns, rows, _) = k.parts();
    let (mut scalar_columns, mut scalar_rows) = (vec![0], Vec::new());
    for range in columns.windows(2) {
        for c in 0..3 {
            for (i, row) in rows[range[0]..range[1]].iter().enumerate() {
                let first = if i == 0 { c } else { 0 };
                scalar_rows.extend((first..3).map(|r| 3 * *row as usize + r));
            }
            scalar_columns.push(scalar_rows.len());
        }
    }
    (scalar_columns, scalar_rows)
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DMat3;

    /// A chain of nodes between fixed ends: what is multiplied is solved again.
    #[test]
    fn what_is_multiplied_is_solved() {
        let n = 7_u32;
        let pairs: Vec<(u32, u32)> = (1..n).map(|i| (i - 1, i)).collect();
        let mut k = Stiffness::new(7, &pairs);
        let spring = DMat3::from_cols_array(&[2.0, 0.1, 0.0, 0.1, 3.0, -0.4, 0.0, -0.4, 1.0]);
        for i in 0..n {
            k.add(i, i, 2.0 * spring);
        }
        for (i, j) in &pairs {
            k.add(*j, *i, -spring);
        }
        let x: Vec<DVec3> = (0..n).map(|i| DVec3::new(f64::from(i), 1.0, -0.5 * f64::from(i * i))).collect();
        let mut y = vec![DVec3::ZERO; x.len()];
        k.multiply(&x, &mut y);
        let mut cholesky = Cholesky::new(&k, Par::Seq).expect("memory");
        cholesky.factorize(&k).expect("positive definite");
        cholesky.solve(&mut y);
        for (x, y) in x.iter().zip(&y) {
            assert!((*x - *y).length() < 1e-12, "{x} {y}");
        }
        k.add(3, 3, DMat3::from_diagonal(DVec3::splat(-9.0)));
        assert_eq!(cholesky.factorize(&k), Err(FactorError), "not positive definite");
        k.shift(f64::NAN);
        assert_eq!(cholesky.factorize(&k), Err(FactorError), "not a number");
    }
}
