//! Linear blend skinning, and the rotation that goes with it.
//!
//! ```text
//! B = Σₖ wₖ·Mⱼₖ,   x = B·p,   n = cof(B₃ₓ₃)·n₀ / |…|,   cof(B) = det(B)·B⁻ᵀ
//! q = Σₖ wₖ·sₖ·qⱼₖ / |…|,   sₖ = sign of qⱼₖ·q_dominant      (antipodal quaternions agree in sign)
//! ```
//!
//! Influences are sorted by falling weight: the first is the dominant one, and the first zero ends a row.

use super::cofactor::{Cofactors, Linear};
use crate::dispatch;
pub use crate::lanes::block::{BLOCK, Vectors};
use crate::lanes::block::{read, write};
use crate::lanes::{F32x4, Lanes, each, three};
use crate::math::float::{max, sqrt};
use crate::math::{quat, vec3};

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
    fn set(&self, i: usize, set: usize) -> (&'a [u16; 4], &'a [f32; 4]) {
        let at = i * self.sets + set;
        match (self.joints.get(at), self.weights.get(at)) {
            (Some(joints), Some(weights)) => (joints, weights),
            _ => (&[0; 4], &[0.0; 4]),
        }
    }

    /// Joint with the largest weight at point `i`.
    #[must_use]
    pub fn dominant(&self, i: usize) -> usize {
        usize::from(self.set(i, 0).0[0])
    }
}

/// Blended maps `B` of the points `point(0)` to `point(n − 1)`, to columns of linear part and translation.
///
/// A joint past the palette's end does not count.
#[inline(always)]
fn blend<L: Lanes>(
    palette: &[Rows],
    influences: &Influences<'_>,
    (n, point): (usize, impl Fn(usize) -> usize),
    columns: [&mut Vectors; 4],
) {
    for group in (0..BLOCK / 4).take(n.div_ceil(4)) {
        let points = each(|lane| point((4 * group + lane).min(n - 1)));
        let b = blend_four::<L>(palette, influences, points);
        for r in 0..3 {
            let rows = L::transpose(each(|lane| b[lane][r]));
            for c in 0..4 {
                columns[c][r].as_chunks_mut().0[group] = rows[c].to_array();
            }
        }
    }
}

/// Rows of the maps of four points. A weight of 0 adds nothing: the longest row decides for all four.
#[inline(always)]
fn blend_four<L: Lanes>(palette: &[Rows], influences: &Influences<'_>, points: [usize; 4]) -> [[L; 3]; 4] {
    let mut b = [[L::splat(0.0); 3]; 4];
    for set in 0..influences.sets {
        let rows = each(|lane| influences.set(points[lane], set));
        for k in 0..4 {
            let [x, y, z, w] = each(|lane| rows[lane].1[k].to_bits());
            if x | y | z | w == 0 {
                return b;
            }
            for lane in 0..4 {
                let (joints, weights) = rows[lane];
                if let Some(m) = palette.get(usize::from(joints[k])) {
                    let w = L::splat(weights[k]);
                    b[lane] = three(|r| b[lane][r] + w * L::from_array(m[r]));
                }
            }
        }
    }
    b
}

/// The vector of a lane.
#[inline(always)]
pub(crate) fn vector_of(v: &Vectors, lane: usize) -> [f32; 3] {
    three(|r| v[r][lane])
}

/// The linear map of a lane.
#[inline(always)]
pub(crate) fn map_of(columns: &LinearBlock, lane: usize) -> Linear {
    three(|c| vector_of(&columns[c], lane))
}

/// `M·p + t`.
#[inline(always)]
fn apply([a, b, c]: &Linear, t: [f32; 3], [x, y, z]: [f32; 3]) -> [f32; 3] {
    three(|r| (a[r] * x + b[r] * y) + (c[r] * z + t[r]))
}

