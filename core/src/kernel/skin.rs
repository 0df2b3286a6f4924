//! Linear blend skinning, and the rotation that goes with it.
//!
//! ```text
//! B = Σₖ wₖ·Mⱼₖ,   x = B·p,   n = cof(B₃ₓ₃)·n₀ / |…|,   cof(B) = det(B)·B⁻ᵀ
//! q = Σₖ wₖ·sₖ·qⱼₖ / |…|,   sₖ = sign of qⱼₖ·q_dominant      (antipodal quaternions agree in sign)
//! ```
//!
//! Influences are sorted by falling weight: the first is the dominant one, and the first zero ends a row.

use crate::lanes::four::{self, Cofactors, Linear, Vectors, each, three};
use crate::lanes::{F32x4, Lanes};
use crate::math::float::max;
use crate::math::{quat, vec3};

/// Rows of a joint's map, model from bind; the last column is the translation.
pub type Rows = [[f32; 4]; 3];

/// Linear parts of the maps of four points: columns of three components, a lane a point.
pub type LinearBlock = [[[f32; 4]; 3]; 3];

/// Joint indices and weights, `stride` a point; weights fall and sum to 1.
#[derive(Clone, Copy, Debug, Default)]
pub struct Influences<'a> {
    /// Influences a point, at least 1.
    pub stride: usize,
    /// Rows of the palette.
    pub joints: &'a [u16],
    /// Weight of each.
    pub weights: &'a [f32],
}

impl Influences<'_> {
    /// Influences of point `i` that weigh anything.
    #[inline(always)]
    fn row(&self, i: usize) -> impl Iterator<Item = (usize, f32)> + '_ {
        let range = i * self.stride..(i + 1) * self.stride;
        let joints = self.joints[range.clone()].iter().map(|j| usize::from(*j));
        joints.zip(self.weights[range].iter().copied()).take_while(|(_, w)| *w > 0.0)
    }

    /// Joint with the largest weight at point `i`.
    #[must_use]
    pub fn dominant(&self, i: usize) -> usize {
        usize::from(self.joints[i * self.stride])
    }
}

/// Rows of the blended map `B` of point `i`.
#[inline(always)]
fn blend<L: Lanes>(palette: &[Rows], influences: &Influences<'_>, i: usize) -> [L; 3] {
    let mut b = [L::splat(0.0); 3];
    for (joint, weight) in influences.row(i) {
        let (w, m) = (L::splat(weight), &palette[joint]);
        b = three(|r| b[r] + w * L::from_array(m[r]));
    }
    b
}

/// Blended maps of four points.
struct Blended<L> {
    linear: Linear<L>,
    translation: Vectors<L>,
}

impl<L: Lanes> Blended<L> {
    #[inline(always)]
    fn new(palette: &[Rows], influences: &Influences<'_>, points: [usize; 4]) -> Self {
        let b = each(|i| blend::<L>(palette, influences, points[i]));
        let rows = three(|r| L::transpose(each(|i| b[i][r])));
        let column = |c: usize| three(|r| rows[r][c]);
        Self { linear: three(column), translation: column(3) }
    }

    #[inline(always)]
    fn apply(&self, [x, y, z]: Vectors<L>) -> Vectors<L> {
        let [a, b, c] = &self.linear;
        three(|r| (a[r] * x + b[r] * y) + (c[r] * z + self.translation[r]))
    }
}

/// Skins points and keeps the linear parts of their blended maps.
///
/// * `palette`: a map a joint.
/// * `influences`, `rest` (bind space), `out` (model space): one a point.
/// * `linear`: one a block of four points; in the last the last point fills what is left.
///
/// # Panics
///
/// If the lengths differ, or a joint index is out of range (a parsed asset holds neither).
pub fn skin(
    palette: &[Rows],
    influences: Influences<'_>,
    rest: &[[f32; 3]],
    out: &mut [[f32; 3]],
    linear: &mut [LinearBlock],
) {
    skin_with::<F32x4>(palette, influences, rest, out, linear);
}

/// [`skin`] on a given lane type.
pub(crate) fn skin_with<L: Lanes>(
    palette: &[Rows],
    influences: Influences<'_>,
    rest: &[[f32; 3]],
    out: &mut [[f32; 3]],
    linear: &mut [LinearBlock],
) {
    let n = rest.len();
    assert!(out.len() == n && linear.len() == n.div_ceil(4), "skin: lengths differ");
    for (k, linear) in linear.iter_mut().enumerate() {
        let i = 4 * k;
        let points = each(|lane| (i + lane).min(n - 1));
        let blended = Blended::<L>::new(palette, &influences, points);
        four::store(blended.apply(four::load(rest, i)), out, i);
        *linear = three(|c| three(|r| blended.linear[c][r].to_array()));
    }
}

