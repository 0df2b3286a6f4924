//! Motion: idle, walk, jump and shake, as curves sampled into keys.

use super::{node_of, position};
use crate::model::{Channel, Clip, Interpolation, Property};
use core::f64::consts::TAU;
use glam::{DQuat, DVec3};

/// Keys a second.
const RATE: f64 = 24.0;

/// Angles about x, y, z of a joint, radians.
type Turn = (&'static str, [f64; 3]);
/// A pose: offset of the hips and turns.
type Pose = (DVec3, Vec<Turn>);

/// All clips; the first is the default.
pub(super) fn all() -> Vec<Clip> {
    vec![
        clip("walk", 1.0, walk),
        clip("jump", 1.75, jump),
        clip("shake", 2.0, shake),
        clip("idle", 4.0, idle),
    ]
}

fn wave(turns: f64) -> f64 {
    libm::sin(TAU * turns)
}

/// 0 before `low`, 1 after `high`, smooth between.
fn ramp(low: f64, high: f64, x: f64) -> f64 {
    let t = ((x - low) / (high - low)).clamp(0.0, 1.0);
    t * t * t * (t * (6.0 * t - 15.0) + 10.0)
}

/// Both sides; the right one mirrors in y and z.
fn pair(left: &'static str, right: &'static str, [x, y, z]: [f64; 3]) -> [Turn; 2] {
    [(left, [x, y, z]), (right, [x, -y, -z])]
}

/// Bends both legs by `bend` radians at the hip, feet flat; how much lower the hips come.
fn crouch(bend: f64, turns: &mut Vec<Turn>) -> f64 {
    turns.extend(pair("thigh.L", "thigh.R", [-bend, 0.0, 0.0]));
    turns.extend(pair("shin.L", "shin.R", [2.0 * bend, 0.0, 0.0]));
    turns.extend(pair("foot.L", "foot.R", [-bend, 0.0, 0.0]));
    0.27 * (1.0 - libm::cos(bend))
}

fn idle(t: f64) -> Pose {
    let u = t / 4.0;
    let breath = wave(2.0 * u);
    let mut turns = vec![
        ("spine", [0.02 * breath, 0.03 * wave(u), 0.02 * wave(u + 0.1)]),
        ("chest", [-0.03 * breath, 0.0, 0.0]),
        ("head", [0.03 * wave(2.0 * u + 0.2), 0.18 * wave(u), 0.05 * wave(u + 0.3)]),
        ("tail", [0.0, 0.30 * wave(2.0 * u), 0.0]),
        ("tail.mid", [0.0, 0.25 * wave(2.0 * u - 0.12), 0.0]),
    ];
    turns.extend(pair("arm.L", "arm.R", [0.0, 0.0, -0.10 - 0.04 * breath]));
    let low = crouch(0.12 + 0.06 * breath, &mut turns);
    (DVec3::new(0.015 * wave(u), -low, 0.0), turns)
}

fn walk(t: f64) -> Pose {
    let mut turns = Vec::new();
    for (side, phase) in [(0, 0.0), (1, 0.5)] {
        let names = [
            ["thigh.L", "shin.L", "foot.L", "arm.L", "forearm.L"],
            ["thigh.R", "shin.R", "foot.R", "arm.R", "forearm.R"],
        ][side];
        let mirror = if side == 0 { 1.0 } else { -1.0 };
        let swing = wave(t + phase);
        let lift = wave(t + phase + 0.25).max(0.0);
        turns.push((names[0], [-0.55 * swing - 0.35 * lift, 0.0, 0.0]));
        turns.push((names[1], [0.25 + 0.85 * lift, 0.0, 0.0]));
        turns.push((names[2], [0.30 * swing - 0.25 * lift, 0.0, 0.0]));
        turns.push((names[3], [0.60 * swing, 0.0, -0.35 * mirror]));
        turns.push((names[4], [-0.25 + 0.2 * swing, 0.0, 0.0]));
    }
    let bob = wave(2.0 * t + 0.25);
    turns.extend([
        ("hips", [0.05, 0.14 * wave(t), 0.07 * wave(t + 0.25)]),
        ("spine", [0.03 * bob, -0.12 * wave(t), -0.06 * wave(t + 0.25)]),
        ("chest", [0.0, -0.16 * wave(t), -0.03 * wave(t + 0.25)]),
        ("head", [-0.03 - 0.05 * bob, 0.12 * wave(t), 0.05 * wave(t + 0.3)]),
        ("tail", [0.10, 0.40 * wave(t + 0.1), 0.0]),
        ("tail.mid", [0.0, 0.35 * wave(t - 0.05), 0.0]),
    ]);
    (DVec3::new(0.03 * wave(t + 0.25), 0.045 * bob - 0.02, 0.0), turns)
}

fn jump(t: f64) -> Pose {
    let down = ramp(0.0, 0.35, t) * (1.0 - ramp(0.40, 0.55, t));
    let land = ramp(1.02, 1.14, t) * (1.0 - ramp(1.22, 1.70, t));
    let air = ramp(0.46, 0.56, t) * (1.0 - ramp(1.00, 1.10, t));
    let flight = ((t - 0.50) / 0.56).clamp(0.0, 1.0);
    let height = 0.62 * 4.0 * flight * (1.0 - flight);
    let bend = 0.12 + 0.85 * down + 0.75 * land + 0.35 * air * wave(0.5 * flight);
    let mut turns = Vec::new();
    let low = crouch(bend, &mut turns);
    let lean = 0.40 * down + 0.28 * land - 0.15 * air;
    turns.extend([
        ("hips", [0.25 * lean, 0.0, 0.0]),
        ("spine", [0.5 * lean, 0.0, 0.0]),
        ("chest", [0.4 * lean, 0.0, 0.0]),
        ("head", [-0.8 * lean, 0.0, 0.0]),
        ("tail", [-0.35 * air + 0.3 * down, 0.0, 0.0]),
    ]);
    let raise = -0.15 - 0.5 * down + 1.0 * air - 0.2 * land;
    turns.extend(pair("arm.L", "arm.R", [0.6 * down - 0.3 * air, 0.0, raise]));
    turns.extend(pair("forearm.L", "forearm.R", [-0.3 - 0.3 * land, 0.0, 0.0]));
    (DVec3::new(0.0, height - low, 0.0), turns)
}

fn shake(t: f64) -> Pose {
    let strength = ramp(0.1, 0.5, t) * (1.0 - ramp(1.45, 1.95, t));
    let fast = strength * wave(3.0 * t);
    let slow = strength * wave(1.0 * t);
    let late = strength * wave(3.0 * t - 0.10);
    let mut turns = vec![
        ("hips", [0.0, 0.30 * fast, 0.05 * slow]),
        ("spine", [0.08 * strength, 0.30 * fast, 0.0]),
        ("chest", [0.05 * strength, 0.25 * fast, 0.0]),
        ("neck", [0.0, -0.15 * fast, 0.10 * late]),
        ("head", [0.12 * strength, -0.35 * late, 0.22 * late]),
        ("tail", [0.0, -0.5 * late, 0.0]),
        ("tail.mid", [0.0, -0.5 * late, 0.0]),
    ];
    turns.extend(pair("arm.L", "arm.R", [-0.2 * strength, 0.0, 0.30 * strength - 0.10]));
    turns.push(("forearm.L", [-0.5 * strength, 0.0, 0.3 * fast]));
    turns.push(("forearm.R", [-0.5 * strength, 0.0, 0.3 * fast]));
    let low = crouch(0.12 + 0.25 * strength, &mut turns);
    (DVec3::new(0.03 * slow, -low + 0.012 * strength * wave(6.0 * t), 0.0), turns)
}

/// Samples a motion into a clip.
fn clip(name: &str, duration: f64, motion: fn(f64) -> Pose) -> Clip {
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "at most a hundred")]
    let keys = (duration * RATE).round() as u32;
    let time = |k: u32| duration * f64::from(k) / f64::from(keys);
    let poses: Vec<Pose> = (0..=keys).map(|k| motion(time(k % keys))).collect();
    let times: Vec<f32> = (0..=keys).map(|k| crate::pack::narrow(time(k))).collect();
    let hips = node_of("hips");
    let place = |p: &Pose| (position(hips) + p.0).to_array().map(crate::pack::narrow);
    let mut channels =
        vec![channel(hips, Property::Translation, &times, poses.iter().flat_map(place).collect())];
    for (name, _) in &poses[0].1 {
        let turn = |p: &Pose| {
            let of_joint = p.1.iter().filter(|(n, _)| n == name);
            let q = of_joint.fold(DQuat::IDENTITY, |q, (_, a)| q * euler(*a));
            q.normalize().to_array().map(crate::pack::narrow)
        };
        let values = poses.iter().flat_map(turn).collect();
        let node = node_of(name);
        if !channels.iter().any(|c: &Channel| c.node == node && c.property == Property::Rotation) {
            channels.push(channel(node, Property::Rotation, &times, values));
        }
    }
    Clip { name: name.into(), duration: crate::pack::narrow(duration), channels }
}

fn channel(node: usize, property: Property, times: &[f32], values: Vec<f32>) -> Channel {
    Channel { node, property, interpolation: Interpolation::Linear, times: times.to_vec(), values }
}

/// Rotation by angles about x, then y, then z, by `libm`.
fn euler([x, y, z]: [f64; 3]) -> DQuat {
    let about = |axis: DVec3, angle: f64| {
        let v = axis * libm::sin(0.5 * angle);
        DQuat::from_xyzw(v.x, v.y, v.z, libm::cos(0.5 * angle))
    };
    about(DVec3::Z, z) * about(DVec3::Y, y) * about(DVec3::X, x)
}
