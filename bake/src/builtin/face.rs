//! Eyes and nose: small balls that follow the head.

use super::node_of;
use crate::model::Primitive;
use core::f64::consts::{PI, TAU};
use glam::DVec3;

/// A ball of `radii` at `center`, all on one joint, added to `p`.
fn ball(p: &mut Primitive, joint: usize, center: DVec3, radii: DVec3, rings: u32) {
    let first = u32::try_from(p.positions.len()).unwrap_or(0);
    let around = 2 * rings;
    for i in 0..=rings {
        for k in 0..around {
            let (theta, phi) = (PI * f64::from(i) / f64::from(rings), TAU * f64::from(k) / f64::from(around));
            let sine = if i == rings { 0.0 } else { libm::sin(theta) };
            let n = DVec3::new(sine * libm::cos(phi), libm::cos(theta), sine * libm::sin(phi));
            p.positions.push((center + n * radii).to_array().map(crate::pack::narrow));
            p.normals.push((n / radii).normalize().to_array().map(crate::pack::narrow));
            p.joints.extend([u16::try_from(joint).unwrap_or(0), 0, 0, 0]);
            p.weights.extend([1.0, 0.0, 0.0, 0.0]);
        }
    }
    for i in 0..rings {
        for k in 0..around {
            let at = |i: u32, k: u32| first + i * around + k % around;
            let [a, b, c, d] = [at(i, k), at(i, k + 1), at(i + 1, k), at(i + 1, k + 1)];
            if i > 0 {
                p.indices.push([a, b, c]);
            }
            if i + 1 < rings {
                p.indices.push([b, d, c]);
            }
        }
    }
}

fn primitive(number: usize) -> Primitive {
    Primitive { primitive: number, stride: 4, material: Some(number), ..Primitive::default() }
}

/// Both eyes.
pub(super) fn eyes() -> Primitive {
    let mut p = primitive(1);
    for side in [1.0, -1.0] {
        ball(
            &mut p,
            node_of("head"),
            DVec3::new(0.105 * side, 1.215, 0.205),
            DVec3::new(0.042, 0.056, 0.036),
            10,
        );
    }
    p
}

/// The light in the eyes.
pub(super) fn sparkles() -> Primitive {
    let mut p = primitive(2);
    for side in [1.0, -1.0] {
        ball(
            &mut p,
            node_of("head"),
            DVec3::new(0.105 * side + 0.014, 1.238, 0.236),
            DVec3::splat(0.0115),
            6,
        );
    }
    p
}

/// The nose.
pub(super) fn nose() -> Primitive {
    let mut p = primitive(3);
    ball(&mut p, node_of("jaw"), DVec3::new(0.0, 1.115, 0.283), DVec3::new(0.032, 0.022, 0.018), 8);
    p
}
