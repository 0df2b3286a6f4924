//! Unit quaternions `[x, y, z, w]`.

use super::float::sqrt;
use super::trig::{acos, sin};

/// No rotation.
pub const IDENTITY: [f32; 4] = [0.0, 0.0, 0.0, 1.0];

/// Four-component dot product as `(x + y) + (z + w)`.
#[inline(always)]
#[must_use]
pub fn dot(a: [f32; 4], b: [f32; 4]) -> f32 {
    (a[0] * b[0] + a[1] * b[1]) + (a[2] * b[2] + a[3] * b[3])
}

/// `q/|q|`, or the identity where `|q|²` is zero or not finite.
#[must_use]
pub fn normalize(q: [f32; 4]) -> [f32; 4] {
    let square = dot(q, q);
    if square > 0.0 && square < f32::INFINITY {
        let length = sqrt(square);
        q.map(|c| c / length)
    } else {
        IDENTITY
    }
}

/// Conjugate: the inverse of a unit quaternion.
#[must_use]
pub fn conjugate(q: [f32; 4]) -> [f32; 4] {
    [-q[0], -q[1], -q[2], q[3]]
}

/// Hamilton product `a·b`: first `b`, then `a`.
#[must_use]
pub fn mul(a: [f32; 4], b: [f32; 4]) -> [f32; 4] {
    [
        (a[3] * b[0] + a[0] * b[3]) + (a[1] * b[2] - a[2] * b[1]),
        (a[3] * b[1] + a[1] * b[3]) + (a[2] * b[0] - a[0] * b[2]),
        (a[3] * b[2] + a[2] * b[3]) + (a[0] * b[1] - a[1] * b[0]),
        (a[3] * b[3] - a[0] * b[0]) - (a[1] * b[1] + a[2] * b[2]),
    ]
}

/// Columns of the rotation matrix of `q`, which is normalized first.
#[must_use]
pub fn to_columns(q: [f32; 4]) -> [[f32; 3]; 3] {
    let [x, y, z, w] = normalize(q);
    let (x2, y2, z2) = (x + x, y + y, z + z);
    let (xx, yy, zz) = (x * x2, y * y2, z * z2);
    let (xy, xz, yz) = (x * y2, x * z2, y * z2);
    let (wx, wy, wz) = (w * x2, w * y2, w * z2);
    [
        [1.0 - (yy + zz), xy + wz, xz - wy],
        [xy - wz, 1.0 - (xx + zz), yz + wx],
        [xz + wy, yz - wx, 1.0 - (xx + yy)],
    ]
}

/// Rotation of orthonormal columns, by the largest of `4w², 4x², 4y², 4z²` (Shepperd 1978).
#[must_use]
pub fn from_columns(m: &[[f32; 3]; 3]) -> [f32; 4] {
    let (a, b, c) = (m[0][0], m[1][1], m[2][2]);
    let q = if a + b + c >= 0.0 {
        [m[1][2] - m[2][1], m[2][0] - m[0][2], m[0][1] - m[1][0], 1.0 + (a + b + c)]
    } else if a >= b && a >= c {
        [1.0 + (a - b - c), m[0][1] + m[1][0], m[0][2] + m[2][0], m[1][2] - m[2][1]]
    } else if b >= c {
        [m[0][1] + m[1][0], 1.0 + (b - a - c), m[1][2] + m[2][1], m[2][0] - m[0][2]]
    } else {
        [m[0][2] + m[2][0], m[1][2] + m[2][1], 1.0 + (c - a - b), m[0][1] - m[1][0]]
    };
    normalize(q)
}

/// Normalized linear interpolation along the shorter arc, `t` in `0..=1`.
#[must_use]
pub fn nlerp(a: [f32; 4], b: [f32; 4], t: f32) -> [f32; 4] {
    let sign = if dot(a, b) < 0.0 { -t } else { t };
    normalize([0, 1, 2, 3].map(|i| (1.0 - t) * a[i] + sign * b[i]))
}

/// Spherical linear interpolation along the shorter arc, `t` in `0..=1` (glTF 2.0, appendix C.4).
#[must_use]
pub fn slerp(a: [f32; 4], b: [f32; 4], t: f32) -> [f32; 4] {
    let cosine = dot(a, b);
    let (b, cosine) = if cosine < 0.0 { (b.map(|c| -c), -cosine) } else { (b, cosine) };
    if cosine > 0.999 {
        return nlerp(a, b, t); // less than 1e-5 rad from slerp, and free of 0/0
    }
    let angle = acos(cosine);
    // Their common factor 1/sin(angle) goes with the normalization.
    let (wa, wb) = (sin((1.0 - t) * angle), sin(t * angle));
    normalize([0, 1, 2, 3].map(|i| wa * a[i] + wb * b[i]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::trig::sin_cos;

    fn axis(x: f32, y: f32, z: f32, angle: f32) -> [f32; 4] {
        let (s, c) = sin_cos(0.5 * angle);
        normalize([x * s, y * s, z * s, c])
    }

    #[test]
    fn matrix_and_back_in_every_branch() {
        for q in [axis(1.0, 0.0, 0.0, 3.1), axis(0.0, 1.0, 0.0, 3.1), axis(0.0, 0.0, 1.0, 3.1), IDENTITY] {
            let back = from_columns(&to_columns(q));
            assert!(dot(q, back).abs() > 1.0 - 1e-6, "{q:?} {back:?}");
        }
    }

    #[test]
    fn a_rotation_against_itself_is_the_identity_exactly() {
        let q = normalize([0.3, -0.2, 0.7, 0.4]);
        assert_eq!(normalize(mul(conjugate(q), q)), IDENTITY);
    }

    #[test]
    fn slerp_turns_at_constant_speed_and_takes_the_shorter_arc() {
        let (a, b) = (axis(0.0, 1.0, 0.0, 0.2), axis(0.0, 1.0, 0.0, 2.0));
        for b in [b, b.map(|c| -c)] {
            for t in [0.0, 0.25, 0.5, 1.0] {
                let want = axis(0.0, 1.0, 0.0, 0.2 + 1.8 * t);
                assert!(dot(slerp(a, b, t), want) > 1.0 - 1e-6, "t {t}");
            }
        }
    }
}
