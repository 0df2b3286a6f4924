//! Pose in, palette out; and what the root did since the last step.

use crate::kernel::clip::{Channels, Property};
use crate::kernel::copy::copy;
use crate::kernel::skin::Rows;
use crate::kernel::tiny::{LEAST, flush_all, flush_map};
use crate::math::affine::{self, Affine};
use crate::math::{quat, vec3};

/// Where the character's root is: `world_from_root`.
///
/// The translation is `f64`, so that a kilometre from the origin costs no precision.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Root {
    /// Translation, world units.
    pub translation: [f64; 3],
    /// Rotation `[x, y, z, w]`, normalized where used.
    pub rotation: [f32; 4],
}

impl Default for Root {
    fn default() -> Self {
        Self { translation: [0.0; 3], rotation: quat::IDENTITY }
    }
}

impl Root {
    /// Whether every number is finite and the rotation has a direction.
    #[must_use]
    pub fn is_valid(&self) -> bool {
        let square = quat::dot(self.rotation, self.rotation);
        self.translation.iter().all(|x| x.is_finite()) && square > 1e-6 && square < 1e6
    }

    /// The same root with numbers that are too small to matter as zero ([`crate::kernel::tiny`]).
    #[must_use]
    pub fn flushed(&self) -> Self {
        let least = f64::from(LEAST);
        let flush = |x: f64| if -least < x && x < least { 0.0 } else { x };
        Self { translation: self.translation.map(flush), rotation: flush_all(self.rotation) }
    }

    /// The columns of `root_from_world`'s rotation.
    #[must_use]
    pub fn from_world(&self) -> [[f32; 3]; 3] {
        quat::to_columns(quat::conjugate(self.rotation)).map(flush_all)
    }

    /// The old root seen from the new one, of which the share `inertia` (0 to 1) is felt: a rigid map,
    /// or `None` where nothing is to be done.
    #[must_use]
    #[allow(clippy::float_cmp, reason = "an unmoved root is the same to the bit")]
    pub fn felt(old: &Self, new: &Self, inertia: f32) -> Option<Affine> {
        if inertia <= 0.0 || old == new {
            return None;
        }
        let new_from_world = quat::conjugate(quat::normalize(new.rotation));
        let turn = if old.rotation == new.rotation {
            quat::IDENTITY
        } else {
            quat::normalize(quat::mul(new_from_world, quat::normalize(old.rotation)))
        };
        #[allow(clippy::cast_possible_truncation, reason = "a difference of positions fits f32")]
        let moved: [f32; 3] = [0, 1, 2].map(|i| (old.translation[i] - new.translation[i]) as f32);
        let [x, y, z] = quat::to_columns(new_from_world).map(flush_all);
        let back = affine::rotate(&[x, y, z, [0.0; 3]], flush_all(moved));
        let felt = quat::nlerp(quat::IDENTITY, turn, inertia);
        Some(flush_map(&affine::from_trs(vec3::scale(back, inertia), felt, [1.0; 3])))
    }

    /// Distance between two roots, world units.
    #[must_use]
    pub fn distance(&self, other: &Self) -> f32 {
        let d = [0, 1, 2].map(|i| self.translation[i] - other.translation[i]);
        #[allow(clippy::cast_possible_truncation, reason = "an estimate that is compared with a limit")]
        let d = d.map(|d| d as f32);
        crate::math::float::sqrt(vec3::dot(d, d))
    }
}

/// The palette of a pose: `model_from_bind = root_from_joint · joint_from_bind`, a joint each; the shortest slice
/// decides how many.
pub fn palette(root_from_joint: &[Affine], joint_from_bind: &[Affine], out: &mut [Rows]) {
    for ((a, b), out) in root_from_joint.iter().zip(joint_from_bind).zip(out) {
        *out = affine::to_rows(&flush_map(&affine::mul(a, b)));
    }
}

/// Skeleton of an asset: parents come before their children.
#[derive(Clone, Copy, Debug)]
pub struct Skeleton<'a> {
    /// Parent of each node; a number past the end for a root.
    pub parents: &'a [u32],
    /// Rest translation, rotation and scale of each node.
    pub rest: &'a [[f32; 10]],
    /// Node of each joint.
    pub joint_node: &'a [u32],
}

/// Samples a clip: `root_from_joint` of every joint at time `t`, s.
///
/// * `local`: workspace, ten floats a node; `model`: workspace, a map a node.
///
/// An index out of range (a parsed asset holds none) is passed over.
pub fn sample(
    skeleton: Skeleton<'_>,
    channels: Channels<'_>,
    t: f32,
    out: &mut [Affine],
    (local, model): (&mut [[f32; 10]], &mut [Affine]),
) {
    copy(skeleton.rest, local);
    for (node, property, keys) in channels.rows.iter().filter_map(|row| channels.channel(row)) {
        let Some(trs) = local.get_mut(node) else { continue };
        match property {
            Property::Translation => trs[..3].copy_from_slice(&flush_all(keys.sample::<3>(t))),
            Property::Rotation => trs[3..7].copy_from_slice(&flush_all(keys.sample_rotation(t))),
            Property::Scale => trs[7..].copy_from_slice(&flush_all(keys.sample::<3>(t))),
        }
    }
    for (i, (local, parent)) in local.iter().zip(skeleton.parents).enumerate() {
        let [tx, ty, tz, qx, qy, qz, qw, sx, sy, sz] = *local;
        let map = affine::from_trs([tx, ty, tz], [qx, qy, qz, qw], [sx, sy, sz]);
        let Some((before, [model, ..])) = model.split_at_mut_checked(i) else { break };
        *model = before.get(*parent as usize).map_or(map, |parent| affine::mul(parent, &map));
    }
    for (out, node) in out.iter_mut().zip(skeleton.joint_node) {
        *out = model.get(*node as usize).copied().unwrap_or(*out);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn root(x: f64, angle: f32) -> Root {
        let (s, c) = crate::math::trig::sin_cos(0.5 * angle);
        Root { translation: [x, 0.0, 2.0], rotation: [0.0, s, 0.0, c] }
    }

    #[test]
    fn a_felt_root_keeps_world_positions() {
        let (old, new) = (root(3.0, 0.4), root(3.5, 1.0));
        let map = Root::felt(&old, &new, 1.0).unwrap();
        let world = |r: &Root, p| {
            let [x, y, z] = quat::to_columns(r.rotation);
            #[allow(clippy::cast_possible_truncation, reason = "small numbers")]
            affine::transform(&[x, y, z, r.translation.map(|t| t as f32)], p)
        };
        let p = [0.1, -0.5, 0.3];
        let (before, after) = (world(&old, p), world(&new, affine::transform(&map, p)));
        for i in 0..3 {
            assert!((before[i] - after[i]).abs() < 1e-6, "{before:?} {after:?}");
        }
        assert_eq!(Root::felt(&old, &new, 0.0), None);
        assert_eq!(Root::felt(&new, &new, 1.0), None);
    }

    #[test]
    fn far_from_the_origin_nothing_changes() {
        let near = Root::felt(&root(0.0, 0.4), &root(0.5, 1.0), 1.0);
        let far = Root::felt(&root(1e6, 0.4), &root(1e6 + 0.5, 1.0), 1.0);
        assert_eq!(near, far);
    }
}
