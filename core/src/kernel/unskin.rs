//! Offsets of the dynamics taken back to bind space, so that an engine's own skinning can add them.
//!
//! ```text
//! o = B⁻¹·ŷ,   ŷ = w·y / √(1 + |y|²/L²),   B⁻¹ = cof(B)ᵀ / det(B)
//! ```
//!
//! `w` is the point's softness times its region's gain, `L` the region's largest offset: small
//! offsets pass unchanged, none grows beyond `w·L`, and there is no kink between.

use super::blend::{BLOCK, Influences, LinearBlock, Rows, dominant_map};
use super::cofactor::{Cofactors, Linear};
use super::copy::copy;
use super::skin::{map_of, vector_of};
use super::tiny::LEAST;
use crate::dispatch::{self, Level};
use crate::lanes::block::{filled, read, write};
use crate::lanes::{VECTORS, three};
use crate::math::float::{abs, sqrt};
use crate::math::vec3::dot;

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

/// Softness and region of points, and what the regions show.
#[derive(Clone, Copy, Debug)]
pub struct Tissue<'a> {
    /// Share of the offset that is shown, one a point.
    pub softness: &'a [f32],
    /// One a point.
    pub region: &'a [u8],
    /// One a region.
    pub limits: &'a [Limit],
}

impl Tissue<'_> {
    /// Limit of a region; one that does not exist shows nothing.
    #[inline(always)]
    fn limit(&self, region: u8) -> Limit {
        let none = Limit { gain: 0.0, inverse_square: 0.0 };
        self.limits.get(usize::from(region)).copied().unwrap_or(none)
    }
}

/// Takes the offsets `y` (model space) of points to bind space.
///
/// * `palette`, `influences`: as in [`super::skin::skin`]; read only where a blended map has no inverse.
/// * `linear`: blended maps, as [`super::skin::skin`] leaves them.
/// * `out`: one a point; zero where the dominant joint's map has no inverse either. The shortest slice decides how many.
pub fn unskin(
    palette: &[Rows],
    influences: Influences<'_>,
    linear: &[LinearBlock],
    y: &[[f32; 3]],
    tissue: Tissue<'_>,
    out: &mut [[f32; 3]],
) {
    unskin_at(dispatch::widest(), palette, influences, linear, y, tissue, out);
}

/// [`unskin`] on some registers.
fn unskin_at(
    level: Level,
    palette: &[Rows],
    influences: Influences<'_>,
    linear: &[LinearBlock],
    y: &[[f32; 3]],
    tissue: Tissue<'_>,
    out: &mut [[f32; 3]],
) {
    if !VECTORS {
        return unskin_each(palette, influences, linear, y, tissue, out);
    }
    unskin_blocks_at(level, palette, influences, linear, y, tissue, out);
    let n = [out.len(), tissue.softness.len(), tissue.region.len(), linear.len() * BLOCK];
    let n = n.into_iter().fold(y.len(), usize::min);
    let whole = n / BLOCK * BLOCK;
    if whole < n {
        let mut last = [[0.0; 3]; BLOCK];
        let (softness, region) = (filled(&tissue.softness[whole..n]), filled(&tissue.region[whole..n]));
        let tissue = Tissue { softness: &softness, region: &region, ..tissue };
        let (influences, linear) = (influences.after(whole), &linear[whole / BLOCK..]);
        unskin_blocks_at(level, palette, influences, linear, &filled(&y[whole..n]), tissue, &mut last);
        copy(&last, &mut out[whole..n]);
    }
}

/// The definition of [`unskin`].
fn unskin_each(
    palette: &[Rows],
    influences: Influences<'_>,
    linear: &[LinearBlock],
    y: &[[f32; 3]],
    tissue: Tissue<'_>,
    out: &mut [[f32; 3]],
) {
    let maps = linear.iter().flat_map(|linear| (0..BLOCK).map(|lane| map_of(linear, lane)));
    let tissues = tissue.softness.iter().zip(tissue.region);
    for (i, (((y, out), m), (softness, region))) in y.iter().zip(out).zip(maps).zip(tissues).enumerate() {
        let limit = tissue.limit(*region);
        let soft = softness * limit.gain;
        let (shown, regular) = show(&m, *y, soft, limit.inverse_square);
        *out = shown;
        if !regular {
            *out = show(&dominant_map(palette, &influences, i), *y, soft, limit.inverse_square).0;
        }
    }
}

dispatch::copies!(unskin_blocks_at, unskin_blocks, (
    palette: &[Rows], influences: Influences<'_>, linear: &[LinearBlock], y: &[[f32; 3]], tissue: Tissue<'_>,
    out: &mut [[f32; 3]],
));

