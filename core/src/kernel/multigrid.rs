//! A multigrid cycle as preconditioner.
//!
//! ```text
//! z = (D + L)⁻¹ r                          forward Gauss–Seidel from 0
//! z ← z + P Aᶜ⁻¹ Pᵀ (r − A z)              Aᶜ = Pᵀ A P, by the same cycle; at the end by its factor
//! z ← z + (D + Lᵀ)⁻¹ (r − A z)             backward Gauss–Seidel
//! ```
//!
//! With `A = L + D + Lᵀ`. The two sweeps are each other's transpose, so that the cycle is symmetric. After the first
//! `r − A z = −Lᵀ z`. Smoothed aggregation (Vaněk, Mandel, Brezina 1996) makes `P`.

use super::block::{Block, Times, Unknown};
use super::cg::Preconditioner;
use super::csr::Csr;
use super::ldl;

/// One grid and the way to the next coarser one.
#[derive(Clone, Copy, Debug)]
pub struct Level<'a, A: Block> {
    /// The matrix.
    pub a: Csr<'a, A>,
    /// Inverses of the blocks on its diagonal.
    pub inverse: &'a [A],
    /// `P`, from the coarser grid.
    pub prolongation: Csr<'a, <A as Unknown>::Real>,
    /// `Pᵀ`.
    pub restriction: Csr<'a, <A as Unknown>::Real>,
}

/// Grids, finest first.
#[derive(Debug)]
pub struct Multigrid<'a, A: Block> {
    /// All but the coarsest.
    pub levels: &'a [Level<'a, A>],
    /// Rows of the coarsest.
    pub coarsest: usize,
    /// Its [factor](ldl::factorize).
    pub factor: &'a [A],
    /// [`required_len`] entries.
    pub memory: &'a mut [A::Unknown],
}

/// Entries of a cycle's memory, for grids with so many rows, finest first: a residual for each but the last, a right side
/// and a solution for each but the first.
#[must_use]
pub fn required_len(rows: &[usize]) -> usize {
    let all: usize = rows.iter().sum();
    3 * all - 2 * rows.first().copied().unwrap_or(0) - rows.last().copied().unwrap_or(0)
}

impl<A: Block> Preconditioner<A::Unknown> for Multigrid<'_, A>
where
    <A as Unknown>::Real: Times<A::Unknown>,
{
    fn precondition(&mut self, r: &[A::Unknown], z: &mut [A::Unknown]) {
        cycle(self.levels, (self.factor, self.coarsest), r, z, self.memory);
    }
}