/// Skins points and keeps the linear parts of their blended maps.
///
/// * `palette`: a map a joint.
/// * `influences`, `rest` (bind space), `out` (model space): one a point; the shorter decides how many.
/// * `linear`: one a block of points.
pub fn skin(
    palette: &[Rows],
    influences: Influences<'_>,
    rest: &[[f32; 3]],
    out: &mut [[f32; 3]],
    linear: &mut [LinearBlock],
) {
    skin_at(dispatch::widest(), palette, influences, rest, out, linear);
}

dispatch::copies!(skin_at, skin_any::<F32x4>, (
    palette: &[Rows], influences: Influences<'_>, rest: &[[f32; 3]], out: &mut [[f32; 3]], linear: &mut [LinearBlock],
));

/// [`skin`] on a given lane type.
#[inline(always)]
fn skin_any<L: Lanes>(
    palette: &[Rows],
    influences: Influences<'_>,
    rest: &[[f32; 3]],
    out: &mut [[f32; 3]],
    linear: &mut [LinearBlock],
) {
    let [mut t, mut p] = [[[0.0; BLOCK]; 3]; 2];
    let blocks = rest.chunks(BLOCK).zip(out.chunks_mut(BLOCK)).zip(linear);
    for (start, ((rest, out), linear)) in (0..).step_by(BLOCK).zip(blocks) {
        let [a, b, c] = linear;
        let points = (rest.len(), |lane| start + lane);
        blend::<L>(palette, &influences, points, [a, b, c, &mut t]);
        read(rest, &mut p);
        for lane in 0..BLOCK {
            let moved = apply(&map_of(linear, lane), vector_of(&t, lane), vector_of(&p, lane));
            (p[0][lane], p[1][lane], p[2][lane]) = moved.into();
        }
        write(&p, out);
    }
}

/// Skins the vertices of a surface with their normals; vertex `v` has the influences of point `point_of_vertex[v]`.
///
/// `positions` and `normals` go in in bind space and come out in model space; the shortest slice decides how many.
/// A blended map that flattens a normal counts as the dominant joint's; one without a direction then too stays.
pub fn skin_surface(
    palette: &[Rows],
    influences: Influences<'_>,
    point_of_vertex: &[u32],
    positions: &mut [[f32; 3]],
    normals: &mut [[f32; 3]],
) {
    skin_surface_at(dispatch::widest(), palette, influences, point_of_vertex, positions, normals);
}

dispatch::copies!(skin_surface_at, skin_surface_any::<F32x4>, (
    palette: &[Rows], influences: Influences<'_>, points: &[u32], positions: &mut [[f32; 3]], normals: &mut [[f32; 3]],
));

/// [`skin_surface`] on a given lane type.
#[inline(always)]
fn skin_surface_any<L: Lanes>(
    palette: &[Rows],
    influences: Influences<'_>,
    point_of_vertex: &[u32],
    positions: &mut [[f32; 3]],
    normals: &mut [[f32; 3]],
) {
    // |cof(B)·n|² is of the order of the fourth power of the columns.
    let least = 1e-12 * longest_square(palette) * longest_square(palette);
    let ([mut t, mut p, mut n], mut linear) = ([[[0.0; BLOCK]; 3]; 3], [[[0.0; BLOCK]; 3]; 3]);
    let mut usable = [true; BLOCK];
    let surface = positions.chunks_mut(BLOCK).zip(normals.chunks_mut(BLOCK));
    for (points, (positions, normals)) in point_of_vertex.chunks(BLOCK).zip(surface) {
        let point = |lane| points.get(lane).map_or(0, |point| *point as usize);
        let [a, b, c] = &mut linear;
        blend::<L>(palette, &influences, (points.len(), point), [a, b, c, &mut t]);
        read(positions, &mut p);
        read(normals, &mut n);
        for lane in 0..BLOCK {
            let m = map_of(&linear, lane);
            let moved = apply(&m, vector_of(&t, lane), vector_of(&p, lane));
            let (turned, fine) = turn_normal(&m, vector_of(&n, lane), least);
            (p[0][lane], p[1][lane], p[2][lane]) = moved.into();
            (n[0][lane], n[1][lane], n[2][lane]) = turned.into();
            usable[lane] = fine;
        }
        write(&p, positions);
        write(&n, normals);
        if usable != [true; BLOCK] {
            let flat = (0..).zip(normals).zip(usable).filter(|(_, usable)| !usable);
            for ((lane, normal), _) in flat {
                let m = dominant_map(palette, &influences, point(lane));
                *normal = turn_normal(&m, *normal, 0.0).0;
            }
        }
    }
}

