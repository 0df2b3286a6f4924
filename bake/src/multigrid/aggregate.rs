//! Nodes that belong together, and how a coarser grid's values spread over them.
//!
//! ```text
//! i, j strongly coupled:  |Sᵢⱼ| > θ √(mᵢ mⱼ),   mᵢ = maxⱼ |Sᵢⱼ|, j ≠ i
//! P = (I − ω D⁻¹ S) P₀,   P₀ᵢ₁ = 1 where i is in aggregate I,   ω = (4/3) / ρ(D⁻¹ S)
//! ```
//!
//! Vaněk, Mandel, Brezina 1996, algorithm 5.1; but they compare with `Sᵢᵢ`, of which each of many equal neighbors has too
//! small a share.

use super::matrix::{Matrix, number};
use super::product::Product;

/// `θ`: weaker couplings do not hold an aggregate together.
const STRONG: f64 = 0.25;
/// Steps of the power method for `ρ`: to a few parts in a hundred.
const STEPS: usize = 15;
/// In no aggregate yet.
const NONE: u32 = u32::MAX;

/// `P` for a symmetric matrix of numbers.
pub(super) fn prolongation(s: &Matrix<f64>, damping: f64) -> Matrix<f64> {
    let (aggregates, count) = aggregates(s);
    let mut first = Matrix::new(count);
    aggregates.iter().for_each(|aggregate| first.push(&mut [(*aggregate as usize, 1.0)]));
    let diagonal = diagonal(s);
    let factor = damping / radius(s, &diagonal);
    let mut out = Product::new(s, &first);
    out.multiply(s, &first, |s, one| s * one);
    let mut out = out.matrix;
    for i in 0..out.rows() {
        let range = out.starts[i] as usize..out.starts[i + 1] as usize;
        for (column, entry) in out.columns[range.clone()].iter().zip(&mut out.entries[range]) {
            let own = f64::from(u8::from(*column == aggregates[i]));
            *entry = own - factor * *entry / diagonal[i];
        }
    }
    out
}

/// The aggregate of each node, and how many there are.
fn aggregates(s: &Matrix<f64>) -> (Vec<u32>, usize) {
    let others = |i: usize| s.view().row(i).filter(move |(j, _)| *j != i);
    let most: Vec<f64> = (0..s.rows()).map(|i| others(i).map(|(_, a)| a.abs()).fold(0.0, f64::max)).collect();
    let strong = |i: usize| {
        let most = &most;
        others(i).filter(move |(j, a)| a * a > STRONG * STRONG * most[i] * most[*j])
    };
    let mut of = vec![NONE; s.rows()];
    let mut count = 0;
    // Whole neighborhoods that nobody has a part of.
    for i in 0..s.rows() {
        if of[i] == NONE && strong(i).all(|(j, _)| of[j] == NONE) && strong(i).next().is_some() {
            of[i] = count;
            strong(i).for_each(|(j, _)| of[j] = count);
            count += 1;
        }
    }
    // What is left goes to the neighbor that holds it most.
    let before = of.clone();
    for i in (0..s.rows()).filter(|i| before[*i] == NONE) {
        let taken = strong(i).filter(|(j, _)| before[*j] != NONE);
        if let Some((j, _)) = taken.max_by(|a, b| a.1.abs().total_cmp(&b.1.abs())) {
            of[i] = before[j];
        }
    }
    // Or has one of its own.
    for i in 0..s.rows() {
        if of[i] == NONE {
            of[i] = count;
            strong(i).for_each(|(j, _)| of[j] = if of[j] == NONE { count } else { of[j] });
            count += 1;
        }
    }
    (of, count as usize)
}

fn diagonal(s: &Matrix<f64>) -> Vec<f64> {
    let entry = |i: usize| s.view().row(i).find(|(j, _)| *j == i).map_or(0.0, |(_, a)| a);
    (0..s.rows()).map(entry).map(|a| if a > 0.0 { a } else { 1.0 }).collect()
}

/// `ρ(D⁻¹ S)`, by the power method.
fn radius(s: &Matrix<f64>, diagonal: &[f64]) -> f64 {
    // Signs without a pattern: a smooth start would miss the roughest mode.
    let sign = |i: usize| f64::from(number(i).wrapping_mul(2_654_435_761) >> 31) * 2.0 - 1.0;
    let mut x: Vec<f64> = (0..s.rows()).map(sign).collect();
    let (mut y, mut found) = (x.clone(), 1.0);
    for _ in 0..STEPS {
        s.view().multiply(&x, &mut y);
        y.iter_mut().zip(diagonal).for_each(|(y, d)| *y /= d);
        let length = |v: &[f64]| libm::sqrt(v.iter().map(|x| x * x).sum());
        found = length(&y) / length(&x);
        core::mem::swap(&mut x, &mut y);
    }
    if found > 0.0 { found } else { 1.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A ring of nodes; every third link is weak.
    fn ring(n: usize, weak: f64) -> Matrix<f64> {
        let link = |i: usize| if i % 3 == 2 { weak } else { 1.0 };
        let mut out = Matrix::new(n);
        for i in 0..n {
            let (before, after) = ((i + n - 1) % n, (i + 1) % n);
            out.push(&mut [(before, -link(before)), (i, link(before) + link(i) + 1e-9), (after, -link(i))]);
        }
        out
    }

    #[test]
    fn weak_links_part_aggregates() {
        let (of, count) = aggregates(&ring(30, 1e-3));
        assert_eq!(count, 10);
        for (i, aggregate) in of.iter().enumerate() {
            assert_eq!(*aggregate, of[i - i % 3], "{i}");
        }
    }

    /// Constants are prolonged to constants where the matrix takes them to 0.
    #[test]
    fn constants_stay() {
        let p = prolongation(&ring(30, 0.5), 4.0 / 3.0);
        for i in 0..30 {
            let sum: f64 = p.view().row(i).map(|(_, p)| p).sum();
            assert!((sum - 1.0).abs() < 1e-8, "{i}: {sum}");
        }
        let (even, _) = (ring(30, 1.0), ());
        assert!((radius(&even, &diagonal(&even)) - 2.0).abs() < 0.1, "eigenvalues are 1 − cos: up to 2");
    }
}
