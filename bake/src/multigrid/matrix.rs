//! Sparse matrices that own their numbers.

use sinew::kernel::csr::Csr;

/// A matrix by compressed rows.
#[derive(Clone, Debug, PartialEq)]
pub struct Matrix<A> {
    /// Begin of each row, and the end of the last.
    pub starts: Vec<u32>,
    /// Columns, ascending in a row.
    pub columns: Vec<u32>,
    /// Entries.
    pub entries: Vec<A>,
    /// Columns that there are.
    pub width: usize,
}

impl<A: Copy> Matrix<A> {
    /// Without a row yet.
    #[must_use]
    pub fn new(width: usize) -> Self {
        Self { starts: vec![0], columns: Vec::new(), entries: Vec::new(), width }
    }

    /// Rows.
    #[must_use]
    pub const fn rows(&self) -> usize {
        self.starts.len() - 1
    }

    /// As the kernels read it.
    #[must_use]
    pub fn view(&self) -> Csr<'_, A> {
        Csr { starts: &self.starts, columns: &self.columns, entries: &self.entries }
    }

    /// One more row, of columns and entries, which it puts in order.
    ///
    /// # Panics
    ///
    /// If there are more than 2³² entries.
    pub fn push(&mut self, row: &mut [(usize, A)]) {
        row.sort_by_key(|(column, _)| *column);
        self.columns.extend(row.iter().map(|(column, _)| number(*column)));
        self.entries.extend(row.iter().map(|(_, a)| *a));
        self.starts.push(number(self.columns.len()));
    }

    /// Rows for columns.
    #[must_use]
    pub fn transposed(&self) -> Self {
        let mut rows = vec![Vec::new(); self.width];
        for i in 0..self.rows() {
            self.view().row(i).for_each(|(j, a)| rows[j].push((i, a)));
        }
        let mut out = Self::new(self.rows());
        rows.iter_mut().for_each(|row| out.push(row));
        out
    }

    /// The same pattern with other entries.
    #[must_use]
    pub fn map<B>(&self, entry: impl FnMut(&A) -> B) -> Matrix<B> {
        Matrix {
            starts: self.starts.clone(),
            columns: self.columns.clone(),
            entries: self.entries.iter().map(entry).collect(),
            width: self.width,
        }
    }
}

/// A number of a row, column or entry.
///
/// # Panics
///
/// If it is 2³² or more: far above what fits in memory here.
pub(super) fn number(i: usize) -> u32 {
    u32::try_from(i).expect("fewer than 2^32 entries")
}