fn cycle<A: Block>(
    levels: &[Level<'_, A>],
    coarsest: (&[A], usize),
    r: &[A::Unknown],
    z: &mut [A::Unknown],
    memory: &mut [A::Unknown],
) where
    <A as Unknown>::Real: Times<A::Unknown>,
{
    let Some((level, coarser)) = levels.split_first() else {
        z.copy_from_slice(r);
        ldl::solve(coarsest.0, coarsest.1, z);
        return;
    };
    let (residual, memory) = memory.split_at_mut(level.a.rows());
    let (r_coarse, memory) = memory.split_at_mut(level.restriction.rows());
    let (z_coarse, memory) = memory.split_at_mut(level.restriction.rows());
    forward(level, r, z);
    left(level, z, residual);
    level.restriction.multiply(residual, r_coarse);
    cycle(coarser, coarsest, r_coarse, z_coarse, memory);
    level.prolongation.multiply_add(z_coarse, z);
    backward(level, r, z);
}

/// `z = (D + L)⁻¹ r`.
fn forward<A: Block>(level: &Level<'_, A>, r: &[A::Unknown], z: &mut [A::Unknown]) {
    for i in 0..z.len() {
        let before = level.a.row(i).take_while(|(j, _)| *j < i);
        let rest = before.fold(r[i], |rest, (j, a)| rest.minus(a.times(z[j])));
        z[i] = level.inverse[i].times(rest);
    }
}

/// `−Lᵀ z`: what a sweep forward leaves.
fn left<A: Block>(level: &Level<'_, A>, z: &[A::Unknown], residual: &mut [A::Unknown]) {
    for (i, residual) in residual.iter_mut().enumerate() {
        let after = level.a.row(i).rev().take_while(|(j, _)| *j > i);
        *residual = after.fold(Unknown::ZERO, |rest: A::Unknown, (j, a)| rest.minus(a.times(z[j])));
    }
}

/// `z ← z + (D + Lᵀ)⁻¹ (r − A z)`.
fn backward<A: Block>(level: &Level<'_, A>, r: &[A::Unknown], z: &mut [A::Unknown]) {
    for i in (0..z.len()).rev() {
        let others = level.a.row(i).filter(|(j, _)| *j != i);
        let rest = others.fold(r[i], |rest, (j, a)| rest.minus(a.times(z[j])));
        z[i] = level.inverse[i].times(rest);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kernel::cg::{self, End, Memory, Until};

    /// A path of 8 links with fixed ends, and its halves: the exact inverse on the coarser grid's part.
    const A: Csr<'_, f64> = Csr {
        starts: &[0, 2, 5, 8, 11, 14, 17, 19],
        columns: &[0, 1, 0, 1, 2, 1, 2, 3, 2, 3, 4, 3, 4, 5, 4, 5, 6, 5, 6],
        entries: &[
            2.0, -1.0, -1.0, 2.0, -1.0, -1.0, 2.0, -1.0, -1.0, 2.0, -1.0, -1.0, 2.0, -1.0, -1.0, 2.0, -1.0,
            -1.0, 2.0,
        ],
    };
    const P: Csr<'_, f64> = Csr {
        starts: &[0, 1, 2, 4, 5, 7, 8, 9],
        columns: &[0, 0, 0, 1, 1, 1, 2, 2, 2],
        entries: &[0.5, 1.0, 0.5, 0.5, 1.0, 0.5, 0.5, 1.0, 0.5],
    };
    const R: Csr<'_, f64> = Csr {
        starts: &[0, 3, 6, 9],
        columns: &[0, 1, 2, 2, 3, 4, 4, 5, 6],
        entries: &[0.5, 1.0, 0.5, 0.5, 1.0, 0.5, 0.5, 1.0, 0.5],
    };

    fn with<T>(run: impl FnOnce(&mut Multigrid<'_, f64>) -> T) -> T {
        // Pᵀ A P of a path is that of half its links, halved.
        let mut factor = [1.0, -0.5, 0.0, -0.5, 1.0, -0.5, 0.0, -0.5, 1.0];
        assert!(ldl::factorize(&mut factor, 3));
        let levels = [Level { a: A, inverse: &[0.5; 7], prolongation: P, restriction: R }];
        let mut memory = [0.0; 13];
        assert_eq!(required_len(&[7, 3]), memory.len());
        run(&mut Multigrid { levels: &levels, coarsest: 3, factor: &factor, memory: &mut memory })
    }

    #[test]
    fn a_cycle_is_symmetric_and_positive() {
        let inverse: [[f64; 7]; 7] = with(|m| {
            core::array::from_fn(|i| {
                let (mut r, mut z) = ([0.0; 7], [0.0; 7]);
                r[i] = 1.0;
                m.precondition(&r, &mut z);
                z
            })
        });
        for (i, row) in inverse.iter().enumerate() {
            assert!(row[i] > 0.0, "{i}");
            for (j, other) in inverse.iter().enumerate() {
                assert!((row[j] - other[i]).abs() < 1e-15, "{i} {j}");
            }
        }
    }

    /// A few cycles do what takes as many steps as half the unknowns without.
    #[test]
    fn cycles_shorten_the_way() {
        let b = [1.0, -2.0, 0.5, 3.0, 1.0, 0.0, -1.0];
        let until = Until { share: 1e-3, iterations: 7 };
        let (mut x, mut memory) = ([0.0; 7], [0.0; 28]);
        let found = with(|m| cg::solve(&A, m, &b, &mut x, until, &mut Memory::new(&mut memory)));
        assert!(found.0 <= 3 && found.1 == End::Converged, "{found:?}");
        let mut back = [0.0; 7];
        A.multiply(&x, &mut back);
        assert!(back.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-2), "{back:?}");
    }
}
