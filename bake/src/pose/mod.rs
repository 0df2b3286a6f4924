//! Poses: what the bones do in a sample of ground truth, and where such poses come from.
//!
//! ```text
//! clips of the file ─▶ clip ────────────┐
//! BVH ─▶ bvh ─▶ retarget ───────────────┼─▶ farthest (n of m that differ most) ─▶ simulation
//! limits of the joints ─▶ random ───────┘
//! ```
//!
//! A pose is skinned as any other: `x = Σₖ wₖ · model_from_bind(jₖ) · p`, `model_from_bind = model_from_node · joint_from_bind`.

pub mod bvh;
pub mod clip;
pub mod farthest;
pub mod names;
pub mod random;
pub mod retarget;

use crate::model::Model;
use glam::{DMat4, DQuat, DVec3};

/// Where every bone of a model is, relative to its parent.
///
/// Scales are those of the rest pose: bones do not stretch.
///
/// ```
/// use sinew_bake::{builtin, pose::Pose};
/// let model = builtin::character();
/// let rest = Pose::rest(&model);
/// assert_eq!(rest.palette(&model).len(), model.joints.len());
/// let mut bent = rest.clone();
/// bent.rotations[model.joints[3].node] *= glam::DQuat::from_rotation_z(0.5);
/// assert!((rest.distance(&bent) - 0.5).abs() < 1e-12);
/// assert!((rest.interpolate(&bent, 0.2).distance(&bent) - 0.4).abs() < 1e-12);
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Pose {
    /// Rotation of each of [`Model::nodes`], parent from node, normalized.
    pub rotations: Vec<DQuat>,
    /// Translation of each node, in its parent's frame; that of the rest pose for all but the root and joints that
    /// slide.
    pub translations: Vec<DVec3>,
}

impl Pose {
    /// The rest pose.
    #[must_use]
    pub fn rest(model: &Model) -> Self {
        Self {
            rotations: model.nodes.iter().map(|n| n.rotation).collect(),
            translations: model.nodes.iter().map(|n| n.translation).collect(),
        }
    }

    /// Transforms of all nodes, model from node.
    ///
    /// # Panics
    ///
    /// If the pose is not of this model: fewer nodes than the model has.
    #[must_use]
    pub fn transforms(&self, model: &Model) -> Vec<DMat4> {
        let turned = self.rotations.iter().zip(&self.translations);
        let local: Vec<DMat4> = (model.nodes.iter().zip(turned))
            .map(|(n, (r, t))| DMat4::from_scale_rotation_translation(n.scale, *r, *t))
            .collect();
        model.compose(&local)
    }

    /// The palette of skinning, `model_from_bind`, one of each of [`Model::joints`].
    ///
    /// # Panics
    ///
    /// As [`Self::transforms`].
    #[must_use]
    pub fn palette(&self, model: &Model) -> Vec<DMat4> {
        let model_from_node = self.transforms(model);
        model.joints.iter().map(|j| model_from_node[j.node] * j.joint_from_bind).collect()
    }

    /// The pose at `t` on the way from this one (0) to another (1): rotations by slerp the shorter way, translations
    /// along a line.
    #[must_use]
    pub fn interpolate(&self, to: &Self, t: f64) -> Self {
        let rotations = self.rotations.iter().zip(&to.rotations);
        let translations = self.translations.iter().zip(&to.translations);
        Self {
            rotations: rotations.map(|(a, b)| slerp(*a, *b, t)).collect(),
            translations: translations.map(|(a, b)| a.lerp(*b, t)).collect(),
        }
    }

    /// Sum over the nodes of the angles, rad, between their rotations here and there; translations do not count.
    #[must_use]
    pub fn distance(&self, other: &Self) -> f64 {
        self.rotations.iter().zip(&other.rotations).map(|(a, b)| angle_between(*a, *b)).sum()
    }

    /// Splits off where the root is: `(G, relative)`, where `relative` has the root and all above it as in the rest
    /// pose and `transforms(self) = G · transforms(relative)` for all below.
    ///
    /// The root is [`root`]'s; a model without one gives the identity and the pose itself.
    ///
    /// # Panics
    ///
    /// As [`Self::transforms`].
    #[must_use]
    pub fn split_root(&self, model: &Model) -> (DMat4, Self) {
        let mut relative = self.clone();
        let Some(root) = root(model) else { return (DMat4::IDENTITY, relative) };
        for node in ancestry(model, root) {
            relative.rotations[node] = model.nodes[node].rotation;
            relative.translations[node] = model.nodes[node].translation;
        }
        let (posed, rest) = (self.transforms(model)[root], model.rest_transforms()[root]);
        let map = if rest.determinant() == 0.0 { DMat4::IDENTITY } else { posed * rest.inverse() };
        (map, relative)
    }
}

/// The lowest node above or among all joints that move skin, or `None` where they have no common ancestor.
#[must_use]
pub fn root(model: &Model) -> Option<usize> {
    let moving = moving_nodes(model);
    let mut lowest: Option<Vec<usize>> = None;
    for node in (0..model.nodes.len()).filter(|n| moving[*n]) {
        let mut path = ancestry(model, node);
        path.reverse();
        lowest = Some(match lowest {
            None => path,
            Some(common) => {
                let same = common.iter().zip(&path).take_while(|(a, b)| a == b).count();
                path.truncate(same);
                path
            }
        });
    }
    lowest?.last().copied()
}

