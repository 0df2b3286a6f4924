//! The skeleton: joints stand where bones meet; ears, belly and cheeks have none.

use crate::model::{Joint, Node};
use glam::{DMat4, DQuat, DVec3, dvec3};

/// A joint on the left or in the middle; the right is its mirror image.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Bone {
    Root,
    Hips,
    Spine,
    Chest,
    Neck,
    Head,
    Tail1,
    Tail2,
    Eye,
    Shoulder,
    UpperArm,
    Forearm,
    Hand,
    Thigh,
    Shin,
    Foot,
    Toes,
}

use Bone::{
    Chest, Eye, Foot, Forearm, Hand, Head, Hips, Neck, Root, Shin, Shoulder, Spine, Tail1, Tail2, Thigh,
    Toes, UpperArm,
};

/// Joints of the middle: bone, parent, name, position in the rest pose.
const MIDDLE: [(Bone, Bone, &str, DVec3); 8] = [
    (Root, Root, "root", dvec3(0.0, 0.0, 0.0)),
    (Hips, Root, "hips", dvec3(0.0, 0.330, -0.030)),
    (Spine, Hips, "spine", dvec3(0.0, 0.470, -0.040)),
    (Chest, Spine, "chest", dvec3(0.0, 0.620, -0.040)),
    (Neck, Chest, "neck", dvec3(0.0, 0.780, -0.020)),
    (Head, Neck, "head", dvec3(0.0, 0.865, 0.000)),
    (Tail1, Hips, "tail_1", dvec3(0.0, 0.320, -0.220)),
    (Tail2, Tail1, "tail_2", dvec3(0.0, 0.240, -0.400)),
];

/// Joints of the left side.
const SIDE: [(Bone, Bone, &str, DVec3); 9] = [
    (Eye, Head, "eye", dvec3(0.152, 1.035, 0.265)),
    (Shoulder, Chest, "shoulder", dvec3(0.070, 0.705, -0.010)),
    (UpperArm, Shoulder, "upper_arm", dvec3(0.205, 0.690, 0.010)),
    (Forearm, UpperArm, "forearm", dvec3(0.375, 0.640, 0.030)),
    (Hand, Forearm, "hand", dvec3(0.512, 0.565, 0.088)),
    (Thigh, Hips, "thigh", dvec3(0.200, 0.300, 0.005)),
    (Shin, Thigh, "shin", dvec3(0.218, 0.185, 0.040)),
    (Foot, Shin, "foot", dvec3(0.222, 0.075, 0.015)),
    (Toes, Foot, "toes", dvec3(0.235, 0.050, 0.180)),
];

/// A side of the body; `+x` is its left.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Side {
    Left,
    Right,
}

impl Side {
    /// Both.
    pub(super) const BOTH: [Self; 2] = [Self::Left, Self::Right];

    /// `x` of the left on this side.
    pub(super) fn sign(self) -> f64 {
        if self == Self::Left { 1.0 } else { -1.0 }
    }
}

/// Number of joints, which are also the first nodes.
pub(super) const JOINTS: usize = MIDDLE.len() + 2 * SIDE.len();

/// Index of a joint, and of its node.
pub(super) fn index(bone: Bone, side: Side) -> usize {
    let middle = MIDDLE.iter().position(|row| row.0 == bone);
    let beside = SIDE.iter().position(|row| row.0 == bone).unwrap_or(0);
    let right = if side == Side::Left { 0 } else { SIDE.len() };
    middle.unwrap_or(MIDDLE.len() + beside + right)
}

/// The joint's mirror image.
pub(super) fn mirrored(joint: usize) -> usize {
    match joint.checked_sub(MIDDLE.len()) {
        None => joint,
        Some(beside) if beside < SIDE.len() => joint + SIDE.len(),
        Some(_) => joint - SIDE.len(),
    }
}

/// Position of a joint in the rest pose.
pub(super) fn position(bone: Bone, side: Side) -> DVec3 {
    let rows = MIDDLE.iter().chain(&SIDE);
    let p = rows.filter(|row| row.0 == bone).map(|row| row.3).fold(DVec3::ZERO, |_, p| p);
    dvec3(p.x * side.sign(), p.y, p.z)
}

/// Joints as nodes, with the identity as rest rotation: the axes of a joint are the character's.
pub(super) fn nodes() -> Vec<Node> {
    let mut out = Vec::with_capacity(JOINTS);
    let mut push = |bone: Bone, parent: Bone, name: String, side: Side| {
        let above = if bone == Root { DVec3::ZERO } else { position(parent, side) };
        out.push(Node {
            name,
            parent: (bone != Root).then(|| index(parent, side)),
            translation: position(bone, side) - above,
            rotation: DQuat::IDENTITY,
            scale: DVec3::ONE,
        });
    };
    for (bone, parent, name, _) in MIDDLE {
        push(bone, parent, name.to_owned(), Side::Left);
    }
    for side in Side::BOTH {
        let suffix = if side == Side::Left { "l" } else { "r" };
        for (bone, parent, name, _) in SIDE {
            push(bone, parent, format!("{name}_{suffix}"), side);
        }
    }
    out
}

/// Joints with their inverse bind matrices.
pub(super) fn joints() -> Vec<Joint> {
    let joint = |(bone, side)| {
        let joint_from_bind = DMat4::from_translation(-position(bone, side));
        Joint { node: index(bone, side), joint_from_bind }
    };
    let middle = MIDDLE.iter().map(|row| (row.0, Side::Left));
    let beside = Side::BOTH.into_iter().flat_map(|side| SIDE.iter().map(move |row| (row.0, side)));
    middle.chain(beside).map(joint).collect()
}
