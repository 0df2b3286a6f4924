//! Products of sparse matrices whose pattern is kept (Gustavson 1978).
//!
//! ```text
//! Cᵢⱼ = Σₖ Lᵢₖ Rₖⱼ
//! ```

use super::matrix::{Matrix, number};
use sinew::kernel::block::Unknown;

/// Not in a row.
const NONE: u32 = u32::MAX;

/// A product.
#[derive(Clone, Debug)]
pub(super) struct Product<C> {
    /// The result.
    pub(super) matrix: Matrix<C>,
    /// Place of each column in the entries of the row in work.
    places: Vec<u32>,
}

impl<C: Unknown> Product<C> {
    /// The pattern, with zeros.
    pub(super) fn new<L: Copy, R: Copy>(left: &Matrix<L>, right: &Matrix<R>) -> Self {
        let mut seen = vec![NONE; right.width];
        let (mut matrix, mut row) = (Matrix::new(right.width), Vec::new());
        for i in 0..left.rows() {
            row.clear();
            for (k, _) in left.view().row(i) {
                for (j, _) in right.view().row(k).filter(|(j, _)| seen[*j] != number(i)) {
                    row.push((j, C::ZERO));
                }
                right.view().row(k).for_each(|(j, _)| seen[j] = number(i));
            }
            matrix.push(&mut row);
        }
        Self { places: vec![NONE; matrix.width], matrix }
    }

    /// The numbers, of factors with the pattern of those at the beginning.
    pub(super) fn multiply<L: Copy, R: Copy>(
        &mut self,
        left: &Matrix<L>,
        right: &Matrix<R>,
        times: impl Fn(L, R) -> C,
    ) {
        let Matrix { starts, columns, entries, .. } = &mut self.matrix;
        entries.fill(C::ZERO);
        for (i, range) in starts.windows(2).enumerate() {
            let range = range[0] as usize..range[1] as usize;
            for (place, j) in (0..).zip(&columns[range.clone()]) {
                self.places[*j as usize] = place;
            }
            let row = &mut entries[range];
            for (k, l) in left.view().row(i) {
                for (j, r) in right.view().row(k) {
                    let entry = &mut row[self.places[j] as usize];
                    *entry = entry.plus(times(l, r));
                }
            }
        }
    }
}

/// `L A R` of numbers.
pub(super) fn triple(left: &Matrix<f64>, a: &Matrix<f64>, right: &Matrix<f64>) -> Matrix<f64> {
    let mut inner = Product::new(a, right);
    inner.multiply(a, right, |a, r| a * r);
    let mut outer = Product::new(left, &inner.matrix);
    outer.multiply(left, &inner.matrix, |l, a| l * a);
    outer.matrix
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_product_is_that_of_dense_ones() {
        let mut left = Matrix::new(3);
        left.push(&mut [(2, 3.0), (0, 1.0)]);
        left.push(&mut []);
        left.push(&mut [(1, -2.0), (2, 0.5)]);
        let mut right = Matrix::new(2);
        right.push(&mut [(1, 4.0)]);
        right.push(&mut [(0, 7.0)]);
        right.push(&mut [(0, 1.0), (1, -1.0)]);
        let mut product = Product::new(&left, &right);
        product.multiply(&left, &right, |l: f64, r: f64| l * r);
        let rows: Vec<Vec<(usize, f64)>> = (0..3).map(|i| product.matrix.view().row(i).collect()).collect();
        assert_eq!(rows, [vec![(0, 3.0), (1, 1.0)], vec![], vec![(0, -13.5), (1, -0.5)]]);
    }
}
