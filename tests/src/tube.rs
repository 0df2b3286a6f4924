//! A soft tube on three joints: small, symmetric, with a clip; every number follows from its arguments.

use glam::{DMat4, DQuat, DVec3};
use sinew_bake::Model;
use sinew_bake::model::{Channel, Clip, Interpolation, Joint, Node, Primitive, Property};
use sinew_bake::recipe::{Flesh, Region};

/// Vertices around the tube.
const AROUND: usize = 12;
/// Rings along the tube.
const RINGS: usize = 25;
/// Height of the tube for scale 1.
const HEIGHT: f64 = 2.0;

#[allow(clippy::cast_possible_truncation, reason = "rounding is meant")]
fn narrow(x: f64) -> f32 {
    x as f32
}

#[allow(clippy::cast_precision_loss, reason = "small numbers")]
fn real(i: usize) -> f64 {
    i as f64
}

/// The tube, `scale` times as large; joints at 0, 1/3 and 2/3 of the height.
#[must_use]
pub fn model(scale: f64) -> Model {
    let (nodes, joints) = skeleton(scale);
    Model {
        name: "tube".into(),
        nodes,
        joints,
        primitives: vec![surface(scale)],
        clips: vec![swing()],
        ..Model::default()
    }
}

fn skeleton(scale: f64) -> (Vec<Node>, Vec<Joint>) {
    let third = HEIGHT * scale / 3.0;
    let node = |i: usize| Node {
        name: format!("joint{i}"),
        parent: i.checked_sub(1),
        translation: if i == 0 { DVec3::ZERO } else { DVec3::Y * third },
        rotation: DQuat::IDENTITY,
        scale: DVec3::ONE,
    };
    let joint = |i: usize| Joint {
        node: i,
        joint_from_bind: DMat4::from_translation(DVec3::NEG_Y * third * real(i)),
    };
    ((0..3).map(node).collect(), (0..3).map(joint).collect())
}

fn surface(scale: f64) -> Primitive {
    let mut p = Primitive { stride: 4, ..Primitive::default() };
    for ring in 0..RINGS {
        let t = real(ring) / real(RINGS - 1);
        let bone = 3.0 * t - 0.5;
        let low = bone.clamp(0.0, 1.999).floor();
        let upper = (bone.clamp(0.0, 2.0) - low).clamp(0.0, 1.0);
        for k in 0..AROUND {
            let angle = core::f64::consts::TAU * real(k) / real(AROUND);
            let (x, z) = (libm::cos(angle), libm::sin(angle));
            let radius = 0.2 * scale;
            p.positions.push([radius * x, HEIGHT * scale * t, radius * z].map(narrow));
            p.normals.push([x, 0.0, z].map(narrow));
            #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0, 1 or 2")]
            let low = low as u16;
            let mut row = [(low, 1.0 - upper), ((low + 1).min(2), upper)];
            row.sort_by(|a, b| b.1.total_cmp(&a.1));
            p.joints.extend([row[0].0, row[1].0, 0, 0]);
            p.weights.extend([narrow(row[0].1), narrow(row[1].1), 0.0, 0.0]);
        }
    }
    let index = |ring: usize, k: usize| u32::try_from(ring * AROUND + k % AROUND).expect("small");
    for ring in 0..RINGS - 1 {
        for k in 0..AROUND {
            let [a, b] = [index(ring, k), index(ring, k + 1)];
            let [c, d] = [index(ring + 1, k), index(ring + 1, k + 1)];
            p.indices.extend([[a, c, b], [b, c, d]]);
        }
    }
    p
}

/// One second: the middle joint swings about z, the upper one about x.
fn swing() -> Clip {
    let turn = |axis: usize, angle: f64| {
        let mut q = [0.0, 0.0, 0.0, narrow(libm::cos(0.5 * angle))];
        q[axis] = narrow(libm::sin(0.5 * angle));
        q
    };
    let keys = [0.0, 0.6, 0.0, -0.6, 0.0];
    let channel = |node: usize, axis: usize| Channel {
        node,
        property: Property::Rotation,
        interpolation: Interpolation::Linear,
        times: (0..5).map(|i| narrow(0.25 * real(i))).collect(),
        values: keys.iter().flat_map(|a| turn(axis, *a)).collect(),
    };
    Clip { name: "swing".into(), duration: 1.0, channels: vec![channel(1, 2), channel(2, 0)] }
}

/// Softness rising along the tube, in two regions.
#[must_use]
pub fn flesh(scale: f64) -> Flesh {
    let height = |v: usize| real(v / AROUND) / real(RINGS - 1);
    let region = |name: &str, frequency| Region {
        name: name.into(),
        frequency,
        damping: 0.25,
        gain: 1.0,
        max_offset: 0.2,
    };
    Flesh {
        softness: (0..AROUND * RINGS).map(|v| narrow((height(v) - 0.25).max(0.0))).collect(),
        region: (0..AROUND * RINGS).map(|v| u8::from(height(v) > 0.6)).collect(),
        regions: vec![region("lower", 3.0), region("upper", 2.0)],
        body_size: scale * libm::sqrt(HEIGHT * HEIGHT + 2.0 * 0.4 * 0.4),
        mirror: None,
        notes: Vec::new(),
    }
}

/// The asset of the tube.
///
/// # Panics
///
/// If the writer refuses it.
#[must_use]
pub fn asset(scale: f64) -> Vec<u32> {
    let bytes = sinew_bake::pack::pack(&model(scale), &flesh(scale), 0).expect("the tube fits the format");
    sinew_bake::pack::align(&bytes)
}
