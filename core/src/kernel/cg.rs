//! Conjugate gradients with a preconditioner, for symmetric positive definite systems `A x = b`.
//!
//! ```text
//! r = b − A x,  z = M⁻¹ r,  p = z,  ρ = r·z
//! q = A p,  α = ρ / p·q,  x ← x + α p,  r ← r − α q,  z = M⁻¹ r,  ρ' = r·z,  p ← z + (ρ'/ρ) p
//! ```
//!
//! Hestenes, Stiefel 1952. `√ρ` measures the error by the energy that the preconditioner sees in it, which is near that of
//! `A`; the end is when it fell to a share of that of the start. Where the matrix or the preconditioner turns out not to be
//! positive definite nothing is lost: `x` is the best so far, and as every step lowered `½ x·A x − b·x` a step from 0
//! towards it leads down.
//!
//! Sums have one order: eight partial sums in stripes, then a tree.

use super::block::{Block, Real, Unknown};
use super::csr::Csr;

/// An approximate inverse: symmetric, positive definite, and the same in every call.
pub trait Preconditioner<V> {
    /// `z = M⁻¹ r`.
    fn precondition(&mut self, r: &[V], z: &mut [V]);
}

/// The inverse of the diagonal.
#[derive(Clone, Copy, Debug)]
pub struct Jacobi<'a, A>(pub &'a [A]);

impl<A: Block> Preconditioner<A::Unknown> for Jacobi<'_, A> {
    fn precondition(&mut self, r: &[A::Unknown], z: &mut [A::Unknown]) {
        for ((z, r), a) in z.iter_mut().zip(r).zip(self.0) {
            *z = a.times(*r);
        }
    }
}

/// When to end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Until<R> {
    /// Share of the start's `√ρ`.
    pub share: R,
    /// Most iterations.
    pub iterations: usize,
}

/// How it ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum End {
    /// The error fell as far as was asked for.
    Converged,
    /// All iterations were used.
    Exhausted,
    /// `p·A p` or `r·M⁻¹ r` is not above 0: the matrix or its preconditioner is not positive definite, or holds
    /// something that is not a number.
    Indefinite,
}

/// Directions and residuals, `4 n` entries.
#[derive(Debug)]
pub struct Memory<'a, V> {
    r: &'a mut [V],
    z: &'a mut [V],
    p: &'a mut [V],
    q: &'a mut [V],
}

impl<'a, V> Memory<'a, V> {
    /// Four parts of `all`; what does not divide is left over.
    #[must_use]
    pub fn new(all: &'a mut [V]) -> Self {
        let n = all.len() / 4;
        let (r, all) = all.split_at_mut(n);
        let (z, all) = all.split_at_mut(n);
        let (p, all) = all.split_at_mut(n);
        Self { r, z, p, q: &mut all[..n] }
    }
}

/// Moves `x` towards `A⁻¹ b`; iterations, and how it ended.
///
/// `b`, `x` and each part of `memory` have an entry a row. Source: Saad, *Iterative Methods*, 2003, algorithm 9.1.
///
/// ```
/// use sinew::kernel::{cg::{self, End, Jacobi, Memory, Until}, csr::Csr};
/// let a = Csr { starts: &[0, 2, 4], columns: &[0, 1, 0, 1], entries: &[4.0, 1.0, 1.0, 3.0] };
/// let (mut x, mut memory) = ([0.0_f64; 2], [0.0; 8]);
/// let until = Until { share: 1e-12, iterations: 10 };
/// let m = &mut Jacobi(&[1.0 / 4.0, 1.0 / 3.0]);
/// let (iterations, end) = cg::solve(&a, m, &[1.0, 2.0], &mut x, until, &mut Memory::new(&mut memory));
/// assert_eq!((iterations, end), (2, End::Converged));
/// assert!((x[0] - 1.0 / 11.0).abs() < 1e-15 && (x[1] - 7.0 / 11.0).abs() < 1e-15);
/// ```
///
/// # Panics
///
/// If a length differs.
pub fn solve<A: Block>(
    a: &Csr<'_, A>,
    m: &mut impl Preconditioner<A::Unknown>,
    b: &[A::Unknown],
    x: &mut [A::Unknown],
    until: Until<<A as Unknown>::Real>,
    memory: &mut Memory<'_, A::Unknown>,
) -> (usize, End) {
    let Memory { r, z, p, q } = memory;
    let zero: <A as Unknown>::Real = Real::ZERO;
    a.multiply(x, q);
    for ((r, b), q) in r.iter_mut().zip(b).zip(q.iter()) {
        *r = b.minus(*q);
    }
    m.precondition(r, z);
    p.copy_from_slice(z);
    let mut rho = dot(r, z);
    let enough = until.share * until.share * rho;
    for iteration in 0..until.iterations {
        if rho <= enough {
            return (iteration, if rho >= zero { End::Converged } else { End::Indefinite });
        }
        a.multiply(p, q);
        let curvature = dot(p, q);
        if curvature > zero && rho > zero {
            let alpha = rho / curvature;
            step(x, alpha, p);
            step(r, zero - alpha, q);
        } else {
            return (iteration, End::Indefinite);
        }
        m.precondition(r, z);
        let next = dot(r, z);
        let beta = next / rho;
        for (p, z) in p.iter_mut().zip(z.iter()) {
            *p = z.plus(p.scaled(beta));
        }
        rho = next;
    }
    (until.iterations, if rho <= enough { End::Converged } else { End::Exhausted })
}

