//! Motion of one skeleton on another.
//!
//! ```text
//! R_target(t) = Y D(t) Y⁻¹ A R_target(rest),   D(t) = R_source(t) R_source(zero)⁻¹
//! ```
//!
//! `D` is how far a joint of the recording is turned in space, `Y` turns the recording's front to the character's, and
//! `A` is the shortest turn of the character's bone at rest to the direction of the recording's: an A-pose to a T-pose.
//! Joints that the recording does not have keep their place in their parent. The way of the hips is scaled by how high
//! they are. The character starts where it is at rest, and stands as high when the recording stands upright on what is
//! the lowest place of its foot.

use super::Pose;
use super::bvh::{Bvh, Placed};
use super::names::{Limb, Role, Side, roles};
use crate::{Error, Model};
use glam::{DQuat, DVec3};
use std::collections::BTreeMap;

/// Roles without which a skeleton is not that of a person.
const NEEDED: [Role; 5] = [
    Role::Hips,
    Role::Of(Side::Left, Limb::Arm),
    Role::Of(Side::Right, Limb::Arm),
    Role::Of(Side::Left, Limb::Thigh),
    Role::Of(Side::Right, Limb::Thigh),
];

/// A joint of a character that follows one of a recording.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Follower {
    /// Node of the model.
    pub node: usize,
    /// Joint of the recording.
    pub joint: usize,
    /// `A R_target(rest)` in the recording's axes, turned to the character's.
    rest: DQuat,
}

/// How a recording's skeleton moves a character.
#[derive(Clone, Debug, PartialEq)]
pub struct Retarget {
    /// Joints that follow, parents first.
    pub followers: Vec<Follower>,
    /// From the recording's front to the character's, about the vertical.
    front: DQuat,
    hips: (usize, usize),
    /// Height of the character's hips by that of the recording's.
    scale: f64,
    /// Where the recording's hips are when the character's are at their place at rest.
    origin: DVec3,
    /// Nodes, parents first.
    order: Vec<usize>,
}

impl Retarget {
    /// Matches the joints of a recording with those of a character by their names.
    ///
    /// # Errors
    ///
    /// [`Error::Unusable`] with what is missing, if one of the two has no hips, arms or legs by any known name.
    pub fn new(model: &Model, bvh: &Bvh, name: &str) -> Result<Self, Error> {
        let [source, target] = [of_recording(bvh), of_model(model)];
        for (roles, what) in [(&source, name), (&target, model.name.as_str())] {
            if let Some(missing) = NEEDED.iter().find(|role| !roles.contains_key(role)) {
                let remedy = "rename the joints as Mixamo, CMU, VRM or Unreal do";
                return Err(Error::unusable(what, "joints", format!("none is called {missing:?}"), remedy));
            }
        }
        let rest = bvh.rest();
        let places: Vec<DVec3> = model.rest_transforms().iter().map(|m| m.w_axis.truncate()).collect();
        let from: BTreeMap<Role, DVec3> = source.iter().map(|(r, j)| (*r, rest[*j].translation)).collect();
        let to: BTreeMap<Role, DVec3> = target.iter().map(|(r, n)| (*r, places[*n])).collect();
        let front = flat(across(&from), across(&to));
        let pairs = pairs(&source, &target);
        let rotations = rotations(model, &Pose::rest(model));
        let followers = pairs.iter().map(|(role, joint, node)| {
            // A hand goes on as its forearm does.
            let of = match role {
                Role::Of(side, Limb::Hand) => &Role::Of(*side, Limb::Forearm),
                other => other,
            };
            let aligned = direction(of, &to).zip(direction(of, &from));
            let turn = aligned.map_or(DQuat::IDENTITY, |(t, s)| DQuat::from_rotation_arc(t, front * s));
            Follower { node: *node, joint: *joint, rest: turn * rotations[*node] }
        });
        let order = order(model);
        let mut followers: Vec<Follower> = followers.collect();
        followers.sort_by_key(|f| order.iter().position(|n| *n == f.node));
        let hips = (target[&Role::Hips], source[&Role::Hips]);
        let (origin, scale) = standing(bvh, &source, leg(&from), leg(&to));
        Ok(Self { followers, front, hips, scale, origin, order })
    }

