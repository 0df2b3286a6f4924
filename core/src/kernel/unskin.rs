//! Offsets of the dynamics taken back to bind space, so that an engine's own skinning can add them.
//!
//! ```text
//! o = B⁻¹·ŷ,   ŷ = w·y / √(1 + |y|²/L²),   B⁻¹ = cof(B)ᵀ / det(B)
//! ```
//!
//! `w` is the point's softness times its region's gain, `L` the region's largest offset: small
//! offsets pass unchanged, none grows beyond `w·L`, and there is no kink between.

use super::skin::{Columns, Influences, cofactors, is_singular, linear_of};
use crate::lanes::{F32x4, Lanes};
use crate::math::float::sqrt;
use crate::math::vec3;

/// How a region shows its offsets.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limit {
    /// Factor of the softness.
    pub gain: f32,
    /// `1/L²`, model units.
    pub inverse_square: f32,
}

/// Takes the offsets `y` (model space) of points to bind space.
///
/// * `palette`, `influences`: as in [`super::skin::skin`]; read only where a blended matrix has no inverse.
/// * `linear`: columns of the blended matrices.
/// * `softness`, `region`: one a point; `limits` is indexed by region.
///
/// # Panics
///
/// If the lengths differ, or an index is out of range.
pub fn unskin(
    palette: &[Columns],
    influences: Influences<'_>,
    linear: &[[[f32; 4]; 3]],
    y: &[[f32; 3]],
    (softness, region): (&[f32], &[u8]),
    limits: &[Limit],
    out: &mut [[f32; 3]],
) {
    let n = y.len();
    let lengths = [linear.len(), softness.len(), region.len(), out.len()];
    assert!(lengths == [n; 4], "unskin: lengths differ");
    let limit = |i: usize| limits[usize::from(region[i])];
    let whole = n - n % 4;
    for i in (0..whole).step_by(4) {
        let four = [i, i + 1, i + 2, i + 3];
        let singular = unskin_four::<F32x4>(
            four.map(|i| &linear[i]),
            four.map(|i| y[i]),
            four.map(|i| softness[i] * limit(i).gain),
            four.map(|i| limit(i).inverse_square),
            &mut out[i..i + 4],
        );
        if singular {
            for i in four {
                out[i] = unskin_one(palette, &influences, (i, &linear[i]), y[i], softness[i], limit(i));
            }
        }
    }
    for i in whole..n {
        out[i] = unskin_one(palette, &influences, (i, &linear[i]), y[i], softness[i], limit(i));
    }
}

/// One point, with the dominant joint's matrix where the blended one has no inverse; the definition.
fn unskin_one(
    palette: &[Columns],
    influences: &Influences<'_>,
    (i, linear): (usize, &[[f32; 4]; 3]),
    y: [f32; 3],
    softness: f32,
    limit: Limit,
) -> [f32; 3] {
    let (mut c, mut determinant) = cofactors(linear);
    if is_singular(linear, determinant) {
        let dominant = linear_of(&palette[influences.dominant(i)]);
        (c, determinant) = cofactors(&dominant);
        if is_singular(&dominant, determinant) {
            return [0.0; 3];
        }
    }
    let factor = (softness * limit.gain) / (sqrt(1.0 + vec3::dot(y, y) * limit.inverse_square) * determinant);
    c.map(|c| vec3::dot(c, y) * factor)
}

