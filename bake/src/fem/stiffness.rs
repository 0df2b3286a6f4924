//! Sparse symmetric matrices of 3×3 blocks, a row and a column a free node.
//!
//! The lower triangle is kept by block columns. The pattern follows from the stencils alone: it is found once, and only
//! numbers change from step to step.

use glam::{DMat3, DVec3};

/// A node that is not free.
pub const FIXED: u32 = u32::MAX;

/// A matrix.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Stiffness {
    /// Begin of each block column, and the end of the last; a column's first block is the diagonal one.
    columns: Vec<usize>,
    /// Block row of each block; they rise in a column.
    rows: Vec<u32>,
    /// Blocks.
    blocks: Vec<DMat3>,
}

impl Stiffness {
    /// Zero, of `n` free nodes; `pairs` are those of different nodes that share a block, the smaller first, in order.
    #[must_use]
    pub fn new(n: usize, pairs: &[(u32, u32)]) -> Self {
        let (columns, rows) = pattern(n, pairs);
        Self { blocks: vec![DMat3::ZERO; rows.len()], columns, rows }
    }

    /// Free nodes.
    #[must_use]
    pub fn len(&self) -> usize {
        self.columns.len() - 1
    }

    /// Whether no node is free.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Begin of each block column, block rows, blocks: the lower triangle.
    #[must_use]
    pub fn parts(&self) -> (&[usize], &[u32], &[DMat3]) {
        (&self.columns, &self.rows, &self.blocks)
    }

    /// Sets all blocks to zero.
    pub fn clear(&mut self) {
        self.blocks.fill(DMat3::ZERO);
    }

    /// Adds to a block of the lower triangle; nothing where a node is [`FIXED`].
    pub fn add(&mut self, row: u32, column: u32, block: DMat3) {
        if row == FIXED || column == FIXED {
            return;
        }
        let column = column as usize;
        let range = self.columns[column]..self.columns[column + 1];
        if let Ok(at) = self.rows[range.clone()].binary_search(&row) {
            self.blocks[range.start + at] += block;
        }
    }

    /// Whether there is a block in `row` of `column`, of the lower triangle.
    ///
    /// # Panics
    ///
    /// If there is no such column.
    #[must_use]
    pub fn contains(&self, row: u32, column: u32) -> bool {
        let column = column as usize;
        self.rows[self.columns[column]..self.columns[column + 1]].binary_search(&row).is_ok()
    }

    /// Becomes `(1 − t)` of itself and `t` of another of its pattern.
    pub fn blend(&mut self, other: &Self, t: f64) {
        for (block, other) in self.blocks.iter_mut().zip(&other.blocks) {
            *block = *block * (1.0 - t) + *other * t;
        }
    }

    /// Adds `by` to the whole diagonal.
    pub fn shift(&mut self, by: f64) {
        for begin in &self.columns[..self.columns.len() - 1] {
            self.blocks[*begin] += DMat3::from_diagonal(DVec3::splat(by));
        }
    }

    /// The mean of the numbers on the diagonal; 0 without a free node.
    #[must_use]
    pub fn mean_diagonal(&self) -> f64 {
        let blocks = self.columns[..self.len()].iter().map(|begin| &self.blocks[*begin]);
        let sum: f64 = blocks.map(|b| b.x_axis.x + b.y_axis.y + b.z_axis.z).sum();
        #[allow(clippy::cast_precision_loss, reason = "far fewer than 2^52 nodes")]
        let count = (3 * self.len()).max(1) as f64;
        sum / count
    }

    /// Calls `visit` with row, column and block of the lower triangle, by columns.
    pub fn each(&self, mut visit: impl FnMut(u32, u32, &DMat3)) {
        for (column, range) in (0..).zip(self.columns.windows(2)) {
            let (rows, blocks) = (&self.rows[range[0]..range[1]], &self.blocks[range[0]..range[1]]);
            rows.iter().zip(blocks).for_each(|(row, block)| visit(*row, column, block));
        }
    }

    /// `y = K x`.
    pub fn multiply(&self, x: &[DVec3], y: &mut [DVec3]) {
        y.fill(DVec3::ZERO);
        for column in 0..self.len() {
            for at in self.columns[column]..self.columns[column + 1] {
                let (row, block) = (self.rows[at] as usize, &self.blocks[at]);
                y[row] += *block * x[column];
                if row != column {
                    y[column] += block.transpose() * x[row];
                }
            }
        }
    }
}

/// Begin of block columns, and block rows.
fn pattern(n: usize, pairs: &[(u32, u32)]) -> (Vec<usize>, Vec<u32>) {
    let (mut columns, mut rows) = (vec![0], Vec::with_capacity(n + pairs.len()));
    let mut pairs = pairs.iter().peekable();
    for column in (0..).take(n) {
        rows.push(column);
        while let Some((_, row)) = pairs.next_if(|(smaller, _)| *smaller == column) {
            rows.push(*row);
        }
        columns.push(rows.len());
    }
    (columns, rows)
}
