//! Maps of a skeleton, blended at points.
//!
//! ```text
//! B = Σₖ wₖ·Mⱼₖ
//! q = Σₖ wₖ·sₖ·qⱼₖ / |…|,   sₖ = sign of qⱼₖ·q_dominant      (antipodal quaternions agree in sign)
//! ```
//!
//! Influences are sorted by falling weight: the first is the dominant one, and the first zero ends a row.

use super::cofactor::Linear;
pub use crate::lanes::block::{BLOCK, Vectors};
use crate::lanes::block::{GROUPS, after, put};
use crate::lanes::{each, three};
use crate::math::quat;
use wide::f32x4;

/// Rows of a joint's map, model from bind; the last column is the translation.
pub type Rows = [[f32; 4]; 3];

/// Linear parts of the maps of a block: columns.
pub type LinearBlock = [Vectors; 3];

/// Joint indices and weights, `sets` of four a point; weights fall and sum to 1.
#[derive(Clone, Copy, Debug, Default)]
pub struct Influences<'a> {
    /// Sets a point, at least 1.
    pub sets: usize,
    /// Rows of the palette.
    pub joints: &'a [[u16; 4]],
    /// Weight of each.
    pub weights: &'a [[f32; 4]],
}

impl<'a> Influences<'a> {
    /// A set of point `i`; weightless for a point past the end.
    #[inline(always)]
    pub(crate) fn set(&self, i: usize, set: usize) -> (&'a [u16; 4], &'a [f32; 4]) {
        let at = i * self.sets + set;
        match (self.joints.get(at), self.weights.get(at)) {
            (Some(joints), Some(weights)) => (joints, weights),
            _ => (&[0; 4], &[0.0; 4]),
        }
    }

    /// Those of the points from `i` on.
    pub(crate) fn after(&self, i: usize) -> Self {
        let sets = i * self.sets;
        Self { sets: self.sets, joints: after(self.joints, sets), weights: after(self.weights, sets) }
    }

    /// Joint with the largest weight at point `i`.
    #[must_use]
    pub fn dominant(&self, i: usize) -> usize {
        usize::from(self.set(i, 0).0[0])
    }
}

/// `B` of point `i`, its rows. A joint past the palette's end does not count.
#[inline(always)]
pub(crate) fn blend(palette: &[Rows], influences: &Influences<'_>, i: usize) -> Rows {
    let mut b = [[0.0; 4]; 3];
    for set in 0..influences.sets {
        let (joints, weights) = influences.set(i, set);
        for (joint, weight) in joints.iter().zip(weights) {
            if *weight <= 0.0 {
                return b;
            }
            if let Some(m) = palette.get(usize::from(*joint)) {
                b = three(|r| each(|c| b[r][c] + weight * m[r][c]));
            }
        }
    }
    b
}

/// [`blend`] of the points `point(lane)` to columns of linear part and translation, four at a time.
#[inline(always)]
pub(crate) fn blend_block(
    palette: &[Rows],
    influences: &Influences<'_>,
    point: impl Fn(usize) -> usize,
    [a, b, c, t]: [&mut Vectors; 4],
) {
    for group in 0..GROUPS {
        let maps = blend_four(palette, influences, each(|lane| point(4 * group + lane)));
        let rows = three(|r| f32x4::transpose(each(|lane| maps[lane][r])));
        // Written out: a loop that is not unrolled would keep all of it in memory.
        put(a, group, three(|r| rows[r][0]));
        put(b, group, three(|r| rows[r][1]));
        put(c, group, three(|r| rows[r][2]));
        put(t, group, three(|r| rows[r][3]));
    }
}

/// Rows of the maps of four points. A weight of 0 adds nothing: the longest row decides for all four.
#[inline(always)]
fn blend_four(palette: &[Rows], influences: &Influences<'_>, points: [usize; 4]) -> [[f32x4; 3]; 4] {
    let mut b = [[f32x4::ZERO; 3]; 4];
    for set in 0..influences.sets {
        let rows = each(|lane| influences.set(points[lane], set));
        for k in 0..4 {
            let [x, y, z, w] = each(|lane| rows[lane].1[k].to_bits());
            if x | y | z | w == 0 {
                return b;
            }
            b = each(|lane| {
                let ((joints, weights), b) = (rows[lane], b[lane]);
                let Some(m) = palette.get(usize::from(joints[k])) else { return b };
                let w = f32x4::splat(weights[k]);
                three(|r| b[r] + w * f32x4::from(m[r]))
            });
        }
    }
    b
}

/// Columns of the linear part of a joint's map.
#[inline(always)]
pub(crate) fn linear_of(m: &Rows) -> Linear {
    three(|c| three(|r| m[r][c]))
}

/// The linear map of the joint with the largest weight at point `i`. Rare, and kept out of the way.
#[cold]
#[inline(never)]
pub(crate) fn dominant_map(palette: &[Rows], influences: &Influences<'_>, i: usize) -> Linear {
    palette.get(influences.dominant(i)).map_or([[0.0; 3]; 3], linear_of)
}

/// Blended rotation of point `i` from the joints' unit quaternions; the dominant joint's where the sum vanishes.
#[must_use]
pub fn blend_rotation(rotations: &[[f32; 4]], influences: Influences<'_>, i: usize) -> [f32; 4] {
    let dominant = rotations.get(influences.dominant(i)).copied().unwrap_or(quat::IDENTITY);
    let mut sum = [0.0_f32; 4];
    let rows = (0..influences.sets).map(|set| influences.set(i, set));
    for (joint, weight) in rows.flat_map(|(joints, weights)| joints.iter().zip(weights)) {
        let q = rotations.get(usize::from(*joint)).copied().unwrap_or_default();
        let w = if quat::dot(q, dominant) < 0.0 { -weight } else { *weight };
        sum = core::array::from_fn(|c| sum[c] + w * q[c]);
    }
    if quat::dot(sum, sum) < 1e-6 { dominant } else { quat::normalize(sum) }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn turn(angle: f32) -> [f32; 4] {
        let (s, c) = crate::math::trig::sin_cos(0.5 * angle);
        [0.0, s, 0.0, c]
    }

    #[test]
    fn antipodal_quaternions_blend_as_the_same_rotation() {
        let (a, b) = (turn(0.4), turn(0.6));
        let influences = Influences { sets: 1, joints: &[[0, 1, 0, 0]], weights: &[[0.5, 0.5, 0.0, 0.0]] };
        let plain = blend_rotation(&[a, b], influences, 0);
        let flipped = blend_rotation(&[a, b.map(|c| -c)], influences, 0);
        assert_eq!(plain, flipped);
        assert!(quat::dot(plain, turn(0.5)) > 1.0 - 1e-6, "{plain:?}");
        let opposite = blend_rotation(&[turn(0.0), turn(0.0).map(|c| -c)], influences, 0);
        assert_eq!(opposite, turn(0.0));
    }
}
