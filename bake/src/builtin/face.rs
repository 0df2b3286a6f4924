//! Small parts set onto the body: eyes, nose, mouth, each moved by one joint.

use super::shape::Shape;
use super::skeleton::{Bone, Side, index, position};
use super::texture::{Paint, eye_uv, wheel_uv};
use glam::{DVec2, DVec3, dvec3};

/// A closed mesh that one joint moves.
#[derive(Debug, Default)]
pub(super) struct Feature {
    pub(super) positions: Vec<DVec3>,
    pub(super) normals: Vec<DVec3>,
    pub(super) uvs: Vec<[f64; 2]>,
    pub(super) triangles: Vec<[usize; 3]>,
    pub(super) joint: usize,
}

/// Eyes: half axes to the side, upwards and outwards.
const EYE: DVec3 = dvec3(0.072, 0.096, 0.040);
/// How far an eye is sunk into the head.
const EYE_SUNK: f64 = 0.008;
/// Nose: half axes.
const NOSE: DVec3 = dvec3(0.042, 0.028, 0.026);
/// Radius of the line of the mouth.
const MOUTH: f64 = 0.009;

/// All features, left before right.
pub(super) fn features(shape: &Shape) -> Vec<Feature> {
    let mut out: Vec<Feature> = Side::BOTH.into_iter().map(|side| eye(shape, side)).collect();
    out.push(nose(shape));
    out.push(mouth(shape));
    out
}

/// An eye over its joint. Mirrored as a surface; the picture is not, so that light falls from one side.
fn eye(shape: &Shape, side: Side) -> Feature {
    let joint = position(Bone::Eye, Side::Left);
    let (p, normal) = shape.hit(dvec3(joint.x, joint.y, 0.6), DVec3::NEG_Z);
    // Half way between the surface's normal and the direction of the face: a friendly, frontal look.
    let out = (normal + dvec3(0.0, 0.0, 0.55)).normalize();
    let mut feature = ellipsoid(p - normal * EYE_SUNK, EYE, out);
    let across = |q: DVec3| q.x * side.sign();
    for (k, q) in feature.positions.iter().enumerate() {
        let d = *q - p;
        let right = DVec3::Y.cross(out).normalize();
        let up = out.cross(right);
        let (x, y) = (d.dot(right) / EYE.x * side.sign(), d.dot(up) / EYE.y);
        feature.uvs[k] = eye_uv(x.clamp(-1.0, 1.0), y.clamp(-1.0, 1.0));
    }
    for v in feature.positions.iter_mut().chain(&mut feature.normals) {
        v.x = across(*v);
    }
    if side == Side::Right {
        for t in &mut feature.triangles {
            t.swap(1, 2);
        }
    }
    feature.joint = index(Bone::Eye, side);
    feature
}

fn nose(shape: &Shape) -> Feature {
    let (p, normal) = shape.hit(dvec3(0.0, 0.962, 0.6), DVec3::NEG_Z);
    let mut feature = ellipsoid(p, NOSE, (normal + DVec3::Z).with_x(0.0).normalize());
    feature.uvs = vec![wheel_uv(Paint::Ink, 1.0); feature.positions.len()];
    feature.joint = index(Bone::Head, Side::Left);
    feature
}

/// A tube along a smile on the surface.
fn mouth(shape: &Shape) -> Feature {
    const SEGMENTS: u32 = 20;
    const SIDES: u32 = 6;
    let line = |s: f64| {
        // Two arcs that meet under the nose.
        let t = s.abs();
        let x = 0.105 * s;
        let y = 0.902 - 0.028 * libm::sin(core::f64::consts::PI * t) + 0.020 * t * t;
        shape.hit(dvec3(x, y, 0.6), DVec3::NEG_Z)
    };
    let mut out = Feature { joint: index(Bone::Head, Side::Left), ..Feature::default() };
    for ring in 0..=SEGMENTS {
        // Exactly odd about the middle.
        let s = (f64::from(ring) - f64::from(SEGMENTS / 2)) / f64::from(SEGMENTS / 2);
        let ((center, normal), ahead) = (line(s), line(s + 0.02).0 - line(s - 0.02).0);
        let across = normal.cross(ahead).normalize();
        let radius = MOUTH * (1.0 - 0.55 * s * s * s * s);
        for k in 0..SIDES {
            let (sine, cosine) = libm::sincos(core::f64::consts::TAU * f64::from(k) / f64::from(SIDES));
            let n = normal * cosine + across * sine;
            out.positions.push(center + n * radius);
            out.normals.push(n);
        }
    }
    let sides = SIDES as usize;
    for ring in 0..SEGMENTS as usize {
        for k in 0..sides {
            let (a, b) = (ring * sides + k, ring * sides + (k + 1) % sides);
            out.triangles.extend([[a, b, b + sides], [a, b + sides, a + sides]]);
        }
    }
    out.uvs = vec![wheel_uv(Paint::Ink, 1.0); out.positions.len()];
    out
}

/// An ellipsoid around `center` whose third half axis points along `out`: rings about that axis.
fn ellipsoid(center: DVec3, axes: DVec3, out: DVec3) -> Feature {
    const RINGS: usize = 9;
    const SIDES: u32 = 20;
    let right = DVec3::Y.cross(out).normalize();
    let up = out.cross(right);
    let mut feature = Feature::default();
    let mut push = |q: DVec3| {
        let turn = |v: DVec3| right * v.x + up * v.y + out * v.z;
        feature.positions.push(center + turn(q * axes));
        feature.normals.push(turn(q / axes).normalize());
    };
    push(DVec3::Z);
    for ring in 1..=RINGS {
        let polar = core::f64::consts::PI * real(ring) / real(RINGS + 1);
        let (sine, cosine) = libm::sincos(polar);
        for k in 0..SIDES {
            let d = circle(k, SIDES) * sine;
            push(dvec3(d.x, d.y, cosine));
        }
    }
    push(DVec3::NEG_Z);
    let sides = SIDES as usize;
    let last = 1 + RINGS * sides;
    for k in 0..sides {
        let next = (k + 1) % sides;
        feature.triangles.push([0, 1 + k, 1 + next]);
        for ring in 0..RINGS - 1 {
            let (a, b) = (1 + ring * sides + k, 1 + ring * sides + next);
            feature.triangles.extend([[a, a + sides, b + sides], [a, b + sides, b]]);
        }
        feature.triangles.push([last, last - sides + next, last - sides + k]);
    }
    feature.uvs = vec![[0.0; 2]; feature.positions.len()];
    feature
}

/// Point `k` of `n` on the unit circle, starting halfway, so that the set is exactly mirror-symmetric.
fn circle(k: u32, n: u32) -> DVec2 {
    let quarter = n / 4;
    let angle = |k: u32| libm::sincos(core::f64::consts::TAU * (f64::from(k) + 0.5) / f64::from(n));
    let ((sine, cosine), turn) = (angle(k % quarter), k / quarter);
    let mirrored = angle(quarter - 1 - k % quarter);
    match turn {
        0 => DVec2::new(cosine, sine),
        1 => DVec2::new(-mirrored.1, mirrored.0),
        2 => DVec2::new(-cosine, -sine),
        _ => DVec2::new(mirrored.1, -mirrored.0),
    }
}

fn real(n: usize) -> f64 {
    f64::from(u32::try_from(n).unwrap_or(u32::MAX))
}
