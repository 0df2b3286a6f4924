//! The four motions. Times are in seconds, angles in radians; `t` runs from 0 to the clip's length.

use super::curve::{bump, cowave, hermite, ramp, through, wave};
use super::pose::{Pose, Step};
use crate::builtin::skeleton::{Bone, Side};
use glam::{DVec3, dvec3};

/// How far relaxed arms hang below the rest pose.
const RELAXED: f64 = -0.16;

/// Breathing, looking about, blinking; 4 s.
pub(super) fn idle(t: f64) -> Pose {
    let mut pose = Pose::rest();
    let breath = wave(t / 2.0);
    let sway = wave(t / 4.0);
    let look =
        through(&[(0.0, 0.0), (0.7, 0.34), (1.5, 0.36), (2.2, -0.10), (2.8, -0.26), (3.5, -0.18)], 4.0, t);
    let tilt =
        through(&[(0.0, 0.0), (0.9, 0.10), (1.5, 0.12), (2.4, -0.05), (3.0, -0.13), (3.6, -0.06)], 4.0, t);
    pose.hips = dvec3(0.016 * sway, -0.010 + 0.005 * breath, 0.0);
    pose.stretch = 1.0 + 0.018 * breath;
    pose.open = 1.0 - 0.92 * (bump(0.55, 0.11, t) + bump(2.0, 0.11, t) + bump(2.3, 0.11, t));
    pose.turn(Bone::Hips, [0.0, 0.03 * sway, -0.025 * sway]);
    pose.turn(Bone::Spine, [0.01 * breath, 0.05 * look, 0.02 * sway]);
    pose.turn(Bone::Chest, [-0.03 * breath, 0.12 * look, 0.02 * sway]);
    pose.turn(Bone::Neck, [0.0, 0.25 * look, 0.0]);
    pose.turn(Bone::Head, [0.02 - 0.03 * wave(t / 2.0 - 0.12), 0.75 * look, tilt]);
    pose.turn(Bone::Tail1, [0.04 * breath, 0.22 * wave(t / 2.0), 0.0]);
    pose.turn(Bone::Tail2, [0.03 * breath, 0.26 * wave(t / 2.0 - 0.13), 0.0]);
    pose.turn_both(Bone::UpperArm, [0.0, -0.05, RELAXED + 0.05 * breath]);
    pose.turn_both(Bone::Forearm, [-0.10, -0.15, -0.05 * breath]);
    pose
}

/// A waddle on the spot; 1 s, two steps.
pub(super) fn walk(t: f64) -> Pose {
    let mut pose = Pose::rest();
    for (foot, phase) in pose.feet.iter_mut().zip([t, t + 0.5]) {
        *foot = stride(phase - libm::floor(phase));
    }
    // Left foot: down at 0, below the body at 0.3, off at 0.6; the body leans over the foot that stands.
    let (reach, lean) = (cowave(t), cowave(t - 0.3));
    let bob = cowave(2.0 * (t - 0.30));
    pose.hips = dvec3(0.034 * lean, -0.022 + 0.026 * bob, 0.0);
    pose.stretch = 1.0 + 0.028 * cowave(2.0 * (t - 0.34));
    pose.turn(Bone::Hips, [0.04, -0.15 * reach, -0.085 * lean]);
    pose.turn(Bone::Spine, [0.03 - 0.03 * bob, 0.10 * reach, 0.035 * lean]);
    pose.turn(Bone::Chest, [0.0, 0.20 * reach, 0.050 * lean]);
    pose.turn(Bone::Neck, [-0.02, -0.06 * reach, 0.02 * lean]);
    pose.turn(
        Bone::Head,
        [-0.05 + 0.055 * cowave(2.0 * (t - 0.40)), -0.10 * reach, 0.055 * cowave(t - 0.42)],
    );
    pose.turn(Bone::Tail1, [0.06 * cowave(2.0 * (t - 0.4)), 0.30 * cowave(t - 0.15), 0.0]);
    pose.turn(Bone::Tail2, [0.06 * cowave(2.0 * (t - 0.5)), 0.30 * cowave(t - 0.28), 0.0]);
    for side in Side::BOTH {
        let forwards = -side.sign() * cowave(t - 0.03);
        let later = -side.sign() * cowave(t - 0.12);
        pose.turn_side(Bone::Shoulder, side, [0.0, -0.10 * forwards, 0.0]);
        pose.turn_side(Bone::UpperArm, side, [-0.50 * forwards, -0.06 * forwards, RELAXED - 0.04]);
        pose.turn_side(Bone::Forearm, side, [-0.22 - 0.22 * later, -0.16 - 0.08 * later, 0.0]);
        pose.turn_side(Bone::Hand, side, [-0.12 * later, 0.0, -0.10]);
    }
    pose
}

