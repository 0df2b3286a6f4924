//! From stencils of nodes to the stiffness matrix of the free ones.

use super::potential::Potential;
use super::stiffness::{FIXED, Stiffness};
use glam::{DMat3, DVec3};

/// Which nodes are free, in the order of the matrix's rows.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Free {
    /// Row of each node; [`FIXED`] without one.
    pub row: Vec<u32>,
    /// Node of each row.
    pub node: Vec<u32>,
}

impl Free {
    /// Of `count` nodes all but `fixed`.
    ///
    /// # Panics
    ///
    /// If one of `fixed` is not below `count`.
    #[must_use]
    pub fn new(count: usize, fixed: &[u32]) -> Self {
        let mut row = vec![0; count];
        for node in fixed {
            row[*node as usize] = FIXED;
        }
        let mut node = Vec::with_capacity(count);
        for (i, row) in (0..).zip(&mut row) {
            if *row != FIXED {
                *row = u32::try_from(node.len()).unwrap_or(FIXED);
                node.push(i);
            }
        }
        Self { row, node }
    }

    /// The matrix that takes the Hessians of `potentials` where nothing touches, zero so far.
    #[must_use]
    pub fn stiffness(&self, potentials: &[&dyn Potential]) -> Stiffness {
        self.stiffness_with(potentials, &[])
    }

    /// The same with room for blocks of pairs of rows, the smaller first, as well.
    #[must_use]
    pub fn stiffness_with(&self, potentials: &[&dyn Potential], more: &[(u32, u32)]) -> Stiffness {
        let mut pairs = more.to_vec();
        potentials.iter().for_each(|p| p.stencils(&mut |nodes| self.pairs(nodes, &mut pairs)));
        pairs.sort_unstable();
        pairs.dedup();
        Stiffness::new(self.node.len(), &pairs)
    }

    /// Pairs of rows, the smaller first, that share a block in what touches at `x`, in order.
    #[must_use]
    pub fn touching(&self, potentials: &[&dyn Potential], x: &[DVec3]) -> Vec<(u32, u32)> {
        let mut pairs = Vec::new();
        potentials.iter().for_each(|p| p.touching(x, &mut |nodes| self.pairs(nodes, &mut pairs)));
        pairs.sort_unstable();
        pairs.dedup();
        pairs
    }

    /// Adds the pairs of rows of a stencil, the smaller first.
    fn pairs(&self, nodes: &[u32], out: &mut Vec<(u32, u32)>) {
        let rows = || nodes.iter().map(|n| self.row[*n as usize]).filter(|row| *row != FIXED);
        for i in rows() {
            out.extend(rows().filter(|j| *j > i).map(|j| (i, j)));
        }
    }
}

/// A stiffness matrix that is being filled.
#[derive(Debug)]
pub struct Assembly<'a> {
    free: &'a Free,
    matrix: &'a mut Stiffness,
}

impl<'a> Assembly<'a> {
    /// Begins with zero.
    #[must_use]
    pub fn new(free: &'a Free, matrix: &'a mut Stiffness) -> Self {
        matrix.clear();
        Self { free, matrix }
    }

    /// Adds the block of nodes `i` and `j`, and its transpose to that of `j` and `i`; to a diagonal block once.
    pub fn add(&mut self, i: u32, j: u32, block: DMat3) {
        let (row, column) = (self.free.row[i as usize], self.free.row[j as usize]);
        if row >= column {
            self.matrix.add(row, column, block);
        } else {
            self.matrix.add(column, row, block.transpose());
        }
    }
}
