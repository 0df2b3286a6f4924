//! The implicit surface: rounded parts on bones, joined smoothly.
//!
//! ```text
//! d(p) = smin over all parts,   smin(a, b) = min(a, b) − h²·k/4,   h = max(k − |a − b|, 0)/k
//! ```
//!
//! Right-hand parts are the left-hand ones mirrored, by evaluating with `|x|`-mirrored points.

use glam::DVec3;

/// Width of the joint between parts.
const BLEND: f64 = 0.09;

/// A bone with the parts that it holds.
#[derive(Debug)]
pub(super) struct Bone {
    pub(super) name: &'static str,
    /// Name of the bone above; empty for the first.
    pub(super) parent: &'static str,
    /// Where it turns, model space.
    pub(super) at: [f64; 3],
    parts: &'static [Part],
}

/// A rounded part.
#[derive(Debug)]
enum Part {
    /// Center and radii.
    Ellipsoid([f64; 3], [f64; 3]),
    /// Two ends with their radii.
    Cone([f64; 3], f64, [f64; 3], f64),
}
use Part::{Cone, Ellipsoid};

const fn bone(name: &'static str, parent: &'static str, at: [f64; 3], parts: &'static [Part]) -> Bone {
    Bone { name, parent, at, parts }
}

/// All bones; a name that ends in `.R` mirrors the one that ends in `.L`.
pub(super) const BONES: [Bone; 25] = [
    bone("hips", "", [0.0, 0.42, -0.02], &[Ellipsoid([0.0, 0.40, -0.01], [0.30, 0.24, 0.27])]),
    bone("spine", "hips", [0.0, 0.58, -0.03], &[Ellipsoid([0.0, 0.57, 0.05], [0.345, 0.32, 0.345])]),
    bone("chest", "spine", [0.0, 0.80, -0.03], &[Ellipsoid([0.0, 0.86, -0.01], [0.22, 0.18, 0.19])]),
    bone("neck", "chest", [0.0, 0.98, -0.01], &[Ellipsoid([0.0, 1.00, 0.0], [0.15, 0.10, 0.14])]),
    bone("head", "neck", [0.0, 1.06, 0.0], HEAD),
    bone("jaw", "head", [0.0, 1.08, 0.12], &[Ellipsoid([0.0, 1.075, 0.215], [0.10, 0.06, 0.07])]),
    bone("shoulder.L", "chest", [0.10, 0.90, -0.02], &[Ellipsoid([0.19, 0.90, -0.01], [0.10, 0.09, 0.10])]),
    bone(
        "arm.L",
        "shoulder.L",
        [0.24, 0.90, -0.01],
        &[Cone([0.24, 0.90, -0.01], 0.085, [0.39, 0.77, 0.02], 0.075)],
    ),
    bone(
        "forearm.L",
        "arm.L",
        [0.40, 0.76, 0.02],
        &[Cone([0.40, 0.76, 0.02], 0.073, [0.52, 0.66, 0.08], 0.068)],
    ),
    bone(
        "hand.L",
        "forearm.L",
        [0.53, 0.65, 0.085],
        &[Ellipsoid([0.565, 0.62, 0.105], [0.085, 0.08, 0.085])],
    ),
    bone("shoulder.R", "chest", [-0.10, 0.90, -0.02], &[Ellipsoid([-0.19, 0.90, -0.01], [0.10, 0.09, 0.10])]),
    bone(
        "arm.R",
        "shoulder.R",
        [-0.24, 0.90, -0.01],
        &[Cone([-0.24, 0.90, -0.01], 0.085, [-0.39, 0.77, 0.02], 0.075)],
    ),
    bone(
        "forearm.R",
        "arm.R",
        [-0.40, 0.76, 0.02],
        &[Cone([-0.40, 0.76, 0.02], 0.073, [-0.52, 0.66, 0.08], 0.068)],
    ),
    bone(
        "hand.R",
        "forearm.R",
        [-0.53, 0.65, 0.085],
        &[Ellipsoid([-0.565, 0.62, 0.105], [0.085, 0.08, 0.085])],
    ),
    bone("thigh.L", "hips", [0.15, 0.36, 0.0], &[Cone([0.16, 0.33, 0.0], 0.145, [0.18, 0.22, 0.02], 0.115)]),
    bone(
        "shin.L",
        "thigh.L",
        [0.18, 0.21, 0.02],
        &[Cone([0.18, 0.20, 0.02], 0.105, [0.185, 0.11, 0.01], 0.09)],
    ),
    bone("foot.L", "shin.L", [0.185, 0.09, 0.0], &[Ellipsoid([0.195, 0.075, 0.07], [0.105, 0.075, 0.165])]),
    bone("toes.L", "foot.L", [0.20, 0.06, 0.14], &[Ellipsoid([0.20, 0.065, 0.19], [0.085, 0.062, 0.075])]),
    bone(
        "thigh.R",
        "hips",
        [-0.15, 0.36, 0.0],
        &[Cone([-0.16, 0.33, 0.0], 0.145, [-0.18, 0.22, 0.02], 0.115)],
    ),
    bone(
        "shin.R",
        "thigh.R",
        [-0.18, 0.21, 0.02],
        &[Cone([-0.18, 0.20, 0.02], 0.105, [-0.185, 0.11, 0.01], 0.09)],
    ),
    bone("foot.R", "shin.R", [-0.185, 0.09, 0.0], &[Ellipsoid([-0.195, 0.075, 0.07], [0.105, 0.075, 0.165])]),
    bone("toes.R", "foot.R", [-0.20, 0.06, 0.14], &[Ellipsoid([-0.20, 0.065, 0.19], [0.085, 0.062, 0.075])]),
    bone("tail", "hips", [0.0, 0.36, -0.22], &[Cone([0.0, 0.36, -0.20], 0.15, [0.0, 0.30, -0.42], 0.12)]),
    bone("tail.mid", "tail", [0.0, 0.30, -0.42], TAIL),
    bone("brow", "head", [0.0, 1.30, 0.12], &[Ellipsoid([0.0, 1.285, 0.10], [0.16, 0.08, 0.12])]),
];

