//! Harmonic functions on a graph: each free node is the mean of its neighbors.
//!
//! ```text
//! Σⱼ (uᵢ − uⱼ) = 0 for free i,   uᵢ = gᵢ for fixed i
//! ```
//!
//! On the lattice of a cage this is the 7-point Laplacian. Its matrix is an M-matrix, so that the largest and the
//! smallest value are fixed ones: values between 0 and 1 stay there. Solved by the runtime's conjugate gradients with a
//! multigrid cycle.

use crate::multigrid::{Grids, Matrix, Scratch};
use sinew::kernel::cg::Until;

/// When a solution is good; far more iterations than a graph takes.
const GOOD: Until<f64> = Until { share: 1e-14, iterations: 200 };
/// Not among the free nodes.
const FIXED: usize = usize::MAX;

/// A graph with free and fixed nodes.
#[derive(Debug)]
pub(super) struct Graph {
    /// Links from a free node, by its number among the free, to a fixed one.
    fixed: Vec<(usize, u32)>,
    /// The free nodes, ascending.
    pub(super) free: Vec<u32>,
    grids: Grids<f64>,
}

/// What a solution is found in.
#[derive(Debug)]
pub(super) struct Work {
    b: Vec<f64>,
    x: Vec<f64>,
    scratch: Scratch<f64>,
}

impl Graph {
    /// Of `links`; a node that no way leads to from a fixed one must be fixed.
    pub(super) fn new(links: &[[u32; 2]], fixed: &[bool]) -> Self {
        let free: Vec<u32> = (0..).zip(fixed).filter(|(_, fixed)| !**fixed).map(|(i, _)| i).collect();
        let mut number = vec![FIXED; fixed.len()];
        free.iter().enumerate().for_each(|(row, i)| number[*i as usize] = row);
        let mut rows: Vec<Vec<(usize, f64)>> = (0..free.len()).map(|i| vec![(i, 0.0)]).collect();
        let mut held = Vec::new();
        for [a, b] in links.iter().flat_map(|[a, b]| [[*a, *b], [*b, *a]]) {
            let (row, column) = (number[a as usize], number[b as usize]);
            if row == FIXED {
                continue;
            }
            rows[row][0].1 += 1.0;
            if column == FIXED {
                held.push((row, b));
            } else {
                rows[row].push((column, -1.0));
            }
        }
        let mut laplacian = Matrix::new(free.len());
        rows.iter_mut().for_each(|row| laplacian.push(row));
        let mut grids = Grids::new(laplacian.clone(), laplacian);
        // Positive definite, as a way leads to every free node; where none does its values stay as they are.
        let _ = grids.update();
        Self { fixed: held, free, grids }
    }

    /// For [`solve`](Self::solve).
    pub(super) fn work(&self) -> Work {
        let zeros = vec![0.0; self.free.len()];
        Work { b: zeros.clone(), x: zeros, scratch: self.grids.scratch() }
    }

    /// Sets the free entries of `values` to the harmonic function of the fixed ones; returns the steps it took.
    pub(super) fn solve(&self, values: &mut [f64], work: &mut Work) -> usize {
        let Work { b, x, scratch } = work;
        b.fill(0.0);
        x.fill(0.0);
        self.fixed.iter().for_each(|(row, i)| b[*row] += values[*i as usize]);
        let (steps, _) = self.grids.solve(b, x, GOOD, scratch);
        self.free.iter().zip(x.iter()).for_each(|(i, x)| values[*i as usize] = *x);
        steps
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// On a path the harmonic function is a straight line; on a cube's lattice the mean over its six faces is kept.
    #[test]
    fn lines_are_straight_and_the_largest_value_is_fixed() {
        let links: Vec<[u32; 2]> = (0..10).map(|i| [i, i + 1]).collect();
        let mut fixed = vec![false; 11];
        (fixed[0], fixed[10]) = (true, true);
        let graph = Graph::new(&links, &fixed);
        let mut values = vec![0.0; 11];
        (values[0], values[10]) = (3.0, -2.0);
        assert!(graph.solve(&mut values, &mut graph.work()) <= 1, "so few have a factor");
        for (i, v) in (0_u8..).zip(&values) {
            assert!((v - (3.0 - 0.5 * f64::from(i))).abs() < 1e-12, "{i}: {v}");
        }
    }

    /// A quadratic that the 7-point Laplacian takes to 0 is found again from its values on the sides of a box.
    #[test]
    fn a_discrete_harmonic_polynomial_is_found_again() {
        let n = 12_u32;
        let number = |x: u32, y: u32, z: u32| x + n * (y + n * z);
        let (mut links, mut fixed, mut want) = (Vec::new(), Vec::new(), Vec::new());
        for (z, y, x) in (0..n).flat_map(|z| (0..n).flat_map(move |y| (0..n).map(move |x| (z, y, x)))) {
            let sides = [x, y, z].map(|c| c == 0 || c == n - 1);
            fixed.push(sides.contains(&true));
            let [a, b, c] = [x, y, z].map(f64::from);
            want.push(a * a + b * b - 2.0 * c * c + a * b * c);
            let next = [(x + 1, y, z), (x, y + 1, z), (x, y, z + 1)];
            links.extend(
                next.iter()
                    .filter(|(x, y, z)| *x.max(y).max(z) < n)
                    .map(|(i, j, k)| [number(x, y, z), number(*i, *j, *k)]),
            );
        }
        let mut values: Vec<f64> = want.iter().zip(&fixed).map(|(w, f)| if *f { *w } else { 0.0 }).collect();
        let graph = Graph::new(&links, &fixed);
        graph.solve(&mut values, &mut graph.work());
        let worst = values.iter().zip(&want).map(|(v, w)| (v - w).abs()).fold(0.0, f64::max);
        // The residual is 1e-13 of the right side, the inverse's norm below 1/(1 − cos(π/11)) / 6 = 4.1 by its rows.
        assert!(worst < 1e-13 * 2.0e3 * 4.1 * 40.0, "{worst}");
    }
}
