//! Linear blend skinning, and the rotation that goes with it.
//!
//! ```text
//! B = Σₖ wₖ·Mⱼₖ,   x = B·p,   n = cof(B₃ₓ₃)·n₀ / |…|,   cof(B) = det(B)·B⁻ᵀ
//! q = Σₖ wₖ·sₖ·qⱼₖ / |…|,   sₖ = sign of qⱼₖ·q_dominant      (antipodal quaternions agree in sign)
//! ```
//!
//! Influences are sorted by falling weight: the first is the dominant one, and the first zero ends a row.

use crate::lanes::{F32x4, Lanes};
use crate::math::float::max;
use crate::math::{quat, vec3};

/// Columns of a joint's matrix, model from bind, padded to four lanes.
pub type Columns = [[f32; 4]; 4];

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

/// Blended matrix `B` of point `i`.
#[inline(always)]
fn blend<L: Lanes>(palette: &[Columns], influences: &Influences<'_>, i: usize) -> [L; 4] {
    let mut b = [L::splat(0.0); 4];
    for (joint, weight) in influences.row(i) {
        let (w, m) = (L::splat(weight), &palette[joint]);
        b = core::array::from_fn(|c| b[c] + w * L::from_array(m[c]));
    }
    b
}

#[inline(always)]
fn apply<L: Lanes>(b: &[L; 4], p: [f32; 3]) -> [f32; 3] {
    let [x, y, z] = p.map(L::splat);
    let [x, y, z, _] = ((b[0] * x + b[1] * y) + (b[2] * z + b[3])).to_array();
    [x, y, z]
}

/// Skins points and keeps the linear part of each blended matrix.
///
/// * `palette`: one matrix a joint, model from bind.
/// * `influences`, `rest` (bind space), `out` (model space), `linear` (columns of `B₃ₓ₃`): one a point.
///
/// # Panics
///
/// If the lengths differ, or a joint index is out of range (a parsed asset holds neither).
pub fn skin(
    palette: &[Columns],
    influences: Influences<'_>,
    rest: &[[f32; 3]],
    out: &mut [[f32; 3]],
    linear: &mut [[[f32; 4]; 3]],
) {
    skin_with::<F32x4>(palette, influences, rest, out, linear);
}

/// [`skin`] on a given lane type.
pub(crate) fn skin_with<L: Lanes>(
    palette: &[Columns],
    influences: Influences<'_>,
    rest: &[[f32; 3]],
    out: &mut [[f32; 3]],
    linear: &mut [[[f32; 4]; 3]],
) {
    assert!(rest.len() == out.len() && rest.len() == linear.len(), "skin: lengths differ");
    for (i, ((p, out), linear)) in rest.iter().zip(out).zip(linear).enumerate() {
        let b = blend::<L>(palette, &influences, i);
        *out = apply(&b, *p);
        *linear = [b[0].to_array(), b[1].to_array(), b[2].to_array()];
    }
}

/// Skins the vertices of a surface with their normals; vertex `v` has the influences of point `point_of_vertex[v]`.
///
/// `positions` and `normals` go in in bind space and come out in model space. A blended matrix
/// without an inverse counts as the dominant joint's for the normal; one without a direction stays.
///
/// # Panics
///
/// If the lengths differ, or an index is out of range.
pub fn skin_surface(
    palette: &[Columns],
    influences: Influences<'_>,
    point_of_vertex: &[u32],
    positions: &mut [[f32; 3]],
    normals: &mut [[f32; 3]],
) {
    let n = point_of_vertex.len();
    assert!(positions.len() == n && normals.len() == n, "skin: lengths differ");
    for ((point, position), normal) in point_of_vertex.iter().zip(positions).zip(normals) {
        let point = *point as usize;
        let b = blend::<F32x4>(palette, &influences, point);
        *position = apply(&b, *position);
        let linear = [b[0].to_array(), b[1].to_array(), b[2].to_array()];
        let fallback = || linear_of(&palette[influences.dominant(point)]);
        *normal = skin_normal(&linear, fallback, *normal);
    }
}

/// Columns of the linear part of a joint's matrix.
#[must_use]
pub fn linear_of(m: &Columns) -> [[f32; 4]; 3] {
    [m[0], m[1], m[2]]
}

/// Cofactor columns of a linear map and its determinant.
#[inline(always)]
#[must_use]
pub fn cofactors(m: &[[f32; 4]; 3]) -> ([[f32; 3]; 3], f32) {
    let [a, b, c] = m.map(|[x, y, z, _]| [x, y, z]);
    let columns = [vec3::cross(b, c), vec3::cross(c, a), vec3::cross(a, b)];
    (columns, vec3::dot(a, columns[0]))
}