    /// The character's pose in a frame of the recording.
    ///
    /// # Panics
    ///
    /// If there is no such frame, or model and recording are others.
    #[must_use]
    pub fn pose(&self, model: &Model, bvh: &Bvh, frame: usize) -> Pose {
        self.of(model, &bvh.placed(frame))
    }

    fn of(&self, model: &Model, placed: &[Placed]) -> Pose {
        let mut out = Pose::rest(model);
        let wanted: BTreeMap<usize, DQuat> = self
            .followers
            .iter()
            .map(|f| {
                let turned = self.front * placed[f.joint].rotation * self.front.inverse();
                (f.node, turned * f.rest)
            })
            .collect();
        let mut space = vec![DQuat::IDENTITY; model.nodes.len()];
        for &n in &self.order {
            let above = model.nodes[n].parent.map_or(DQuat::IDENTITY, |p| space[p]);
            if let Some(rotation) = wanted.get(&n) {
                out.rotations[n] = (above.inverse() * *rotation).normalize();
            }
            space[n] = (above * out.rotations[n]).normalize();
        }
        let (node, joint) = self.hips;
        let way = self.scale * (self.front * (placed[joint].translation - self.origin));
        // The way is in model space, the hips' translation in their parent's.
        let parent = model.nodes[node].parent;
        let into = parent.map_or(DVec3::ONE, |p| out.transforms(model)[p].to_scale_rotation_translation().0);
        let above = parent.map_or(DQuat::IDENTITY, |p| space[p]);
        out.translations[node] += above.inverse() * way / into;
        out
    }
}

/// Poses of a whole recording at `rate` a second, from its first true frame on.
///
/// # Errors
///
/// Those of [`Retarget::new`]; [`Error::Unusable`] for a rate that is not above 0.
pub fn poses(model: &Model, bvh: &Bvh, name: &str, rate: f64) -> Result<Vec<Pose>, Error> {
    let retarget = Retarget::new(model, bvh, name)?;
    if !(rate > 0.0 && rate.is_finite()) {
        let problem = format!("{rate} poses a second");
        return Err(Error::unusable(name, "rate", problem, "give a rate such as 10 Hz"));
    }
    let first = bvh.first_frame();
    // Recordings are faster than what is wanted: the nearest frame is near enough.
    let step = (1.0 / (rate * bvh.frame_time)).max(1.0);
    #[allow(clippy::cast_precision_loss, reason = "frames")]
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a frame of the file")]
    let frame = |k: usize| first + libm::round(k as f64 * step) as usize;
    let frames = (0..bvh.frames()).map(frame).take_while(|f| *f < bvh.frames());
    Ok(frames.map(|f| retarget.of(model, &bvh.placed(f))).collect())
}

fn of_recording(bvh: &Bvh) -> BTreeMap<Role, usize> {
    let names: Vec<&str> = bvh.joints.iter().map(|j| j.name.as_str()).collect();
    let parents: Vec<Option<usize>> = bvh.joints.iter().map(|j| j.parent).collect();
    roles(&names, &parents)
}

fn of_model(model: &Model) -> BTreeMap<Role, usize> {
    let mut is_joint = vec![false; model.nodes.len()];
    model.joints.iter().for_each(|j| is_joint[j.node] = true);
    let name = |(n, joint): (&crate::model::Node, &bool)| if *joint { n.name.clone() } else { String::new() };
    let names: Vec<String> = model.nodes.iter().zip(&is_joint).map(name).collect();
    let parents: Vec<Option<usize>> = model.nodes.iter().map(|n| n.parent).collect();
    roles(&names.iter().map(String::as_str).collect::<Vec<_>>(), &parents)
}