/// Four points at once, the same operations in the same order; whether any matrix has no inverse.
#[inline(always)]
fn unskin_four<L: Lanes>(
    linear: [&[[f32; 4]; 3]; 4],
    y: [[f32; 3]; 4],
    weight: [f32; 4],
    inverse_square: [f32; 4],
    out: &mut [[f32; 3]],
) -> bool {
    let column = |c: usize| {
        let [x, y, z, _] = L::transpose(linear.map(|m| L::from_array(m[c])));
        [x, y, z]
    };
    let (m0, m1, m2) = (column(0), column(1), column(2));
    let y: [L; 3] = [0, 1, 2].map(|k| L::from_array(y.map(|y| y[k])));
    let cross = |a: &[L; 3], b: &[L; 3]| {
        [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
    };
    let dot = |a: &[L; 3], b: &[L; 3]| (a[0] * b[0] + a[1] * b[1]) + a[2] * b[2];
    let c = [cross(&m1, &m2), cross(&m2, &m0), cross(&m0, &m1)];
    let determinant = dot(&m0, &c[0]);
    let max = |a: L, b: L| L::select_lt(b, a, a, b);
    let longest = max(max(dot(&m0, &m0), dot(&m1, &m1)), dot(&m2, &m2));
    let threshold = L::splat(1e-12) * longest * longest * longest;
    let (zero, one) = (L::splat(0.0), L::splat(1.0));
    let regular = L::select_lt(threshold, determinant * determinant, one, zero).to_array();
    let stretch = (one + dot(&y, &y) * L::from_array(inverse_square)).sqrt();
    let factor = L::from_array(weight) / (stretch * determinant);
    let [x, y, z] = c.map(|c| (dot(&c, &y) * factor).to_array());
    for (i, out) in out.iter_mut().enumerate() {
        *out = [x[i], y[i], z[i]];
    }
    regular.iter().any(|r| *r < 0.5)
}

#[cfg(test)]
mod tests {
    extern crate std;
    use super::*;
    use crate::math::affine;
    use std::vec::Vec;

    const LIMITS: [Limit; 2] =
        [Limit { gain: 1.0, inverse_square: 0.0 }, Limit { gain: 0.5, inverse_square: 4.0 }];

    fn matrix(i: u8) -> affine::Affine {
        let t = f32::from(i);
        affine::from_trs([0.0; 3], [0.1 * t, 0.3, -0.2, 0.9], [1.0 + 0.1 * t, 0.7, -1.3])
    }

    fn run(n: u8, singular: Option<u8>) -> Vec<[f32; 3]> {
        let flat = [[0.0; 4]; 3];
        let columns =
            |m: &affine::Affine| [m[0], m[1], m[2]].map(|[x, y, z]: [f32; 3]| -> [f32; 4] { [x, y, z, 0.0] });
        let linear: Vec<_> =
            (0..n).map(|i| if Some(i) == singular { flat } else { columns(&matrix(i)) }).collect();
        let identity = [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0], [0.0; 4]];
        let joints: Vec<u16> = (0..n).map(|_| 0).collect();
        let weights: Vec<f32> = (0..n).map(|_| 1.0).collect();
        let influences = Influences { stride: 1, joints: &joints, weights: &weights };
        let y: Vec<[f32; 3]> = (0..n).map(|i| [0.1, -0.02 * f32::from(i), 0.3]).collect();
        let softness: Vec<f32> = (0..n).map(|_| 0.75).collect();
        let region: Vec<u8> = (0..n).map(|i| i % 2).collect();
        let mut out = std::vec![[f32::NAN; 3]; usize::from(n)];
        unskin(&[identity], influences, &linear, &y, (&softness, &region), &LIMITS, &mut out);
        out
    }

    #[test]
    fn the_blended_matrix_undoes_it_and_limits_hold() {
        for (i, o) in (0..11).zip(run(11, None)) {
            let y = [0.1, -0.02 * f32::from(i), 0.3];
            let back = affine::rotate(&matrix(i), o);
            let factor = if i % 2 == 0 { 0.75 } else { 0.375 / sqrt(1.0 + 4.0 * vec3::dot(y, y)) };
            for k in 0..3 {
                assert!((back[k] - factor * y[k]).abs() < 1e-6, "{i}: {back:?}");
            }
        }
    }

    /// The vector path and the tail are the same function: a point's bits do not depend on its place.
    #[test]
    fn bits_do_not_depend_on_the_count_or_on_a_singular_neighbour() {
        let all = run(12, None);
        for n in 0..12 {
            assert_eq!(run(n, None), all[..usize::from(n)], "{n} points");
        }
        let beside = run(12, Some(5));
        assert_eq!(beside[4], all[4]);
        assert!(beside[5].iter().all(|x| x.is_finite()), "dominant joint stands in");
    }
}
