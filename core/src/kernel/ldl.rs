//! Dense factors of small symmetric positive definite matrices, by blocks.
//!
//! ```text
//! A = L D Lᵀ,   L = 1 below the diagonal's blocks,   D block diagonal
//! Dⱼ = Aⱼⱼ − Σₖ Lⱼₖ Dₖ Lⱼₖᵀ,   Lᵢⱼ = (Aᵢⱼ − Σₖ Lᵢₖ Dₖ Lⱼₖᵀ) Dⱼ⁻¹        k < j < i
//! ```

use super::block::{Block, Unknown};

/// Replaces `a`, `n × n` blocks by rows of which the lower triangle is read, by its factor: `Lᵢⱼ` below the diagonal,
/// `Dⱼ⁻¹` on it. False, with `a` half done, unless it is positive definite.
///
/// # Panics
///
/// If `a` is shorter than `n × n`.
pub fn factorize<A: Block>(a: &mut [A], n: usize) -> bool {
    for j in 0..n {
        // Row j holds W = L D until its own pivot is known: Lⱼₖ = Wⱼₖ Dₖ⁻¹.
        for k in 0..j {
            let w = (0..k).fold(a[j * n + k], |w, i| w.minus(a[j * n + i].times(a[k * n + i].transposed())));
            a[j * n + k] = w;
        }
        let mut pivot = a[j * n + j];
        for k in 0..j {
            let w = a[j * n + k];
            let l: A = w.times(a[k * n + k]);
            pivot = pivot.minus(l.times(w.transposed()));
            a[j * n + k] = l;
        }
        let Some(inverse) = pivot.inverse() else { return false };
        a[j * n + j] = inverse;
    }
    true
}

/// Replaces `x` by `A⁻¹ x`, with the factor of an `n × n` matrix.
///
/// # Panics
///
/// If `factor` is shorter than `n × n`, or `x` than `n`.
pub fn solve<A: Block>(factor: &[A], n: usize, x: &mut [A::Unknown]) {
    for i in 0..n {
        x[i] = (0..i).fold(x[i], |y, j| y.minus(factor[i * n + j].times(x[j])));
    }
    for i in 0..n {
        x[i] = factor[i * n + i].times(x[i]);
    }
    for i in (0..n).rev() {
        x[i] = (i + 1..n).fold(x[i], |y, j| y.minus(factor[j * n + i].transposed().times(x[j])));
    }
}

#[cfg(test)]
mod tests {
    use super::super::block::Times;
    use super::*;

    /// Σ over `k` of vectors' outer products, with the identity: positive definite, full.
    fn matrix<const N: usize>() -> [[[f64; 3]; 3]; N] {
        let n = [0, 1, 2, 3, 4].into_iter().find(|n| n * n == N).expect("a square");
        core::array::from_fn(|at| {
            let (row, column) = (at / n, at % n);
            core::array::from_fn(|i| {
                core::array::from_fn(|j| {
                    let (r, c) = ((3 * row + i) as f64, (3 * column + j) as f64);
                    f64::from(u8::from(3 * row + i == 3 * column + j)) * 4.0
                        + 1.0 / (1.0 + (r - c) * (r - c))
                        + 0.1 * (r + 1.0) * (c + 1.0) / 100.0
                })
            })
        })
    }

    #[test]
    fn what_is_multiplied_is_solved() {
        let a = matrix::<16>();
        let want: [[f64; 3]; 4] = core::array::from_fn(|i| [i as f64, 1.0, -0.5 * i as f64]);
        let mut x: [[f64; 3]; 4] = core::array::from_fn(|i| {
            (0..4).fold([0.0; 3], |y: [f64; 3], j| y.plus(a[4 * i + j].times(want[j])))
        });
        let mut factor = a;
        assert!(factorize(&mut factor, 4));
        solve(&factor, 4, &mut x);
        for (x, want) in x.as_flattened().iter().zip(want.as_flattened()) {
            assert!((x - want).abs() < 1e-14, "{x} {want}");
        }
    }

    #[test]
    fn an_indefinite_matrix_has_no_factor() {
        let mut a = matrix::<9>();
        a[8][2][2] -= 9.0;
        assert!(!factorize(&mut a, 3));
        assert!(!factorize(&mut [1.0_f32, 2.0, 2.0, 3.9], 2));
        assert!(factorize(&mut [1.0_f32, 2.0, 2.0, 4.1], 2));
    }
}
