//! Grids for the multigrid cycle of [`sinew::kernel::multigrid`], by smoothed aggregation.
//!
//! ```text
//! aggregates ─▶ P = (I − ω D⁻¹ S) P₀ ─▶ Aᶜ = Pᵀ A P ─▶ again, until few rows are left
//! ```
//!
//! Vaněk, Mandel, Brezina, *Algebraic multigrid by smoothed aggregation*, 1996. `P` follows from a matrix of numbers `S`
//! with the pattern of `A`; it and all patterns are found once, and for new numbers in `A` only [`Grids::update`] is needed.

mod aggregate;
mod matrix;
mod product;

pub use matrix::Matrix;

use product::Product;
use sinew::kernel::block::{Block, Times, Unknown};
use sinew::kernel::cg::{self, End, Memory, Until};
use sinew::kernel::ldl;
use sinew::kernel::multigrid::{Level, Multigrid, required_len};

/// Rows that a factor is made of instead of a coarser grid.
const FEW: usize = 40;
/// Share of a grid's rows that the next one may have and be worth its while.
const WORTH: f64 = 0.8;
/// `ω ρ(D⁻¹S)`: the best for a matrix whose eigenvalues spread evenly (Vaněk et al., section 4).
const DAMPING: f64 = 4.0 / 3.0;

/// A matrix is not positive definite.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("the matrix is not positive definite")]
pub struct Indefinite;

/// The grids of one pattern.
#[derive(Clone, Debug)]
pub struct Grids<A: Block> {
    levels: Vec<Grid<A>>,
    /// The coarsest matrix, and its factor.
    last: Matrix<A>,
    factor: Vec<A>,
}

/// What a solution is found in; it holds nothing between two.
#[derive(Clone, Debug)]
pub struct Scratch<V> {
    cycle: Vec<V>,
    gradients: Vec<V>,
}

/// A grid and the way to the next.
#[derive(Clone, Debug)]
struct Grid<A: Block> {
    a: Matrix<A>,
    inverse: Vec<A>,
    prolongation: Matrix<f64>,
    restriction: Matrix<f64>,
    /// `A P`, then `Pᵀ (A P)`, which is the next grid's matrix.
    right: Product<A>,
    left: Product<A>,
}

impl<A: Block> Grids<A>
where
    A: Unknown<Real = f64>,
    f64: Times<A::Unknown>,
{
    /// For matrices with the pattern of `a`; `numbers` is one of numbers, symmetric, whose couplings say what belongs
    /// together.
    #[must_use]
    pub fn new(a: Matrix<A>, mut numbers: Matrix<f64>) -> Self {
        let (mut levels, mut a) = (Vec::new(), a);
        while a.rows() > FEW {
            let prolongation = aggregate::prolongation(&numbers, DAMPING);
            #[expect(clippy::cast_precision_loss, reason = "far fewer than 2^52 rows")]
            if prolongation.width as f64 > WORTH * a.rows() as f64 {
                break;
            }
            let restriction = prolongation.transposed();
            let right = Product::new(&a, &prolongation);
            let left = Product::new(&restriction, &right.matrix);
            let coarse = left.matrix.clone();
            numbers = product::triple(&restriction, &numbers, &prolongation);
            let inverse = vec![A::ZERO; a.rows()];
            levels.push(Grid { a, inverse, prolongation, restriction, right, left });
            a = coarse;
        }
        Self { levels, factor: vec![A::ZERO; a.rows() * a.rows()], last: a }
    }

    /// Rows of each grid, finest first.
    #[must_use]
    pub fn rows(&self) -> Vec<usize> {
        self.levels.iter().map(|l| l.a.rows()).chain([self.last.rows()]).collect()
    }

    /// For [`solve`](Self::solve).
    #[must_use]
    pub fn scratch(&self) -> Scratch<A::Unknown> {
        let rows = self.rows();
        Scratch {
            cycle: vec![A::Unknown::ZERO; required_len(&rows)],
            gradients: vec![A::Unknown::ZERO; 4 * rows[0]],
        }
    }

    /// The entries of the finest matrix, to be changed before an [`update`](Self::update).
    pub fn entries(&mut self) -> &mut [A] {
        &mut self.levels.first_mut().map_or(&mut self.last, |l| &mut l.a).entries
    }

    /// Makes the coarser matrices, and the last one's factor, of the finest's entries.
    ///
    /// # Errors
    ///
    /// If a block on a diagonal, or the coarsest matrix, is not positive definite.
    pub fn update(&mut self) -> Result<(), Indefinite> {
        for at in 0..self.levels.len() {
            let (done, after) = self.levels.split_at_mut(at + 1);
            let Some(grid) = done.last_mut() else { break };
            grid.invert()?;
            grid.right.multiply(&grid.a, &grid.prolongation, |a, p| a.scaled(p));
            grid.left.multiply(&grid.restriction, &grid.right.matrix, |r, a| a.scaled(r));
            let coarse = after.first_mut().map_or(&mut self.last, |next| &mut next.a);
            coarse.entries.copy_from_slice(&grid.left.matrix.entries);
        }
        let n = self.last.rows();
        self.factor.fill(A::ZERO);
        for i in 0..n {
            self.last.view().row(i).for_each(|(j, a)| self.factor[i * n + j] = a);
        }
        if ldl::factorize(&mut self.factor, n) { Ok(()) } else { Err(Indefinite) }
    }

    /// Moves `x` towards `A⁻¹ b` by [conjugate gradients](cg::solve) with a cycle as preconditioner.
    ///
    /// # Panics
    ///
    /// If `b`, `x` or the scratch are not of this matrix's size.
    pub fn solve(
        &self,
        b: &[A::Unknown],
        x: &mut [A::Unknown],
        until: Until<f64>,
        scratch: &mut Scratch<A::Unknown>,
    ) -> (usize, End) {
        let levels: Vec<Level<'_, A>> = self.levels.iter().map(Grid::view).collect();
        let a = self.levels.first().map_or(&self.last, |l| &l.a);
        let mut cycle = Multigrid {
            levels: &levels,
            coarsest: self.last.rows(),
            factor: &self.factor,
            memory: &mut scratch.cycle,
        };
        cg::solve(&a.view(), &mut cycle, b, x, until, &mut Memory::new(&mut scratch.gradients))
    }
}