/// [`unskin`] of whole blocks.
#[inline(always)]
fn unskin_blocks(
    palette: &[Rows],
    influences: Influences<'_>,
    linear: &[LinearBlock],
    y: &[[f32; 3]],
    tissue: Tissue<'_>,
    out: &mut [[f32; 3]],
) {
    let points = y.as_chunks().0.iter().zip(out.as_chunks_mut().0).zip(linear);
    let tissues = tissue.softness.as_chunks::<BLOCK>().0.iter().zip(tissue.region.as_chunks::<BLOCK>().0);
    for (start, (((y, out), linear), (softness, region))) in (0..).step_by(BLOCK).zip(points.zip(tissues)) {
        let (mut soft, mut inverse_square) = ([0.0; BLOCK], [0.0; BLOCK]);
        for lane in 0..BLOCK {
            let limit = tissue.limit(region[lane]);
            (soft[lane], inverse_square[lane]) = (softness[lane] * limit.gain, limit.inverse_square);
        }
        let (mut v, mut regular) = (read(y), [true; BLOCK]);
        for lane in 0..BLOCK {
            let (m, y) = (map_of(linear, lane), vector_of(&v, lane));
            let (shown, fine) = show(&m, y, soft[lane], inverse_square[lane]);
            (v[0][lane], v[1][lane], v[2][lane]) = shown.into();
            regular[lane] = fine;
        }
        write(&v, out);
        if regular != [true; BLOCK] {
            let points = (start..).zip(y.iter().zip(out)).zip(soft.iter().zip(&inverse_square));
            for (((i, (y, out)), (soft, inverse_square)), _) in points.zip(regular).filter(|(_, fine)| !fine)
            {
                let m = dominant_map(palette, &influences, i);
                *out = show(&m, *y, *soft, *inverse_square).0;
            }
        }
    }
}

/// `o` of one point, `soft` the product of softness and gain, and whether its map has an inverse; zero if not.
#[inline(always)]
fn show(m: &Linear, y: [f32; 3], soft: f32, inverse_square: f32) -> ([f32; 3], bool) {
    let cofactors = Cofactors::new(m);
    let regular = cofactors.regular(m);
    let stretch = sqrt(1.0 + dot(y, y) * inverse_square);
    let factor = soft / (stretch * cofactors.determinant);
    // A product of numbers as large as are let in may overflow, one of small ones underflow.
    let bounded = |x: f32| if regular & (abs(x) < LARGEST) & (LEAST < abs(x)) { x } else { 0.0 };
    (three(|c| bounded(dot(cofactors.columns[c], y) * factor)), regular)
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
        let map = |i: u8| if Some(i) == singular { [[0.0; 3]; 4] } else { matrix(i) };
        let lanes: Vec<_> = (0..n).map(map).collect();
        let lane = |i: usize, c: usize, r: usize| lanes.get(i).map_or(0.0, |m| m[c][r]);
        let block = |k: usize| -> LinearBlock {
            [0, 1, 2].map(|c| [0, 1, 2].map(|r| core::array::from_fn(|i| lane(k * BLOCK + i, c, r))))
        };
        let linear: Vec<_> = (0..usize::from(n).div_ceil(BLOCK)).map(block).collect();
        let identity = [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0]];
        let (joints, weights) =
            (std::vec![[0; 4]; usize::from(n)], std::vec![[1.0, 0.0, 0.0, 0.0]; usize::from(n)]);
        let influences = Influences { sets: 1, joints: &joints, weights: &weights };
        let y: Vec<[f32; 3]> = (0..n).map(|i| [0.1, -0.02 * f32::from(i), 0.3]).collect();
        let softness: Vec<f32> = (0..n).map(|_| 0.75).collect();
        let region: Vec<u8> = (0..n).map(|i| i % 2).collect();
        let tissue = Tissue { softness: &softness, region: &region, limits: &LIMITS };
        let one = |level| {
            let mut out = std::vec![[f32::NAN; 3]; usize::from(n)];
            unskin_at(level, &[identity], influences, &linear, &y, tissue, &mut out);
            out
        };
        let mut each = std::vec![[f32::NAN; 3]; usize::from(n)];
        unskin_each(&[identity], influences, &linear, &y, tissue, &mut each);
        dispatch::levels().for_each(|level| assert_eq!(one(level), each, "{level:?}"));
        each
    }

    #[test]
    fn the_blended_matrix_undoes_it_and_limits_hold() {
        for (i, o) in (0..11).zip(run(11, None)) {
            let y = [0.1, -0.02 * f32::from(i), 0.3];
            let back = affine::rotate(&matrix(i), o);
            let factor = if i % 2 == 0 { 0.75 } else { 0.375 / sqrt(1.0 + 4.0 * dot(y, y)) };
            for k in 0..3 {
                assert!((back[k] - factor * y[k]).abs() < 1e-6, "{i}: {back:?}");
            }
        }
    }

    /// A point's bits do not depend on its place in a block.
    #[test]
    fn bits_do_not_depend_on_the_count_or_on_a_singular_neighbour() {
        let all = run(67, None);
        for n in (0..67).step_by(if cfg!(miri) { 13 } else { 1 }) {
            assert_eq!(run(n, None), all[..usize::from(n)], "{n} points");
        }
        for singular in [5, 40, 66] {
            let beside = run(67, Some(singular));
            let at = usize::from(singular);
            assert_eq!((&beside[..at], &beside[at + 1..]), (&all[..at], &all[at + 1..]), "neighbors");
            assert!(beside[at].iter().all(|x| x.is_finite() && *x != 0.0), "dominant joint stands in");
        }
    }
}