/// Skins the vertices of a surface with their normals; vertex `v` has the influences of point `point_of_vertex[v]`.
///
/// `positions` and `normals` go in in bind space and come out in model space. A blended map that
/// flattens a normal counts as the dominant joint's; one without a direction then too stays.
///
/// # Panics
///
/// If the lengths differ, or an index is out of range.
pub fn skin_surface(
    palette: &[Rows],
    influences: Influences<'_>,
    point_of_vertex: &[u32],
    positions: &mut [[f32; 3]],
    normals: &mut [[f32; 3]],
) {
    skin_surface_with::<F32x4>(palette, influences, point_of_vertex, positions, normals);
}

/// [`skin_surface`] on a given lane type.
pub(crate) fn skin_surface_with<L: Lanes>(
    palette: &[Rows],
    influences: Influences<'_>,
    point_of_vertex: &[u32],
    positions: &mut [[f32; 3]],
    normals: &mut [[f32; 3]],
) {
    let n = point_of_vertex.len();
    assert!(positions.len() == n && normals.len() == n, "skin: lengths differ");
    // |cof(B)·n|² is of the order of the fourth power of the columns.
    let least = L::splat(1e-12 * longest_square(palette) * longest_square(palette));
    for i in (0..n).step_by(4) {
        let points = four::read(point_of_vertex, i);
        let points = each(|lane| points[lane] as usize);
        let blended = Blended::<L>::new(palette, &influences, points);
        four::store(blended.apply(four::load(positions, i)), positions, i);
        let dominant = |lane: usize| linear_of(&palette[influences.dominant(points[lane])]);
        let (cofactors, n) = (Cofactors::new(&blended.linear), four::load(normals, i));
        let (mut turned, usable) = turn_normals(&cofactors, &n, least);
        if !L::all(usable) {
            let cofactors = Cofactors::replaced(&blended.linear, usable, &dominant);
            turned = turn_normals(&cofactors, &n, L::splat(0.0)).0;
        }
        four::store(turned, normals, i);
    }
}

/// Columns of the linear part of a joint's map.
#[must_use]
pub fn linear_of(m: &Rows) -> [[f32; 3]; 3] {
    [0, 1, 2].map(|c| m.map(|row| row[c]))
}

/// Square of the longest column of the linear parts.
fn longest_square(palette: &[Rows]) -> f32 {
    let columns = palette.iter().flat_map(linear_of);
    columns.fold(0.0, |longest, c| max(longest, vec3::dot(c, c)))
}

/// Normals `n` turned, and where they are usable: finite, and their squares above `least`. Elsewhere they stay.
#[inline(always)]
fn turn_normals<L: Lanes>(cofactors: &Cofactors<L>, n: &Vectors<L>, least: L) -> (Vectors<L>, L::Mask) {
    let (zero, one) = (L::splat(0.0), L::splat(1.0));
    let turned = four::mul(&cofactors.columns, n);
    let square = four::dot(&turned, &turned);
    let sign = L::select(cofactors.determinant.lt(zero), zero - one, one);
    let (scale, usable) = (sign / square.sqrt(), least.lt(square) & square.lt(L::splat(f32::INFINITY)));
    (three(|k| L::select(usable, turned[k] * scale, n[k])), usable)
}

