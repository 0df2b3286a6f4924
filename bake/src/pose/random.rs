//! Random poses within the limits of joints.
//!
//! ```text
//! q_node = q_rest · exp(v),   vᵢ = lowᵢ + (highᵢ − lowᵢ)(u + u′)/2,   u, u′ uniform in 0..1
//! ```
//!
//! The mean of two is rarely at an end: that all joints of a spine are, in one pose, is beyond a body. The boxes are
//! those of recorded poses where there are any in which the joint moves; else a fraction
//! of a turn to all sides, less for joints near the trunk's middle, where many add up. Pose number `i` is a function of
//! the seed and `i` alone: it has a stream of `ChaCha8` of its own.

use super::{Pose, moving_nodes, root, scaled_axis, turn};
use crate::Model;
use glam::{DQuat, DVec3};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};

/// A joint that turns less than this in all recordings, rad, does not move in them.
const STILL: f64 = 0.02;
/// To where a joint of which nothing is known turns, rad.
const DEFAULT: f64 = 0.5;
/// Chains shorter than this many joints turn as [`DEFAULT`] says; in longer ones the same turn is shared out.
const CHAIN: f64 = 2.0;

/// How far the joints of a character turn.
#[derive(Clone, Debug, PartialEq)]
pub struct Limits {
    /// Node and its box, rotation vectors from rest, rad, in the node's frame at rest.
    pub joints: Vec<(usize, [DVec3; 2])>,
}

impl Limits {
    /// From recorded poses, which may be none. The root does not turn.
    #[must_use]
    pub fn new(model: &Model, recorded: &[Pose]) -> Self {
        let (moving, root) = (moving_nodes(model), root(model));
        let free = (0..model.nodes.len()).filter(|n| moving[*n] && Some(*n) != root);
        let joints =
            free.map(|n| (n, seen(model, recorded, n).unwrap_or_else(|| default(model, &moving, n))));
        Self { joints: joints.collect() }
    }

    /// Pose number `index` of a seed: independent of all others.
    ///
    /// ```
    /// use sinew_bake::{builtin, pose::random::Limits};
    /// let model = builtin::character();
    /// let limits = Limits::new(&model, &[]);
    /// assert_eq!(limits.pose(&model, 1, 7), limits.pose(&model, 1, 7));
    /// assert_ne!(limits.pose(&model, 1, 7), limits.pose(&model, 1, 8));
    /// ```
    #[must_use]
    pub fn pose(&self, model: &Model, seed: u64, index: u64) -> Pose {
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        random.set_stream(index);
        let mut out = Pose::rest(model);
        for (node, [low, high]) in &self.joints {
            let mut share = || 0.5 * (uniform(&mut random) + uniform(&mut random));
            let v = [0, 1, 2].map(|k| low[k] + (high[k] - low[k]) * share());
            let turn = DQuat::from_scaled_axis(DVec3::from_array(v));
            out.rotations[*node] = (out.rotations[*node] * turn).normalize();
        }
        out
    }
}

/// A number from 0 to below 1, in steps of 2⁻⁵³.
fn uniform(random: &mut ChaCha8Rng) -> f64 {
    #[allow(clippy::cast_precision_loss, reason = "53 bits")]
    let bits = (random.next_u64() >> 11) as f64;
    bits / 9_007_199_254_740_992.0
}

/// The box of a joint in recorded poses; none where it does not move.
fn seen(model: &Model, recorded: &[Pose], node: usize) -> Option<[DVec3; 2]> {
    let rest = model.nodes[node].rotation.normalize();
    let vectors = recorded.iter().map(|p| scaled_axis(turn(rest, p.rotations[node])));
    let (low, high) = vectors.fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(l, h), v| (l.min(v), h.max(v)));
    let (middle, half) = (0.5 * (low + high), 0.5 * (high - low));
    (half.max_element() > STILL && half.is_finite()).then(|| [middle - half, middle + half])
}

/// The box of a joint of which nothing is known.
fn default(model: &Model, moving: &[bool], node: usize) -> [DVec3; 2] {
    // An ear of five joints bends as far in all as one of two.
    let below = |n: usize| (0..moving.len()).find(|c| moving[*c] && model.nodes[*c].parent == Some(n));
    let above = |n: &usize| model.nodes[*n].parent.filter(|p| moving[*p]);
    let up = core::iter::successors(Some(node), above).take(moving.len()).count();
    let down = core::iter::successors(below(node), |n| below(*n)).take(moving.len()).count();
    #[allow(clippy::cast_precision_loss, reason = "counts")]
    let share = (CHAIN / (up + down) as f64).min(1.0);
    let v = DVec3::splat(DEFAULT * share);
    [-v, v]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::builtin;
    use crate::pose::clip;

    #[test]
    fn poses_stay_within_what_was_recorded() {
        let model = builtin::character();
        let recorded: Vec<Pose> =
            model.clips.iter().flat_map(|c| clip::poses(&model, c, 20.0).unwrap()).collect();
        let limits = Limits::new(&model, &recorded);
        let mut widest = vec![[DVec3::INFINITY, DVec3::NEG_INFINITY]; model.nodes.len()];
        for i in 0..400 {
            let pose = limits.pose(&model, 5, i);
            for (node, _) in &limits.joints {
                let v = scaled_axis(turn(model.nodes[*node].rotation.normalize(), pose.rotations[*node]));
                let [low, high] = widest[*node];
                widest[*node] = [low.min(v), high.max(v)];
            }
        }
        for (node, [low, high]) in &limits.joints {
            let [least, most] = widest[*node];
            assert!((*low - least).max_element() < 1e-12 && (most - *high).max_element() < 1e-12, "{node}");
            // And they fill it: a number is in the outer fifth of either end once in 12 times; that none of 400 is
            // happens once in 10¹⁴.
            let part = 0.2 * (*high - *low) + 1e-12;
            assert!(
                (least - *low - part).max_element() < 0.0 && (*high - most - part).max_element() < 0.0,
                "{node}"
            );
        }
    }

    #[test]
    fn a_joint_of_which_nothing_is_known_turns_a_little() {
        let model = builtin::character();
        let limits = Limits::new(&model, &[]);
        assert!(!limits.joints.is_empty());
        assert!(
            limits.joints.iter().all(|(_, [low, high])| *low == -*high && (0.01..=DEFAULT).contains(&high.x))
        );
        assert!(limits.joints.iter().all(|(n, _)| Some(*n) != root(&model)), "the root stays");
    }
}