/// A foot of the walk: on the ground until 0.6 of its period, moving backwards evenly.
fn stride(phase: f64) -> Step {
    const REACH: f64 = 0.105;
    const OFF: f64 = 0.6;
    let speed = -2.0 * REACH / OFF;
    let z = if phase < OFF {
        REACH + speed * phase
    } else {
        hermite(((OFF, -REACH), speed), ((1.0, REACH), speed), phase)
    };
    let keys =
        [(0.0, -0.22), (0.10, 0.0), (0.25, 0.0), (0.42, 0.04), (0.60, 0.42), (0.74, 0.30), (0.90, -0.26)];
    let pitch = through(&keys, 1.0, phase);
    // The ball of the foot stays down while the heel rises, the heel while the toes do.
    let planted = if pitch > 0.0 { 0.150 * libm::sin(pitch) } else { -0.055 * libm::sin(pitch) };
    let lift = 0.055 * ramp(0.60, 0.76, phase) * (1.0 - ramp(0.80, 1.0, phase));
    let toes = 0.9 * pitch.max(0.0) * (1.0 - ramp(0.60, 0.72, phase));
    Step { offset: dvec3(0.0, planted + lift, z), pitch, toes }
}

/// Length of the leap, s.
pub(super) const LEAP: f64 = 1.75;

/// When the feet leave the ground and when they are back, s.
const UP: f64 = 0.46;
const DOWN: f64 = 0.96;
/// How long the back is during the leap.
const STRETCH: [(f64, f64); 8] = [
    (0.0, 1.0),
    (0.28, 0.90),
    (0.44, 1.10),
    (0.70, 1.0),
    (0.93, 1.06),
    (1.08, 0.86),
    (1.27, 1.04),
    (1.40, 1.0),
];
/// Turn of the head.
const NOD: [(f64, f64); 8] = [
    (0.0, 0.0),
    (0.30, -0.16),
    (0.46, -0.26),
    (0.70, 0.06),
    (0.94, 0.14),
    (1.12, 0.02),
    (1.3, -0.07),
    (1.5, 0.0),
];
/// Turn of the tail.
const WAG: [(f64, f64); 7] =
    [(0.0, 0.0), (0.30, 0.24), (0.52, -0.40), (0.75, 0.05), (1.0, 0.38), (1.2, -0.16), (1.45, 0.03)];
/// How far the arms are raised.
const RAISE: [(f64, f64); 9] = [
    (0.0, 0.0),
    (0.28, -0.28),
    (0.36, -0.20),
    (0.52, 0.80),
    (0.72, 0.88),
    (0.95, 0.52),
    (1.12, -0.24),
    (1.3, 0.06),
    (1.5, 0.0),
];

/// A leap with run-up in the knees, then a rest in which the flesh settles. In the air from 0.46 s to
/// 0.96 s, as gravity has it.
pub(super) fn jump(t: f64) -> Pose {
    let mut pose = Pose::rest();
    pose.hips = dvec3(0.0, height(t), 0.0);
    let down = ramp(0.0, 0.26, t) * (1.0 - ramp(0.34, 0.46, t));
    let air = ramp(0.38, 0.48, t) * (1.0 - ramp(0.86, 1.0, t));
    let land = ramp(0.97, 1.09, t) * (1.0 - ramp(1.12, 1.36, t));
    pose.stretch = through(&STRETCH, LEAP, t);
    // Squeezed by both impacts.
    pose.open = 1.0 - 0.40 * down - 0.93 * ramp(0.93, 1.0, t) * (1.0 - ramp(1.16, 1.26, t));
    let foot = leap(t, UP - 0.02, DOWN + 0.005);
    pose.feet = [foot; 2];
    let lean = 0.42 * down - 0.16 * air + 0.38 * land;
    pose.turn(Bone::Hips, [0.30 * lean, 0.0, 0.0]);
    pose.turn(Bone::Spine, [0.35 * lean, 0.0, 0.0]);
    pose.turn(Bone::Chest, [0.35 * lean, 0.0, 0.0]);
    let nod = through(&NOD, LEAP, t);
    pose.turn(Bone::Neck, [-0.3 * lean, 0.0, 0.0]);
    pose.turn(Bone::Head, [-0.35 * lean + nod, 0.0, 0.0]);
    let wag = through(&WAG, LEAP, t);
    pose.turn(Bone::Tail1, [wag, 0.0, 0.0]);
    pose.turn(Bone::Tail2, [0.8 * wag, 0.0, 0.0]);
    let raise = through(&RAISE, LEAP, t);
    pose.turn_both(Bone::UpperArm, [0.75 * down - 0.30 * air, 0.0, RELAXED + raise]);
    pose.turn_both(Bone::Forearm, [-0.10, -0.15 - 0.2 * land, 0.35 * raise]);
    pose
}