/// Blended rotation of point `i` from the joints' unit quaternions; the dominant joint's where the sum vanishes.
///
/// # Panics
///
/// If an index is out of range.
#[must_use]
pub fn blend_rotation(rotations: &[[f32; 4]], influences: Influences<'_>, i: usize) -> [f32; 4] {
    let dominant = rotations[influences.dominant(i)];
    let mut sum = [0.0_f32; 4];
    for (joint, weight) in influences.row(i) {
        let q = rotations[joint];
        let w = if quat::dot(q, dominant) < 0.0 { -weight } else { weight };
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
        let influences = Influences { stride: 4, joints: &[0, 0, 0, 0], weights: &[1.0, 0.0, 0.0, 0.0] };
        let (mut out, mut linear) = ([[0.0; 3]], [[[[0.0; 4]; 3]; 3]]);
        skin(&[to_rows(&m)], influences, &[[0.3, 0.2, -0.1]], &mut out, &mut linear);
        assert_eq!(out[0], affine::transform(&m, [0.3, 0.2, -0.1]));
        assert_eq!(linear[0].map(|c| c.map(|lanes| lanes[0])), [m[0], m[1], m[2]]);
    }

    #[test]
    fn normals_follow_the_inverse_transpose_and_mirrors() {
        let influences = Influences { stride: 1, joints: &[0], weights: &[1.0] };
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
        let influences = Influences { stride: 2, joints: &[0, 1], weights: &[0.5, 0.5] };
        let (mut p, mut n) = ([[1.0, 0.0, 0.0]], [[1.0, 0.0, 0.0]]);
        skin_surface(&palette, influences, &[0], &mut p, &mut n);
        assert_eq!(n[0], [1.0, 0.0, 0.0]);
    }

    #[test]
    fn antipodal_quaternions_blend_as_the_same_rotation() {
        let (a, b) = (turn(0.4), turn(0.6));
        let influences = Influences { stride: 2, joints: &[0, 1], weights: &[0.5, 0.5] };
        let plain = blend_rotation(&[a, b], influences, 0);
        let flipped = blend_rotation(&[a, b.map(|c| -c)], influences, 0);
        assert_eq!(plain, flipped);
        assert!(quat::dot(plain, turn(0.5)) > 1.0 - 1e-6, "{plain:?}");
        let opposite = blend_rotation(&[turn(0.0), turn(0.0).map(|c| -c)], influences, 0);
        assert_eq!(opposite, turn(0.0));
    }

    #[test]
    fn lanes_agree_with_scalar_bit_for_bit() {
        use crate::lanes::Scalar;
        let palette: Vec<Rows> = (0..7_u8)
            .map(|i| {
                to_rows(&affine::from_trs([f32::from(i), 0.1, -0.2], turn(0.3 * f32::from(i)), [1.1; 3]))
            })
            .collect();
        for n in 0..33_usize {
            let joints: Vec<u16> = (0..4 * n).map(|i| u16::try_from(i * 5 % 7).unwrap()).collect();
            let weights: Vec<f32> = (0..n).flat_map(|_| [0.4, 0.3, 0.2, 0.1]).collect();
            let rest = vec![[0.3, -0.7, 0.9]; n];
            let influences = Influences { stride: 4, joints: &joints, weights: &weights };
            let mut a = (vec![[0.0; 3]; n], vec![[[[0.0; 4]; 3]; 3]; n.div_ceil(4)]);
            let mut b = a.clone();
            skin_with::<F32x4>(&palette, influences, &rest, &mut a.0, &mut a.1);
            skin_with::<Scalar>(&palette, influences, &rest, &mut b.0, &mut b.1);
            assert_eq!(a, b);
        }
    }

    type Kernel = fn(&[Rows], Influences<'_>, &[u32], &mut [[f32; 3]], &mut [[f32; 3]]);

    /// A vertex has the same bits in a block, in the tail and on scalar lanes, beside a flattened blend too.
    #[test]
    fn a_normal_does_not_depend_on_its_place() {
        use crate::lanes::Scalar;
        let turned = |i: u8| affine::from_trs([0.0; 3], turn(0.7 * f32::from(i)), [1.0, 1.3, -0.8]);
        let mut palette: Vec<Rows> = (0..5).map(|i| to_rows(&turned(i))).collect();
        palette.push([[0.0; 4]; 3]);
        let n = 23_u16;
        let joints: Vec<u16> = (0..2 * n).map(|i| i * 7 % 6).collect();
        let weights: Vec<f32> =
            (0..n).flat_map(|i| if i % 6 == 5 { [1.0, 0.0] } else { [0.6, 0.4] }).collect();
        let influences = Influences { stride: 2, joints: &joints, weights: &weights };
        let rest: Vec<[f32; 3]> = (0..n).map(|i| [0.3, -0.02 * f32::from(i), 0.9]).collect();
        let run = |points: &[u32], kernel: Kernel| {
            let mut p: Vec<[f32; 3]> = points.iter().map(|i| rest[*i as usize]).collect();
            let mut n: Vec<[f32; 3]> = p.iter().map(|p| vec3::normalize_or(*p, [0.0; 3])).collect();
            kernel(&palette, influences, points, &mut p, &mut n);
            p.concat().iter().chain(n.concat().iter()).map(|x| x.to_bits()).collect::<Vec<_>>()
        };
        let all: Vec<u32> = (0..u32::from(n)).collect();
        for from in 0..5 {
            let part = run(&all[from..], skin_surface_with::<F32x4>);
            assert_eq!(part, run(&all[from..], skin_surface_with::<Scalar>), "from {from}");
            for (i, vertex) in all[from..].iter().enumerate() {
                let alone = run(&[*vertex], skin_surface_with::<F32x4>);
                let half = part.len() / 2;
                let whole = [&part[3 * i..3 * i + 3], &part[half + 3 * i..half + 3 * i + 3]].concat();
                assert_eq!(alone, whole, "vertex {vertex} from {from}");
            }
        }
    }
}