impl<A: Block> Grid<A>
where
    A: Unknown<Real = f64>,
{
    /// Blocks on the diagonal.
    fn invert(&mut self) -> Result<(), Indefinite> {
        for (i, inverse) in self.inverse.iter_mut().enumerate() {
            let diagonal = self.a.view().row(i).find(|(j, _)| *j == i);
            *inverse = diagonal.and_then(|(_, a)| a.inverse()).ok_or(Indefinite)?;
        }
        Ok(())
    }

    fn view(&self) -> Level<'_, A> {
        Level {
            a: self.a.view(),
            inverse: &self.inverse,
            prolongation: self.prolongation.view(),
            restriction: self.restriction.view(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The 7-point Laplacian of a cube with its sides fixed, `n³` unknowns.
    fn cube(n: usize) -> Matrix<f64> {
        let number = |x: usize, y: usize, z: usize| x + n * (y + n * z);
        let (mut matrix, mut row) = (Matrix::new(n * n * n), Vec::new());
        for (z, y, x) in (0..n).flat_map(|z| (0..n).flat_map(move |y| (0..n).map(move |x| (z, y, x)))) {
            row.clear();
            row.push((number(x, y, z), 6.0));
            for (axis, at) in [x, y, z].into_iter().enumerate() {
                for to in [at.wrapping_sub(1), at + 1].into_iter().filter(|to| *to < n) {
                    let mut place = [x, y, z];
                    place[axis] = to;
                    row.push((number(place[0], place[1], place[2]), -1.0));
                }
            }
            matrix.push(&mut row);
        }
        matrix
    }

    fn solved(n: usize) -> (Vec<usize>, usize, f64) {
        let a = cube(n);
        let mut grids = Grids::new(a.clone(), a.clone());
        grids.update().expect("positive definite");
        let want: Vec<f64> = (0..n * n * n).map(|i| libm::sin(i as f64)).collect();
        let mut b = vec![0.0; want.len()];
        a.view().multiply(&want, &mut b);
        let mut x = vec![0.0; want.len()];
        let (iterations, end) =
            grids.solve(&b, &mut x, Until { share: 1e-10, iterations: 60 }, &mut grids.scratch());
        assert_eq!(end, End::Converged);
        let worst = want.iter().zip(&x).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        (grids.rows(), iterations, worst)
    }

    /// Eight times the unknowns take hardly more steps.
    #[test]
    fn steps_hardly_grow_with_the_grid() {
        let (rows, few, error) = solved(10);
        assert!(rows.len() >= 2 && error < 1e-8, "{rows:?} {error}");
        let (rows, more, error) = solved(20);
        assert!(
            rows.len() >= 3 && rows.last().is_some_and(|n| *n <= FEW) && error < 1e-8,
            "{rows:?} {error}"
        );
        assert!(more <= few + 4 && more <= 16, "{few} {more}");
    }

    /// Small ones have a factor alone; what is not positive definite is told.
    #[test]
    fn small_ones_are_exact_and_indefinite_ones_told() {
        let (rows, iterations, _) = solved(3);
        assert_eq!((rows, iterations), (vec![27], 1));
        for (n, diagonal) in [(3, -9.0), (10, -9.0), (10, 0.1)] {
            let a = cube(n);
            let mut grids = Grids::new(a.clone(), a);
            *grids.entries().iter_mut().rfind(|a| **a > 0.0).expect("a diagonal") = diagonal;
            let refused = grids.update().is_err();
            let (mut x, b) = (vec![0.0; n * n * n], vec![1.0; n * n * n]);
            let until = Until { share: 1e-10, iterations: 60 };
            let (_, end) = grids.solve(&b, &mut x, until, &mut grids.scratch());
            assert!(refused || end == End::Indefinite, "{n} {diagonal}");
        }
    }
}