/// `y = y + s x`.
fn step<V: Unknown>(y: &mut [V], s: V::Real, x: &[V]) {
    for (y, x) in y.iter_mut().zip(x) {
        *y = y.plus(x.scaled(s));
    }
}

/// `Σ xᵢ·yᵢ`.
fn dot<V: Unknown>(x: &[V], y: &[V]) -> V::Real {
    let mut sums: [V::Real; 8] = [Real::ZERO; 8];
    for (x, y) in x.chunks(8).zip(y.chunks(8)) {
        for ((sum, x), y) in sums.iter_mut().zip(x).zip(y) {
            *sum = *sum + x.dot(*y);
        }
    }
    let [a, b, c, d, e, f, g, h] = sums;
    ((a + b) + (c + d)) + ((e + f) + (g + h))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A path of `N` links with fixed ends.
    fn path<const N: usize>() -> ([u32; N], [u32; 96], [f64; 96]) {
        let (mut starts, mut columns, mut entries) = ([0; N], [0; 96], [0.0; 96]);
        let mut at = 0;
        for i in 0..N - 1 {
            for j in i.saturating_sub(1)..(i + 2).min(N - 1) {
                columns[at] = u32::try_from(j).expect("small");
                entries[at] = if i == j { 2.0 } else { -1.0 };
                at += 1;
            }
            starts[i + 1] = u32::try_from(at).expect("small");
        }
        (starts, columns, entries)
    }

    #[test]
    fn a_path_hangs_in_a_parabola() {
        let (starts, columns, entries) = path::<21>();
        let a = Csr { starts: &starts, columns: &columns, entries: &entries };
        let (mut x, mut memory) = ([0.0; 20], [0.0; 80]);
        let until = Until { share: 1e-13, iterations: 40 };
        let found =
            solve(&a, &mut Jacobi(&[0.5; 20]), &[1.0; 20], &mut x, until, &mut Memory::new(&mut memory));
        assert_eq!(found.1, End::Converged);
        assert!(found.0 <= 10, "half of the unknowns, by symmetry: {found:?}");
        for (i, x) in (1..).zip(x) {
            let want = 0.5 * f64::from(i) * f64::from(21 - i);
            assert!((x - want).abs() < 1e-11, "{i}: {x} {want}");
        }
    }

    /// What is no system of this kind is said to be none, and `x` stays finite.
    #[test]
    fn an_indefinite_matrix_is_told() {
        let starts = [0, 1, 2];
        for (entry, b) in [(-1.0, 1.0), (0.0, 1.0), (f64::NAN, 1.0), (2.0, f64::NAN), (f64::INFINITY, 1.0)] {
            let entries = [1.0, entry];
            let a = Csr { starts: &starts, columns: &[0, 1], entries: &entries };
            let (mut x, mut memory) = ([0.0_f64; 2], [0.0; 8]);
            let until = Until { share: 1e-9, iterations: 5 };
            let (_, end) =
                solve(&a, &mut Jacobi(&[1.0, 1.0]), &[1.0, b], &mut x, until, &mut Memory::new(&mut memory));
            assert!(end != End::Converged || entry.is_infinite(), "{entry} {b}: {end:?}");
            assert!(x.iter().all(|x| x.is_finite()), "{entry} {b}: {x:?}");
        }
    }

    #[test]
    fn nothing_is_left_to_do() {
        let (starts, columns, entries) = path::<6>();
        let a = Csr { starts: &starts, columns: &columns, entries: &entries };
        let (mut x, mut memory) = ([0.0; 5], [0.0; 20]);
        let until = Until { share: 1e-9, iterations: 5 };
        let found =
            solve(&a, &mut Jacobi(&[0.5; 5]), &[0.0; 5], &mut x, until, &mut Memory::new(&mut memory));
        assert_eq!((found, x), ((0, End::Converged), [0.0; 5]));
    }
}
