//! Harmonic functions on a graph: each free node is the mean of its neighbors.
//!
//! ```text
//! Σⱼ (uᵢ − uⱼ) = 0 for free i,   uᵢ = gᵢ for fixed i
//! ```
//!
//! On the lattice of a cage this is the 7-point Laplacian. Its matrix is an M-matrix, so that the largest and the
//! smallest value are fixed ones: values between 0 and 1 stay there. Solved by conjugate gradients with the diagonal as
//! preconditioner (Hestenes, Stiefel 1952), from the middle of the fixed values.

/// Sum of squares of the residual, share of the right side's, at which a solution is good.
const GOOD: f64 = 1e-26;
/// Most steps, for each node of the graph's diameter and more.
const STEPS: usize = 10_000;

/// A graph with free and fixed nodes.
#[derive(Debug)]
pub(super) struct Graph {
    /// Begin of each free node's neighbors in `neighbors`.
    starts: Vec<usize>,
    /// Neighbors, as numbers of all nodes.
    neighbors: Vec<u32>,
    /// Number of each node among the free ones; `u32::MAX` for others.
    free_of: Vec<u32>,
    /// The free nodes, ascending.
    pub(super) free: Vec<u32>,
}

impl Graph {
    /// Of `links`; a node that no way leads to from a fixed one must be fixed.
    pub(super) fn new(links: &[[u32; 2]], fixed: &[bool]) -> Self {
        let mut all = vec![Vec::new(); fixed.len()];
        for [a, b] in links {
            all[*a as usize].push(*b);
            all[*b as usize].push(*a);
        }
        let mut graph = Self {
            starts: vec![0],
            neighbors: Vec::new(),
            free_of: vec![u32::MAX; fixed.len()],
            free: Vec::new(),
        };
        for (i, row) in (0_u32..).zip(all).filter(|(i, _)| !fixed[*i as usize]) {
            graph.free_of[i as usize] = u32::try_from(graph.free.len()).unwrap_or(u32::MAX);
            graph.free.push(i);
            graph.neighbors.extend(row);
            graph.starts.push(graph.neighbors.len());
        }
        graph
    }

    fn row(&self, i: usize) -> &[u32] {
        &self.neighbors[self.starts[i]..self.starts[i + 1]]
    }

    /// `y = L x` over free nodes.
    fn multiply(&self, x: &[f64], y: &mut [f64]) {
        for (i, y) in y.iter_mut().enumerate() {
            let row = self.row(i);
            let others = row.iter().filter_map(|j| x.get(self.free_of[*j as usize] as usize)).sum::<f64>();
            *y = self.degree(i) * x[i] - others;
        }
    }

    #[expect(clippy::cast_precision_loss, reason = "neighbors of a node")]
    fn degree(&self, i: usize) -> f64 {
        self.row(i).len() as f64
    }

    /// Sets the free entries of `values` to the harmonic function of the fixed ones; returns the steps it took.
    pub(super) fn solve(&self, values: &mut [f64]) -> usize {
        let n = self.free.len();
        let fixed = |j: &&u32| self.free_of[**j as usize] == u32::MAX;
        let mut r: Vec<f64> =
            (0..n).map(|i| self.row(i).iter().filter(fixed).map(|j| values[*j as usize]).sum()).collect();
        let (mut x, mut q) = (vec![0.0; n], vec![0.0; n]);
        let precondition =
            |r: &[f64]| -> Vec<f64> { r.iter().enumerate().map(|(i, r)| r / self.degree(i)).collect() };
        let enough = GOOD * dot(&r, &r);
        let mut z = precondition(&r);
        let mut p = z.clone();
        let mut rz = dot(&r, &z);
        let mut steps = 0;
        while dot(&r, &r) > enough && steps < STEPS {
            self.multiply(&p, &mut q);
            let alpha = rz / dot(&p, &q);
            x.iter_mut().zip(&p).for_each(|(x, p)| *x += alpha * p);
            r.iter_mut().zip(&q).for_each(|(r, q)| *r -= alpha * q);
            z = precondition(&r);
            let next = dot(&r, &z);
            let beta = next / rz;
            p.iter_mut().zip(&z).for_each(|(p, z)| *p = z + beta * *p);
            rz = next;
            steps += 1;
        }
        self.free.iter().zip(x).for_each(|(i, x)| values[*i as usize] = x);
        steps
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
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
        assert!(graph.solve(&mut values) <= 9, "a step a free node at most");
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
        Graph::new(&links, &fixed).solve(&mut values);
        let worst = values.iter().zip(&want).map(|(v, w)| (v - w).abs()).fold(0.0, f64::max);
        // The residual is 1e-13 of the right side, the inverse's norm below 1/(1 − cos(π/11)) / 6 = 4.1 by its rows.
        assert!(worst < 1e-13 * 2.0e3 * 4.1 * 40.0, "{worst}");
    }
}
