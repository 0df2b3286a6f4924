//! Bones as segments: from a joint to the joints below it, from a last joint to the middle of its skin.

use super::Outcome;
use super::skin::{Skin, unusable};
use crate::model::Model;
use glam::DVec3;
use std::collections::BTreeMap;

/// Segments shorter than this (body sizes) are points.
const SHORT: f64 = 1e-4;

/// A segment of a bone.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Segment {
    pub(super) from: DVec3,
    pub(super) to: DVec3,
}

/// Where a point's bones are nearest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Foot {
    /// Place on the bones, blended by weights, m.
    pub(super) place: DVec3,
    /// Whether it is beyond the end of a last bone.
    pub(super) at_end: bool,
}

/// The segments that belong to each node that moves skin.
#[derive(Clone, Debug)]
pub(super) struct Bones {
    segments: BTreeMap<usize, Vec<Segment>>,
    /// Nodes of last bones.
    last: Vec<usize>,
}

impl Segment {
    /// Share of the way to the nearest point of the segment to `p`, `0..=1`.
    fn along(&self, p: DVec3) -> f64 {
        let way = self.to - self.from;
        let square = way.length_squared();
        if square > 0.0 { ((p - self.from).dot(way) / square).clamp(0.0, 1.0) } else { 0.0 }
    }

    fn nearest(&self, p: DVec3) -> DVec3 {
        self.from + self.along(p) * (self.to - self.from)
    }
}

impl Bones {
    /// Of the joints of a model.
    pub(super) fn new(model: &Model, skin: &Skin) -> Outcome<Self> {
        let rest = model.rest_transforms();
        let place = |node: usize| rest[node].w_axis.truncate();
        let mut below: BTreeMap<usize, Vec<usize>> =
            model.joints.iter().map(|j| (j.node, Vec::new())).collect();
        for node in below.keys().copied().collect::<Vec<_>>() {
            if let Some(above) = joint_above(model, &below, node) {
                below.entry(above).or_default().push(node);
            }
        }
        let middles = middles(skin);
        let mut bones = Self { segments: BTreeMap::new(), last: Vec::new() };
        for node in middles.keys() {
            let mut segments = Vec::new();
            collect(&below, &middles, *node, &mut |from, to| {
                segments.push(Segment { from: place(from), to: place(to) });
            });
            segments.retain(|s| s.from.distance(s.to) > SHORT * skin.size);
            if segments.is_empty() {
                segments.push(Segment { from: place(*node), to: middles[node] });
                bones.last.push(*node);
            }
            bones.segments.insert(*node, segments);
        }
        let length = |s: &Segment| s.from.distance(s.to);
        if bones.segments.values().flatten().map(length).fold(0.0, f64::max) <= SHORT * skin.size {
            return Err(unusable(
                model,
                "skeleton",
                "no bone has a length: all joints are in one place",
                "rig the body with joints where its bones begin and end",
            ));
        }
        Ok(bones)
    }

    /// Foot of `p` on the bones that `weights` name.
    pub(super) fn foot(&self, p: DVec3, weights: &[(usize, f64)]) -> Foot {
        let (mut place, mut ends) = (DVec3::ZERO, 0.0);
        for (node, weight) in weights {
            place += *weight * self.nearest(p, *node);
            let beyond = |s: &Segment| s.along(p) >= 1.0;
            if self.last.contains(node) && self.segments[node].iter().all(beyond) {
                ends += weight;
            }
        }
        Foot { place, at_end: ends > 0.5 }
    }

    /// The nearest point of a node's segments; between segments that are nearly as near, their mean, so that the foot
    /// does not jump where the bones fork, and favors no side.
    fn nearest(&self, p: DVec3, node: usize) -> DVec3 {
        let feet = || self.segments.get(&node).into_iter().flatten().map(|s| s.nearest(p));
        let least = feet().map(|q| q.distance_squared(p)).fold(f64::INFINITY, f64::min);
        let (mut sum, mut weight) = (DVec3::ZERO, 0.0);
        for q in feet() {
            let near = if least > 0.0 { least / q.distance_squared(p) } else { f64::from(q == p) };
            let w = near * near * near * near;
            sum += w * q;
            weight += w;
        }
        if weight > 0.0 { sum / weight } else { p }
    }
}

/// Segments below a node: through joints that move no skin to the next that does.
fn collect(
    below: &BTreeMap<usize, Vec<usize>>,
    middles: &BTreeMap<usize, DVec3>,
    node: usize,
    push: &mut impl FnMut(usize, usize),
) {
    for child in below.get(&node).into_iter().flatten() {
        push(node, *child);
        if !middles.contains_key(child) {
            collect(below, middles, *child, push);
        }
    }
}

/// The next joint above a node.
fn joint_above(model: &Model, joints: &BTreeMap<usize, Vec<usize>>, node: usize) -> Option<usize> {
    let mut above = model.nodes[node].parent;
    // Not more steps than nodes: a file's nodes may form a ring.
    for _ in 0..model.nodes.len() {
        match above {
            Some(n) if !joints.contains_key(&n) => above = model.nodes[n].parent,
            found => return found,
        }
    }
    None
}

/// Middle of the skin of each node that moves any, by weight and area.
fn middles(skin: &Skin) -> BTreeMap<usize, DVec3> {
    let mut sums: BTreeMap<usize, (DVec3, f64)> = BTreeMap::new();
    for ((p, area), row) in skin.points.iter().zip(&skin.areas).zip(&skin.weights) {
        for (node, weight) in row {
            let sum = sums.entry(*node).or_default();
            sum.0 += weight * area * *p;
            sum.1 += weight * area;
        }
    }
    sums.into_iter().filter(|(_, (_, w))| *w > 0.0).map(|(node, (sum, w))| (node, sum / w)).collect()
}