/// Columns of the linear part of a joint's map.
#[inline(always)]
fn linear_of(m: &Rows) -> Linear {
    three(|c| three(|r| m[r][c]))
}

/// The linear map of the joint with the largest weight at point `i`. Rare, and kept out of the way.
#[cold]
#[inline(never)]
pub(crate) fn dominant_map(palette: &[Rows], influences: &Influences<'_>, i: usize) -> Linear {
    palette.get(influences.dominant(i)).map_or([[0.0; 3]; 3], linear_of)
}

/// Square of the longest column of the linear parts.
fn longest_square(palette: &[Rows]) -> f32 {
    let columns = palette.iter().flat_map(linear_of);
    columns.fold(0.0, |longest, c| max(longest, vec3::dot(c, c)))
}

/// A normal turned, and whether it is usable: finite, and its square above `least`. Otherwise it stays.
#[inline(always)]
fn turn_normal(m: &Linear, n: [f32; 3], least: f32) -> ([f32; 3], bool) {
    let cofactors = Cofactors::new(m);
    let turned = cofactors.turn(n);
    let square = vec3::dot(turned, turned);
    let sign = if cofactors.determinant < 0.0 { -1.0 } else { 1.0 };
    let (scale, usable) = (sign / sqrt(square), (least < square) & (square < f32::INFINITY));
    (three(|k| if usable { turned[k] * scale } else { n[k] }), usable)
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
    extern crate std;
    use super::*;
    use crate::math::affine::{self, to_rows};
    use std::vec;
    use std::vec::Vec;

    fn turn(angle: f32) -> [f32; 4] {
        let (s, c) = crate::math::trig::sin_cos(0.5 * angle);
        [0.0, s, 0.0, c]
    }

    #[test]
    fn a_rigid_joint_moves_points_rigidly() {
        let m = affine::from_trs([1.0, -2.0, 0.5], turn(0.8), [1.0; 3]);
        let influences = Influences { sets: 1, joints: &[[0; 4]], weights: &[[1.0, 0.0, 0.0, 0.0]] };
        let (mut out, mut linear) = ([[0.0; 3]], [[[[0.0; BLOCK]; 3]; 3]]);
        skin(&[to_rows(&m)], influences, &[[0.3, 0.2, -0.1]], &mut out, &mut linear);
        assert_eq!(out[0], affine::transform(&m, [0.3, 0.2, -0.1]));
        assert_eq!(linear[0].map(|c| c.map(|lanes| lanes[0])), [m[0], m[1], m[2]]);
    }

    #[test]
    fn normals_follow_the_inverse_transpose_and_mirrors() {
        let influences = Influences { sets: 1, joints: &[[0; 4]], weights: &[[1.0, 0.0, 0.0, 0.0]] };
        for (scale, want) in [([2.0, 1.0, 1.0], [1.0, 2.0]), ([-2.0, 1.0, 1.0], [-1.0, 2.0])] {
            let m = affine::from_trs([0.0; 3], quat::IDENTITY, scale);
            let (mut p, mut n) = ([[0.0; 3]], [vec3::normalize_or([1.0, 1.0, 0.0], [0.0; 3])]);
            skin_surface(&[to_rows(&m)], influences, &[0], &mut p, &mut n);
            let want = vec3::normalize_or([want[0], want[1], 0.0], [0.0; 3]);
            assert!(vec3::dot(n[0], want) > 1.0 - 1e-6, "{:?} {want:?}", n[0]);
        }
    }

    #[test]
    fn a_flattened_blend_falls_back_to_the_dominant_joint() {
        // Half a turn apart: the blend collapses the plane to a line.
        let half = affine::from_trs([0.0; 3], turn(core::f32::consts::PI), [1.0; 3]);
        let palette = [to_rows(&affine::IDENTITY), to_rows(&half)];
        let influences = Influences { sets: 1, joints: &[[0, 1, 0, 0]], weights: &[[0.5, 0.5, 0.0, 0.0]] };
        let (mut p, mut n) = ([[1.0, 0.0, 0.0]], [[1.0, 0.0, 0.0]]);
        skin_surface(&palette, influences, &[0], &mut p, &mut n);
        assert_eq!(n[0], [1.0, 0.0, 0.0]);
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

    /// Skins vertices in place: points, positions, normals.
    type Skin<'a> = &'a dyn Fn(&[u32], &mut [[f32; 3]], &mut [[f32; 3]]);
    type Kernel = fn(&[Rows], Influences<'_>, &[u32], &mut [[f32; 3]], &mut [[f32; 3]]);

    /// A vertex has the same bits in a block, in the tail and alone, in each copy that this machine can run and on
    /// scalar lanes, beside a flattened blend too.
    #[test]
    fn a_vertex_does_not_depend_on_its_place() {
        use crate::lanes::Scalar;
        let turned =
            |i: u8| affine::from_trs([f32::from(i), 0.1, -0.2], turn(0.7 * f32::from(i)), [1.0, 1.3, -0.8]);
        let mut palette: Vec<Rows> = (0..5).map(|i| to_rows(&turned(i))).collect();
        palette.push([[0.0; 4]; 3]);
        let n = 67_u16;
        let joints: Vec<[u16; 4]> = (0..2 * n).map(|i| [0, 3, 2, 4].map(|k| (k + i * 7) % 6)).collect();
        let row = |i: u16| match i % 6 {
            5 => [[1.0, 0.0, 0.0, 0.0], [0.0; 4]],
            4 => [[0.4, 0.2, 0.1, 0.1], [0.1, 0.1, 0.0, 0.0]],
            _ => [[0.6, 0.4, 0.0, 0.0], [0.0; 4]],
        };
        let weights: Vec<[f32; 4]> = (0..n).flat_map(row).collect();
        let influences = Influences { sets: 2, joints: &joints, weights: &weights };
        let rest: Vec<[f32; 3]> = (0..n).map(|i| [0.3, -0.02 * f32::from(i), 0.9]).collect();
        let run = |points: &[u32], kernel: Skin<'_>| {
            let mut p: Vec<[f32; 3]> = points.iter().map(|i| rest[*i as usize]).collect();
            let mut n: Vec<[f32; 3]> = p.iter().map(|p| vec3::normalize_or(*p, [0.0; 3])).collect();
            kernel(points, &mut p, &mut n);
            p.into_iter().zip(n).map(|vertex| <[_; 2]>::from(vertex).map(|v| v.map(f32::to_bits)))
        };
        let plain: Kernel = skin_surface_any::<Scalar>;
        let all: Vec<u32> = (0..u32::from(n)).collect();
        let alone = |vertex: &u32| run(&[*vertex], &|v, p, n| plain(&palette, influences, v, p, n)).next();
        let want: Vec<_> = all.iter().filter_map(alone).collect();
        for count in 0..all.len() {
            let from = all.len() - count;
            for level in dispatch::levels() {
                let found: Vec<_> = run(&all[from..], &|v, p, n| {
                    skin_surface_at(level, &palette, influences, v, p, n);
                })
                .collect();
                assert_eq!(found, want[from..], "{level:?}: {count} vertices");
                let (mut out, mut linear) = (vec![[9.0; 3]; count], vec![[[[0.0; BLOCK]; 3]; 3]; 3]);
                skin_at(level, &palette, influences, &rest[..count], &mut out, &mut linear);
                let bits: Vec<_> = out.iter().map(|p| p.map(f32::to_bits)).collect();
                let first: Vec<_> = want.iter().take(count).map(|[p, _]| *p).collect();
                assert_eq!(bits, first, "{level:?}: {count} points");
            }
        }
    }
}
