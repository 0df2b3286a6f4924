//! Affine maps as four columns: `M·p = m₀·x + m₁·y + m₂·z + m₃`.

use super::{quat, vec3};

/// Columns x, y, z and translation.
pub type Affine = [[f32; 3]; 4];

/// The identity.
pub const IDENTITY: Affine = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [0.0; 3]];

/// Linear part times a vector.
#[inline(always)]
#[must_use]
pub fn rotate(m: &Affine, v: [f32; 3]) -> [f32; 3] {
    let row = |i: usize| m[0][i] * v[0] + m[1][i] * v[1] + m[2][i] * v[2];
    [row(0), row(1), row(2)]
}

/// Map of a point.
#[inline(always)]
#[must_use]
pub fn transform(m: &Affine, p: [f32; 3]) -> [f32; 3] {
    let row = |i: usize| (m[0][i] * p[0] + m[1][i] * p[1]) + (m[2][i] * p[2] + m[3][i]);
    [row(0), row(1), row(2)]
}

/// `a·b`: first `b`, then `a`.
#[must_use]
pub fn mul(a: &Affine, b: &Affine) -> Affine {
    [rotate(a, b[0]), rotate(a, b[1]), rotate(a, b[2]), vec3::add(rotate(a, b[3]), a[3])]
}

/// Translation · rotation · scale; the quaternion is normalized.
#[must_use]
pub fn from_trs(translation: [f32; 3], rotation: [f32; 4], scale: [f32; 3]) -> Affine {
    let r = quat::to_columns(rotation);
    [vec3::scale(r[0], scale[0]), vec3::scale(r[1], scale[1]), vec3::scale(r[2], scale[2]), translation]
}

/// The rows of a map; the last column is the translation.
#[inline(always)]
#[must_use]
pub fn to_rows(m: &Affine) -> [[f32; 4]; 3] {
    [0, 1, 2].map(|r| m.map(|column| column[r]))
}

/// Whether every entry is finite.
#[must_use]
pub fn is_finite(m: &Affine) -> bool {
    m.as_flattened().iter().all(|x| x.is_finite())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn product_applies_right_to_left() {
        let a = from_trs([1.0, 2.0, 3.0], [0.0, 0.0, 0.707_106_77, 0.707_106_77], [2.0, 1.0, 1.0]);
        let b = from_trs([-4.0, 0.5, 0.0], [0.6, 0.0, 0.0, 0.8], [1.0, 3.0, 1.0]);
        let p = [0.3, -0.7, 1.1];
        let (once, twice) = (transform(&mul(&a, &b), p), transform(&a, transform(&b, p)));
        for i in 0..3 {
            assert!((once[i] - twice[i]).abs() < 2e-6, "{once:?} {twice:?}");
        }
    }
}
