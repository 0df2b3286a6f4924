//! Hessians over a few nodes, put together from products of vectors.
//!
//! ```text
//! H += w z zᵀ,   H += w(u vᵀ + v uᵀ) = w/2 (z₊z₊ᵀ − z₋z₋ᵀ),   z± = √(|v|/|u|) u ± √(|u|/|v|) v
//! ```
//!
//! `z₊` and `z₋` are as long and so orthogonal: that is the second's eigen-system, and what is left without its negative
//! part is its projection. A sum of projections is nowhere below the sum, though not the nearest matrix to it.

use super::element::outer;
use glam::{DMat3, DVec3};

/// Blocks over `N` nodes; those with `j ≤ i` alone are set.
pub type Blocks<const N: usize> = [[DMat3; N]; N];

/// Adds `w·z zᵀ`.
pub(super) fn square<const N: usize>(h: &mut Blocks<N>, w: f64, z: &[DVec3; N]) {
    for (i, row) in h.iter_mut().enumerate() {
        for (block, other) in row[..=i].iter_mut().zip(z) {
            *block += outer(w * z[i], *other);
        }
    }
}

/// Adds `w(u vᵀ + v uᵀ)`, or its positive part.
pub(super) fn product<const N: usize>(
    h: &mut Blocks<N>,
    w: f64,
    u: &[DVec3; N],
    v: &[DVec3; N],
    projected: bool,
) {
    let size = |u: &[DVec3; N]| libm::sqrt(u.iter().map(|u| u.length_squared()).sum());
    let (of_u, of_v): (f64, f64) = (size(u), size(v));
    if of_u == 0.0 || of_v == 0.0 {
        return;
    }
    let (p, q) = (libm::sqrt(of_v / of_u), libm::sqrt(of_u / of_v));
    let z = |q: f64| core::array::from_fn(|i| p * u[i] + q * v[i]);
    if !projected || w > 0.0 {
        square(h, 0.5 * w, &z(q));
    }
    if !projected || w < 0.0 {
        square(h, -0.5 * w, &z(-q));
    }
}