/// Height of the hips during the leap.
fn height(t: f64) -> f64 {
    const GRAVITY: f64 = 9.81;
    let speed = 0.5 * GRAVITY * (DOWN - UP);
    if t < 0.32 {
        hermite(((0.0, 0.0), 0.0), ((0.32, -0.105), 0.0), t)
    } else if t < UP {
        hermite(((0.32, -0.105), 0.0), ((UP, 0.045), speed), t)
    } else if t < DOWN {
        0.045 + (t - UP) * (speed - 0.5 * GRAVITY * (t - UP))
    } else if t < 1.09 {
        hermite(((DOWN, 0.045), -speed), ((1.09, -0.115), 0.0), t)
    } else {
        through(
            &[
                (0.0, -0.115),
                (0.19, -0.006),
                (0.32, -0.009),
                (0.45, 0.0),
                (0.6, 0.0),
                (0.75, 0.0),
                (0.9, 0.0),
            ],
            2.0,
            t - 1.09,
        )
    }
}

/// A foot of the leap, in the air between two times.
fn leap(t: f64, up: f64, down: f64) -> Step {
    let s = ((t - up) / (down - up)).clamp(0.0, 1.0);
    let pitch = through(
        &[(0.0, 0.0), (0.34, 0.0), (0.47, 0.55), (0.70, 0.15), (0.93, -0.16), (1.0, 0.0), (1.2, 0.0)],
        LEAP,
        t,
    );
    let pitch = pitch * ramp(0.31, 0.40, t) * (1.0 - ramp(0.95, 1.02, t));
    let planted = if pitch > 0.0 { 0.150 * libm::sin(pitch) } else { -0.055 * libm::sin(pitch) };
    let rise = 1.42 * s * (1.0 - s);
    let spread = 0.02 * ramp(0.0, 0.5, s) * (1.0 - ramp(0.5, 1.0, s));
    Step {
        offset: DVec3::new(0.0, rise + planted, spread),
        pitch,
        toes: 0.9 * pitch.max(0.0) * (1.0 - ramp(0.0, 0.2, s)),
    }
}

/// As a wet dog does it; 2 s.
pub(super) fn shake(t: f64) -> Pose {
    let mut pose = Pose::rest();
    let strength = ramp(0.12, 0.50, t) * (1.0 - ramp(1.20, 1.66, t));
    let turn = |lag: f64| strength * wave(3.5 * (t - lag));
    let settle = bump(1.74, 0.22, t);
    pose.hips = dvec3(0.014 * turn(0.06), -0.055 * strength - 0.012 * settle, 0.0);
    pose.stretch = 1.0 - 0.05 * strength + 0.03 * settle;
    pose.open = 1.0 - 0.93 * ramp(0.16, 0.30, t) * (1.0 - ramp(1.52, 1.66, t)) - 0.9 * bump(1.82, 0.10, t);
    pose.turn(Bone::Hips, [0.06 * strength, 0.20 * turn(0.0), 0.03 * turn(0.05)]);
    pose.turn(Bone::Spine, [0.08 * strength, 0.24 * turn(0.015), 0.0]);
    pose.turn(Bone::Chest, [0.08 * strength, 0.26 * turn(0.03), 0.0]);
    pose.turn(Bone::Neck, [0.0, 0.10 * turn(0.07), 0.08 * turn(0.10)]);
    pose.turn(Bone::Head, [0.10 * strength - 0.10 * settle, 0.22 * turn(0.10), 0.26 * turn(0.13)]);
    pose.turn(Bone::Tail1, [-0.05 * strength, -0.40 * turn(0.05), 0.0]);
    pose.turn(Bone::Tail2, [0.0, -0.40 * turn(0.09), 0.0]);
    for side in Side::BOTH {
        let flap = side.sign() * turn(0.06);
        pose.turn_side(
            Bone::UpperArm,
            side,
            [-0.15 * strength, -0.10 * strength, RELAXED * (1.0 - strength) + 0.22 * strength],
        );
        pose.turn_side(
            Bone::Forearm,
            side,
            [-0.10, -0.15 - 0.20 * flap, 0.25 * strength * (1.0 + 0.4 * flap)],
        );
        pose.turn_side(Bone::Hand, side, [0.0, -0.25 * flap, 0.2 * strength]);
    }
    pose
}
