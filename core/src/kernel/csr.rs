//! Sparse matrices by compressed rows.
//!
//! ```text
//! yᵢ = Σⱼ Aᵢⱼ xⱼ,   rᵢ = bᵢ − Σⱼ Aᵢⱼ xⱼ        j ascending
//! ```

use super::block::{Times, Unknown};

/// A matrix: a view of arrays that lie elsewhere.
#[derive(Clone, Copy, Debug)]
pub struct Csr<'a, A> {
    /// Begin of each row in the other two, and the end of the last.
    pub starts: &'a [u32],
    /// Columns of the entries, ascending in a row.
    pub columns: &'a [u32],
    /// Entries.
    pub entries: &'a [A],
}

impl<'a, A: Copy> Csr<'a, A> {
    /// Rows.
    #[must_use]
    pub const fn rows(&self) -> usize {
        self.starts.len().saturating_sub(1)
    }

    /// Columns and entries of row `i`; none where there is no such row.
    #[inline]
    #[must_use]
    pub fn row(&self, i: usize) -> impl DoubleEndedIterator<Item = (usize, A)> + use<'a, A> {
        let range = match self.starts.get(i..i + 2) {
            Some([start, end]) => *start as usize..*end as usize,
            _ => 0..0,
        };
        let columns = self.columns.get(range.clone()).unwrap_or_default();
        let entries = self.entries.get(range).unwrap_or_default();
        columns.iter().zip(entries).map(|(j, a)| (*j as usize, *a))
    }

    /// `y = A x`.
    ///
    /// # Panics
    ///
    /// If `x` lacks a column.
    pub fn multiply<V: Unknown>(&self, x: &[V], y: &mut [V])
    where
        A: Times<V>,
    {
        for (i, y) in y.iter_mut().enumerate() {
            *y = self.row(i).fold(V::ZERO, |y, (j, a)| y.plus(a.times(x[j])));
        }
    }

    /// `y = y + A x`.
    ///
    /// # Panics
    ///
    /// If `x` lacks a column.
    pub fn multiply_add<V: Unknown>(&self, x: &[V], y: &mut [V])
    where
        A: Times<V>,
    {
        for (i, y) in y.iter_mut().enumerate() {
            *y = self.row(i).fold(*y, |y, (j, a)| y.plus(a.times(x[j])));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_are_multiplied() {
        let a = Csr { starts: &[0, 2, 2, 3], columns: &[0, 2, 1], entries: &[2.0, -1.0, 4.0] };
        let (x, mut y) = ([1.0, 2.0, 3.0], [9.0; 3]);
        a.multiply(&x, &mut y);
        assert_eq!(y, [-1.0, 0.0, 8.0]);
        a.multiply_add(&x, &mut y);
        assert_eq!(y, [-2.0, 0.0, 16.0]);
        assert_eq!(a.row(7).count(), 0);
    }
}