/// Which nodes have vertices that weigh on them.
#[must_use]
pub fn moving_nodes(model: &Model) -> Vec<bool> {
    let mut moving = vec![false; model.nodes.len()];
    for primitive in &model.primitives {
        for (joint, weight) in primitive.joints.iter().zip(&primitive.weights) {
            if *weight > 0.0 {
                moving[model.joints[usize::from(*joint)].node] = true;
            }
        }
    }
    moving
}

/// A node and all above it, upwards; a cycle is cut.
fn ancestry(model: &Model, node: usize) -> Vec<usize> {
    let above = |n: &usize| model.nodes[*n].parent;
    core::iter::successors(Some(node), above).take(model.nodes.len()).collect()
}

/// Angle of the rotation from `a` to `b`, rad, `0..=π`; exactly 0 for equal ones, and to the last bits for near ones.
#[must_use]
pub fn angle_between(a: DQuat, b: DQuat) -> f64 {
    let turn = turn(a, b);
    2.0 * libm::atan2(turn.xyz().length(), turn.w.abs())
}

/// `a⁻¹·b` of normalized quaternions, with terms in an order in which those of equal ones cancel to the bit.
fn turn(a: DQuat, b: DQuat) -> DQuat {
    let axis = (b.xyz() * a.w - a.xyz() * b.w) - a.xyz().cross(b.xyz());
    DQuat::from_vec4(axis.extend(a.dot(b)))
}

/// Rotation at `t` on the shorter way from `a` to `b`.
fn slerp(a: DQuat, b: DQuat, t: f64) -> DQuat {
    // The logarithm is accurate for small angles, where the usual formula divides by their sine.
    (a * DQuat::from_scaled_axis(scaled_axis(turn(a, b)) * t)).normalize()
}

/// Rotation vector, rad: axis times angle `-π..=π`; accurate for small angles.
pub(crate) fn scaled_axis(q: DQuat) -> DVec3 {
    let length = q.xyz().length();
    if length == 0.0 {
        return DVec3::ZERO;
    }
    let sign = if q.w < 0.0 { -1.0 } else { 1.0 };
    q.xyz() * (sign * 2.0 * libm::atan2(length, q.w.abs()) / length)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::builtin;
    use core::f64::consts::PI;

    /// Some rotation, and one after it.
    fn quaternions() -> impl Iterator<Item = DQuat> {
        (0..40).map(|i| {
            let x = f64::from(i);
            DQuat::from_xyzw(libm::sin(x), libm::cos(2.0 * x), libm::sin(3.0 * x + 1.0), libm::cos(5.0 * x))
                .normalize()
        })
    }

    /// A pose with every joint of the built-in character turned and its root moved.
    fn turned(model: &Model) -> Pose {
        let mut pose = Pose::rest(model);
        for (r, q) in pose.rotations.iter_mut().zip(quaternions()) {
            *r = (*r * q).normalize();
        }
        pose.translations[root(model).unwrap()] += DVec3::new(1.0, -2.0, 0.5);
        pose
    }

    #[test]
    fn the_rest_pose_is_the_models() {
        let model = builtin::character();
        assert_eq!(Pose::rest(&model).transforms(&model), model.rest_transforms());
    }

    #[test]
    fn angles_are_right_from_none_to_half_a_turn() {
        for q in quaternions() {
            assert!(angle_between(q, q) <= 0.0);
            assert!(angle_between(q, -q) <= 0.0);
            for angle in [1e-12, 1e-6, 0.1, 1.0, 3.0, PI] {
                let turned = q * DQuat::from_axis_angle(DVec3::new(0.6, 0.0, 0.8), angle);
                // Two products of quaternions round: a few ulp of 1.
                assert!((angle_between(q, turned) - angle).abs() < 4e-15, "{angle}");
            }
        }
    }

    #[test]
    fn interpolation_goes_the_shorter_way_at_an_even_pace() {
        let model = builtin::character();
        let (rest, far) = (Pose::rest(&model), turned(&model));
        for t in [0.0, 0.25, 0.5, 1.0] {
            let between = rest.interpolate(&far, t);
            for node in 0..model.nodes.len() {
                let whole = angle_between(rest.rotations[node], far.rotations[node]);
                let part = angle_between(rest.rotations[node], between.rotations[node]);
                assert!((part - t * whole).abs() < 1e-14, "{node}: {part} of {whole}");
            }
        }
        let flipped = Pose { rotations: far.rotations.iter().map(|q| -*q).collect(), ..far.clone() };
        assert!(rest.interpolate(&far, 0.5).distance(&rest.interpolate(&flipped, 0.5)) < 1e-12);
    }

    #[test]
    fn the_root_comes_apart_and_goes_back() {
        let model = builtin::character();
        let pose = turned(&model);
        let (root_map, relative) = pose.split_root(&model);
        let (whole, parts) = (pose.palette(&model), relative.palette(&model));
        let moving = moving_nodes(&model);
        for (joint, (a, b)) in model.joints.iter().zip(whole.iter().zip(&parts)) {
            assert!(!moving[joint.node] || a.abs_diff_eq(root_map * *b, 1e-13), "{a} {b}");
        }
        let node = root(&model).unwrap();
        assert_eq!(relative.transforms(&model)[node], model.rest_transforms()[node]);
        let (again, same) = relative.split_root(&model);
        assert!(again.abs_diff_eq(DMat4::IDENTITY, 1e-15), "{again}");
        assert_eq!(same, relative);
    }
}
