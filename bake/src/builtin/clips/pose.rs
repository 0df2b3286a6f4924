//! A pose as an animator thinks of it, and its joints: turns, planted feet, squash, eyelids.

use super::curve::ramp;
use crate::builtin::skeleton::{Bone, JOINTS, Side, index, nodes, position};
use glam::{DQuat, DVec3, dvec3};

/// Transform of a joint relative to its parent.
#[derive(Clone, Copy, Debug)]
pub(super) struct Local {
    pub(super) translation: DVec3,
    pub(super) rotation: DQuat,
    pub(super) scale: DVec3,
}

/// Where a foot is.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Step {
    /// Offset of the ankle from the rest pose.
    pub(super) offset: DVec3,
    /// Pitch, radians, toes downwards.
    pub(super) pitch: f64,
    /// Bend of the toes against the foot, radians, upwards.
    pub(super) toes: f64,
}

/// A pose.
#[derive(Clone, Debug)]
pub(super) struct Pose {
    /// Offset of the hips from the rest pose.
    pub(super) hips: DVec3,
    /// Length of the back for its rest length.
    pub(super) stretch: f64,
    /// How far the eyes are open.
    pub(super) open: f64,
    /// Feet, left and right.
    pub(super) feet: [Step; 2],
    turns: [DVec3; JOINTS],
}

impl Pose {
    /// The rest pose.
    pub(super) fn rest() -> Self {
        Self {
            hips: DVec3::ZERO,
            stretch: 1.0,
            open: 1.0,
            feet: [Step::default(); 2],
            turns: [DVec3::ZERO; JOINTS],
        }
    }

    /// Turns a joint of the middle by angles about x (forwards), y (to the left) and z (to the right
    /// ear down when negative), radians.
    pub(super) fn turn(&mut self, bone: Bone, angles: [f64; 3]) {
        self.turn_side(bone, Side::Left, angles);
    }

    /// Turns a joint of one side by the angles of the left; the right mirrors them.
    pub(super) fn turn_side(&mut self, bone: Bone, side: Side, [x, y, z]: [f64; 3]) {
        self.turns[index(bone, side)] += dvec3(x, y * side.sign(), z * side.sign());
    }

    /// Turns a joint on both sides.
    pub(super) fn turn_both(&mut self, bone: Bone, angles: [f64; 3]) {
        for side in Side::BOTH {
            self.turn_side(bone, side, angles);
        }
    }

    /// The joints' transforms.
    pub(super) fn solve(&self) -> Vec<Local> {
        let mut out: Vec<Local> = nodes()
            .iter()
            .zip(&self.turns)
            .map(|(n, t)| Local { translation: n.translation, rotation: euler(*t), scale: n.scale })
            .collect();
        for bone in [Bone::Spine, Bone::Chest, Bone::Neck, Bone::Head] {
            out[index(bone, Side::Left)].translation *= self.stretch;
        }
        out[index(Bone::Hips, Side::Left)].translation += self.hips;
        for (side, step) in Side::BOTH.into_iter().zip(self.feet) {
            // A closed eye sinks into the head and leaves the line of its lid.
            let sunk = 0.1 + 0.9 * ramp(0.08, 0.35, self.open);
            out[index(Bone::Eye, side)].scale = dvec3(sunk, self.open, sunk);
            self.plant(side, step, &mut out);
        }
        out
    }

    /// Bends a leg so that its foot is where `step` says; a foot out of reach hangs below the hip.
    fn plant(&self, side: Side, step: Step, out: &mut [Local]) {
        let [hip, knee, ankle] = [Bone::Thigh, Bone::Shin, Bone::Foot].map(|b| position(b, side));
        let pelvis = position(Bone::Hips, Side::Left);
        let turn = out[index(Bone::Hips, Side::Left)].rotation;
        let from = pelvis + self.hips + turn * (hip - pelvis);
        let (upper, lower) = ((knee - hip).length(), (ankle - knee).length());
        let reach = ankle + step.offset - from;
        let distance = reach.length().clamp(0.3 * (upper + lower), 0.995 * (upper + lower));
        let down = reach.normalize_or(DVec3::NEG_Y);
        // Knees point forwards and a little outwards.
        let forwards = turn * dvec3(0.35 * side.sign(), 0.0, 1.0);
        let forwards = (forwards - down * forwards.dot(down)).normalize_or(DVec3::Z);
        let along = (distance * distance + upper * upper - lower * lower) / (2.0 * distance);
        let aside = (upper * upper - along * along).max(0.0).sqrt();
        let bend = down * along + forwards * aside;
        let thigh = arc(turn * (knee - hip), bend) * turn;
        let shin = arc(thigh * (ankle - knee), down * distance - bend) * thigh;
        let foot = about(DVec3::X, step.pitch);
        out[index(Bone::Thigh, side)].rotation = (turn.conjugate() * thigh).normalize();
        out[index(Bone::Shin, side)].rotation = (thigh.conjugate() * shin).normalize();
        out[index(Bone::Foot, side)].rotation = (shin.conjugate() * foot).normalize();
        out[index(Bone::Toes, side)].rotation = about(DVec3::X, -step.toes);
    }
}

/// Shortest rotation from one direction to another, less than a half turn apart.
fn arc(from: DVec3, to: DVec3) -> DQuat {
    let (from, to) = (from.normalize(), to.normalize());
    let axis = from.cross(to);
    DQuat::from_xyzw(axis.x, axis.y, axis.z, 1.0 + from.dot(to)).normalize()
}

/// Rotation about z, then x, then y.
fn euler(angles: DVec3) -> DQuat {
    (about(DVec3::Y, angles.y) * about(DVec3::X, angles.x) * about(DVec3::Z, angles.z)).normalize()
}

fn about(axis: DVec3, angle: f64) -> DQuat {
    let (sine, cosine) = libm::sincos(0.5 * angle);
    let v = axis * sine;
    DQuat::from_xyzw(v.x, v.y, v.z, cosine)
}