/// Joints with one role: `(role, joint of the source, joint of the target)`. Spines of different lengths share their
/// ends; what is between follows the nearest by order.
fn pairs(source: &BTreeMap<Role, usize>, target: &BTreeMap<Role, usize>) -> Vec<(Role, usize, usize)> {
    let count = |roles: &BTreeMap<Role, usize>| roles.keys().filter(|r| matches!(r, Role::Spine(_))).count();
    let [m, n] = [count(source), count(target)];
    let of = |(role, node): (&Role, &usize)| {
        let from = match role {
            Role::Spine(k) if n > 1 => {
                let k = (usize::from(*k) * m.saturating_sub(1) + (n - 1) / 2) / (n - 1);
                Role::Spine(u8::try_from(k).unwrap_or(u8::MAX))
            }
            Role::Spine(_) => Role::Spine(u8::try_from(m.saturating_sub(1)).unwrap_or(u8::MAX)),
            other => *other,
        };
        source.get(&from).map(|joint| (*role, *joint, *node))
    };
    target.iter().filter_map(of).collect()
}

/// From the right thigh to the left.
fn across(points: &BTreeMap<Role, DVec3>) -> DVec3 {
    let thigh = |side| points[&Role::Of(side, Limb::Thigh)];
    thigh(Side::Left) - thigh(Side::Right)
}

/// Height of the hips over the lowest end of a leg, at rest.
fn leg(points: &BTreeMap<Role, DVec3>) -> f64 {
    let ends = [Limb::Foot, Limb::Shin].map(|limb| points.get(&Role::Of(Side::Left, limb)));
    let end = ends.into_iter().flatten().next();
    end.map_or(0.0, |end| (points[&Role::Hips] - *end).length())
}

/// Where the recording's hips are when it stands upright in its first place, and the ratio of legs.
fn standing(bvh: &Bvh, source: &BTreeMap<Role, usize>, from: f64, to: f64) -> (DVec3, f64) {
    let hips = source[&Role::Hips];
    let ends = [Limb::Foot, Limb::Shin].map(|limb| source.get(&Role::Of(Side::Left, limb)));
    let Some(foot) = ends.into_iter().flatten().next() else { return (DVec3::ZERO, 1.0) };
    let frames = (bvh.first_frame()..bvh.frames()).map(|f| bvh.placed(f));
    let mut start = None;
    let mut low = f64::INFINITY;
    for placed in frames {
        start.get_or_insert(placed[hips].translation);
        low = low.min(placed[*foot].translation.y);
    }
    let Some(start) = start else { return (DVec3::ZERO, 1.0) };
    let scale = to / from;
    (DVec3::new(start.x, low + from, start.z), if scale.is_finite() && scale > 0.0 { scale } else { 1.0 })
}

/// The turn about the vertical from one direction to another.
fn flat(from: DVec3, to: DVec3) -> DQuat {
    let angle = |v: DVec3| libm::atan2(-v.z, v.x);
    DQuat::from_rotation_y(angle(to) - angle(from))
}

/// Where the bone of a role points: to the joint below it.
fn direction(role: &Role, points: &BTreeMap<Role, DVec3>) -> Option<DVec3> {
    let below = match role {
        Role::Of(side, limb) => Role::Of(
            *side,
            match limb {
                Limb::Arm => Limb::Forearm,
                Limb::Forearm => Limb::Hand,
                Limb::Thigh => Limb::Shin,
                Limb::Shin => Limb::Foot,
                // Where feet and shoulder blades point is a matter of how joints were placed.
                Limb::Collar | Limb::Hand | Limb::Foot | Limb::Toes => return None,
            },
        ),
        // Trunks stand upright in all rest poses.
        Role::Hips | Role::Spine(_) | Role::Neck | Role::Head => return None,
    };
    let way = *points.get(&below)? - *points.get(role)?;
    way.try_normalize()
}

/// Rotations of all nodes in model space.
fn rotations(model: &Model, pose: &Pose) -> Vec<DQuat> {
    let mut out = vec![DQuat::IDENTITY; model.nodes.len()];
    for n in order(model) {
        let above = model.nodes[n].parent.map_or(DQuat::IDENTITY, |p| out[p]);
        out[n] = (above * pose.rotations[n]).normalize();
    }
    out
}

/// Nodes, parents first.
fn order(model: &Model) -> Vec<usize> {
    let mut out: Vec<usize> = (0..model.nodes.len()).collect();
    out.sort_by_key(|n| super::ancestry(model, *n).len());
    out
}
