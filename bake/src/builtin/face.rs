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

impl Feature {
    /// Puts a feature of the left onto a side.
    fn onto(&mut self, side: Side) {
        for v in self.positions.iter_mut().chain(&mut self.normals) {
            v.x *= side.sign();
        }
        if side == Side::Right {
            for t in &mut self.triangles {
                t.swap(1, 2);
            }
        }
    }
}

/// Eyes: half axes to the side, upwards and outwards.
const EYE: DVec3 = dvec3(0.072, 0.096, 0.040);
/// How far an eye is sunk into the head.
const EYE_SUNK: f64 = 0.008;
/// Nose: half axes.
const NOSE: DVec3 = dvec3(0.042, 0.028, 0.026);
/// The line of a closed eye: half of its width, its height, its radius.
const LID: DVec3 = dvec3(0.050, 0.022, 0.007);
/// Radius of the line of the mouth.
const MOUTH: f64 = 0.009;

/// All features, left before right.
pub(super) fn features(shape: &Shape) -> Vec<Feature> {
    let mut out: Vec<Feature> = Side::BOTH.into_iter().map(|side| eye(shape, side)).collect();
    out.extend(Side::BOTH.map(|side| lid(shape, side)));
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
    for (k, q) in feature.positions.iter().enumerate() {
        let d = *q - p;
        let right = DVec3::Y.cross(out).normalize();
        let up = out.cross(right);
        let (x, y) = (d.dot(right) / EYE.x * side.sign(), d.dot(up) / EYE.y);
        feature.uvs[k] = eye_uv(x.clamp(-1.0, 1.0), y.clamp(-1.0, 1.0));
    }
    feature.onto(side);
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

/// A line along a smile on the surface.
fn mouth(shape: &Shape) -> Feature {
    const HALF: usize = 10;
    let point = |k: usize| {
        let t = real(k) / real(HALF);
        // Two arcs that meet under the nose.
        let y = 0.902 - 0.028 * libm::sin(core::f64::consts::PI * t) + 0.020 * t * t;
        let (p, normal) = shape.hit(dvec3(0.105 * t, y, 0.6), DVec3::NEG_Z);
        let normal = if k == 0 { normal.with_x(0.0).normalize() } else { normal };
        Bead { center: p, normal, radius: MOUTH * (1.0 - 0.55 * t * t * t * t) }
    };
    let left: Vec<Bead> = (0..=HALF).map(point).collect();
    let right = left[1..].iter().rev().map(Bead::mirrored);
    let mut feature = cord(&right.chain(left.iter().copied()).collect::<Vec<_>>());
    feature.joint = index(Bone::Head, Side::Left);
    feature
}

/// The line of a closed eye: within the open eye, so that it shows when the eye has sunk.
fn lid(shape: &Shape, side: Side) -> Feature {
    const HALF: u32 = 7;
    let joint = position(Bone::Eye, Side::Left);
    let point = |k: u32| {
        let s = (f64::from(k) - f64::from(HALF)) / f64::from(HALF);
        let from = dvec3(joint.x + LID.x * s, joint.y + LID.y * (0.6 - s * s), 0.6);
        let (p, normal) = shape.hit(from, DVec3::NEG_Z);
        Bead { center: p, normal, radius: LID.z * (1.0 - 0.5 * s * s * s * s) }
    };
    let mut feature = cord(&(0..=2 * HALF).map(point).collect::<Vec<_>>());
    feature.onto(side);
    feature.joint = index(Bone::Head, Side::Left);
    feature
}

/// A point of a cord's middle line.
#[derive(Clone, Copy, Debug)]
struct Bead {
    center: DVec3,
    /// Unit normal of the surface below.
    normal: DVec3,
    radius: f64,
}

impl Bead {
    fn mirrored(&self) -> Self {
        let flip = |v: DVec3| v.with_x(-v.x);
        Self { center: flip(self.center), normal: flip(self.normal), radius: self.radius }
    }
}

/// A round cord along beads on the surface, closed at both ends; mirrored beads give its mirror image.
fn cord(beads: &[Bead]) -> Feature {
    const SIDES: usize = 6;
    let mut out = Feature::default();
    let last = beads.len() - 1;
    let ahead = |k: usize| (beads[(k + 1).min(last)].center - beads[k.saturating_sub(1)].center).normalize();
    for (k, bead) in beads.iter().enumerate() {
        let across = bead.normal.cross(ahead(k)).normalize();
        for side in 0..SIDES {
            let (sine, cosine) = libm::sincos(core::f64::consts::TAU * real(side) / real(SIDES));
            let n = bead.normal * cosine + across * sine;
            out.positions.push(bead.center + n * bead.radius);
            out.normals.push(n);
        }
    }
    for (k, sign) in [(0, -1.0), (last, 1.0)] {
        out.positions.push(beads[k].center + ahead(k) * (sign * beads[k].radius));
        out.normals.push(ahead(k) * sign);
    }
    let tip = beads.len() * SIDES;
    for side in 0..SIDES {
        let next = (side + 1) % SIDES;
        for k in 0..last {
            let (a, b) = (k * SIDES + side, k * SIDES + next);
            out.triangles.extend([[a, b + SIDES, b], [a, a + SIDES, b + SIDES]]);
        }
        out.triangles.extend([[tip, side, next], [tip + 1, last * SIDES + next, last * SIDES + side]]);
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