/// Skull, cheeks and ears.
const HEAD: &[Part] = &[
    Ellipsoid([0.0, 1.20, 0.02], [0.265, 0.215, 0.225]),
    Ellipsoid([0.165, 1.115, 0.10], [0.115, 0.10, 0.11]),
    Ellipsoid([-0.165, 1.115, 0.10], [0.115, 0.10, 0.11]),
    Cone([0.12, 1.36, -0.02], 0.055, [0.20, 1.60, -0.06], 0.078),
    Cone([0.20, 1.60, -0.06], 0.078, [0.28, 1.86, -0.08], 0.042),
    Cone([-0.12, 1.36, -0.02], 0.055, [-0.20, 1.60, -0.06], 0.078),
    Cone([-0.20, 1.60, -0.06], 0.078, [-0.28, 1.86, -0.08], 0.042),
];

/// The tail beyond its second joint: it has no other.
const TAIL: &[Part] = &[
    Cone([0.0, 0.30, -0.42], 0.12, [0.0, 0.36, -0.66], 0.105),
    Cone([0.0, 0.36, -0.66], 0.105, [0.0, 0.54, -0.80], 0.085),
    Cone([0.0, 0.54, -0.80], 0.085, [0.0, 0.70, -0.78], 0.05),
];

impl Part {
    /// Distance, exact for cones of equal radii, first order for ellipsoids.
    fn distance(&self, p: DVec3) -> f64 {
        match self {
            Ellipsoid(center, radii) => {
                let (q, r) = (p - DVec3::from_array(*center), DVec3::from_array(*radii));
                let (k0, k1) = ((q / r).length(), (q / (r * r)).length());
                if k1 > 1e-12 { k0 * (k0 - 1.0) / k1 } else { -r.min_element() }
            }
            Cone(a, ra, b, rb) => {
                let (a, b) = (DVec3::from_array(*a), DVec3::from_array(*b));
                let edge = b - a;
                let t = ((p - a).dot(edge) / edge.length_squared()).clamp(0.0, 1.0);
                (p - (a + edge * t)).length() - (ra + (rb - ra) * t)
            }
        }
    }
}

fn smooth_min(a: f64, b: f64, k: f64) -> f64 {
    let h = (k - (a - b).abs()).max(0.0) / k;
    a.min(b) - h * h * k * 0.25
}

impl Bone {
    /// Distance of a point from the bone's parts.
    pub(super) fn distance(&self, p: DVec3) -> f64 {
        self.parts.iter().map(|part| part.distance(p)).fold(f64::INFINITY, f64::min)
    }
}

/// Distance from the surface of the whole body.
pub(super) fn distance(p: DVec3) -> f64 {
    let parts = BONES.iter().flat_map(|b| b.parts);
    parts.fold(1e3, |d, part| smooth_min(d, part.distance(p), BLEND))
}

/// Gradient of [`distance`] by central differences.
pub(super) fn gradient(p: DVec3) -> DVec3 {
    let h = 1e-4;
    let slope = |axis: DVec3| (distance(p + axis * h) - distance(p - axis * h)) / (2.0 * h);
    DVec3::new(slope(DVec3::X), slope(DVec3::Y), slope(DVec3::Z))
}
