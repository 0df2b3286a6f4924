//! Offsets of the dynamics taken back to bind space, so that an engine's own skinning can add them.
//!
//! ```text
//! o = B⁻¹·ŷ,   ŷ = w·y / √(1 + |y|²/L²),   B⁻¹ = cof(B)ᵀ / det(B)
//! ```
//!
//! `w` is the point's softness times its region's gain, `L` the region's largest offset: small
//! offsets pass unchanged, none grows beyond `w·L`, and there is no kink between.

use super::skin::{Influences, LinearBlock, Rows, linear_of};
use super::tiny::LEAST;
use crate::lanes::four::{self, Cofactors, each, three};
use crate::lanes::{F32x4, Lanes};

/// An offset is shown below this, model units; a component beyond is left out.
pub const LARGEST: f32 = 1e18;

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
/// * `palette`, `influences`: as in [`super::skin::skin`]; read only where a blended map has no inverse.
/// * `linear`: blended maps, as [`super::skin::skin`] leaves them.
/// * `softness`, `region`: one a point; `limits` is indexed by region.
/// * `out`: one a point; zero where the dominant joint's map has no inverse either.
///
/// # Panics
///
/// If the lengths differ, or an index is out of range.
pub fn unskin(
    palette: &[Rows],
    influences: Influences<'_>,
    linear: &[LinearBlock],
    y: &[[f32; 3]],
    (softness, region): (&[f32], &[u8]),
    limits: &[Limit],
    out: &mut [[f32; 3]],
) {
    let n = y.len();
    let lengths = [softness.len(), region.len(), out.len(), n];
    assert!(lengths == [n; 4] && linear.len() == n.div_ceil(4), "unskin: lengths differ");
    for (k, linear) in linear.iter().enumerate() {
        let i = 4 * k;
        let region = four::read(region, i);
        let limit = each(|lane| limits[usize::from(region[lane])]);
        let gain = F32x4::from_array(each(|lane| limit[lane].gain));
        let inverse_square = F32x4::from_array(each(|lane| limit[lane].inverse_square));
        let dominant = |lane: usize| linear_of(&palette[influences.dominant((i + lane).min(n - 1))]);
        let linear = three(|c| three(|r| F32x4::from_array(linear[c][r])));
        let Cofactors { columns, determinant, regular } = Cofactors::or_else(&linear, dominant);
        let [zero, one, least, most] = [0.0, 1.0, LEAST, LARGEST].map(F32x4::splat);
        let y = four::load(y, i);
        let stretch = (one + four::dot(&y, &y) * inverse_square).sqrt();
        let factor = F32x4::from_array(four::read(softness, i)) * gain / (stretch * determinant);
        let shown = three(|c| four::dot(&columns[c], &y) * factor);
        // A product of numbers as large as are let in may overflow, one of small ones underflow.
        let shown = three(|c| {
            let size = shown[c].abs();
            F32x4::select(regular & size.lt(most) & least.lt(size), shown[c], zero)
        });
        four::store(shown, out, i);
    }
}

#[cfg(test)]
mod tests {
    extern crate std;
    use super::*;
    use crate::math::float::sqrt;
    use crate::math::{affine, vec3};
    use std::vec::Vec;

    const LIMITS: [Limit; 2] =
        [Limit { gain: 1.0, inverse_square: 0.0 }, Limit { gain: 0.5, inverse_square: 4.0 }];

    fn matrix(i: u8) -> affine::Affine {
        let t = f32::from(i);
        affine::from_trs([0.0; 3], [0.1 * t, 0.3, -0.2, 0.9], [1.0 + 0.1 * t, 0.7, -1.3])
    }

    fn run(n: u8, singular: Option<u8>) -> Vec<[f32; 3]> {
        let map = |i: u8| if Some(i) == singular { [[0.0; 3]; 4] } else { matrix(i) };
        let block = |k: u8| -> LinearBlock {
            let lanes = [0, 1, 2, 3].map(|i| map((4 * k + i).min(n - 1)));
            [0, 1, 2].map(|c| [0, 1, 2].map(|r| lanes.map(|m| m[c][r])))
        };
        let linear: Vec<_> = (0..n.div_ceil(4)).map(block).collect();
        let identity = [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0]];
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

    /// A point's bits do not depend on its place in a block.
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