/// Whether a determinant is too small to be inverted: below 1e-6 of the longest column's cube.
#[inline(always)]
#[must_use]
pub fn is_singular(m: &[[f32; 4]; 3], determinant: f32) -> bool {
    let square = |c: [f32; 4]| c[0] * c[0] + c[1] * c[1] + c[2] * c[2];
    let longest = max(max(square(m[0]), square(m[1])), square(m[2]));
    determinant * determinant <= 1e-12 * longest * longest * longest
}

fn skin_normal(m: &[[f32; 4]; 3], fallback: impl Fn() -> [[f32; 4]; 3], n: [f32; 3]) -> [f32; 3] {
    let (mut c, mut determinant) = cofactors(m);
    if is_singular(m, determinant) {
        (c, determinant) = cofactors(&fallback());
    }
    let turned = [0, 1, 2].map(|i| (c[0][i] * n[0] + c[1][i] * n[1]) + c[2][i] * n[2]);
    let sign = if determinant < 0.0 { -1.0 } else { 1.0 };
    vec3::normalize_or(vec3::scale(turned, sign), n)
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
    use crate::math::affine;
    use std::vec;
    use std::vec::Vec;

    fn columns(m: &affine::Affine) -> Columns {
        [0, 1, 2, 3].map(|c| [m[c][0], m[c][1], m[c][2], 0.0])
    }

    fn turn(angle: f32) -> [f32; 4] {
        let (s, c) = crate::math::float::sin_cos(0.5 * angle);
        [0.0, s, 0.0, c]
    }

    #[test]
    fn a_rigid_joint_moves_points_rigidly() {
        let m = affine::from_trs([1.0, -2.0, 0.5], turn(0.8), [1.0; 3]);
        let influences = Influences { stride: 4, joints: &[0, 0, 0, 0], weights: &[1.0, 0.0, 0.0, 0.0] };
        let (mut out, mut linear) = ([[0.0; 3]], [[[0.0; 4]; 3]]);
        skin(&[columns(&m)], influences, &[[0.3, 0.2, -0.1]], &mut out, &mut linear);
        assert_eq!(out[0], affine::transform(&m, [0.3, 0.2, -0.1]));
        assert_eq!(linear[0].map(|[x, y, z, _]| [x, y, z]), [m[0], m[1], m[2]]);
    }

    #[test]
    fn normals_follow_the_inverse_transpose_and_mirrors() {
        let influences = Influences { stride: 1, joints: &[0], weights: &[1.0] };
        for (scale, want) in [([2.0, 1.0, 1.0], [1.0, 2.0]), ([-2.0, 1.0, 1.0], [-1.0, 2.0])] {
            let m = affine::from_trs([0.0; 3], quat::IDENTITY, scale);
            let (mut p, mut n) = ([[0.0; 3]], [vec3::normalize_or([1.0, 1.0, 0.0], [0.0; 3])]);
            skin_surface(&[columns(&m)], influences, &[0], &mut p, &mut n);
            let want = vec3::normalize_or([want[0], want[1], 0.0], [0.0; 3]);
            assert!(vec3::dot(n[0], want) > 1.0 - 1e-6, "{:?} {want:?}", n[0]);
        }
    }

    #[test]
    fn a_flattened_blend_falls_back_to_the_dominant_joint() {
        // Half a turn apart: the blend collapses the plane to a line.
        let half = affine::from_trs([0.0; 3], turn(core::f32::consts::PI), [1.0; 3]);
        let palette = [columns(&affine::IDENTITY), columns(&half)];
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
        let palette: Vec<Columns> = (0..7_u8)
            .map(|i| {
                columns(&affine::from_trs([f32::from(i), 0.1, -0.2], turn(0.3 * f32::from(i)), [1.1; 3]))
            })
            .collect();
        for n in 0..33_usize {
            let joints: Vec<u16> = (0..4 * n).map(|i| u16::try_from(i * 5 % 7).unwrap()).collect();
            let weights: Vec<f32> = (0..n).flat_map(|_| [0.4, 0.3, 0.2, 0.1]).collect();
            let rest = vec![[0.3, -0.7, 0.9]; n];
            let influences = Influences { stride: 4, joints: &joints, weights: &weights };
            let mut a = (vec![[0.0; 3]; n], vec![[[0.0; 4]; 3]; n]);
            let mut b = a.clone();
            skin_with::<F32x4>(&palette, influences, &rest, &mut a.0, &mut a.1);
            skin_with::<Scalar>(&palette, influences, &rest, &mut b.0, &mut b.1);
            assert_eq!(a, b);
        }
    }
}
