//! How deep flesh lies over its bones.
//!
//! For a point `p` of joint `j` with bone segments `b`,
//!
//! ```text
//! d = distance(p, b)                       depth, body sizes
//! ρ = d / r,   r = 40th percentile of d over the joint's points      1 on a limb, 2 on a belly, 3 on an ear
//! softness = max( L(ρ; 1.15, 3.3) · S(d; 0.025, 0.11),  ½·S(d; 0.085, 0.17) ),     L a ramp, S the smooth step
//! ```
//!
//! A joint without children has the segment to the middle of its points: a skull is round about it,
//! an ear is not. Points that stand on the ground are bony.

use super::surface::Surface;
use crate::Model;
use glam::DVec3;

/// A bone segment, model space.
type Segment = (DVec3, DVec3);

/// Softness of every point before smoothing.
pub(super) fn softness(model: &Model, surface: &Surface) -> Vec<f64> {
    let bones = Bones::new(model, surface);
    let depth: Vec<f64> = (0..surface.points.len()).map(|i| bones.depth(surface, i)).collect();
    let radius = bones.radii(surface, &depth);
    let ground = surface.points.iter().map(|p| p.y).fold(f64::INFINITY, f64::min);
    let mut out: Vec<f64> = (0..depth.len())
        .map(|i| {
            let r: f64 = surface.weights[i].iter().map(|(j, w)| w * radius[*j]).sum();
            let ratio = depth[i] / r.max(1e-6);
            let height = (surface.points[i].y - ground) / surface.size;
            smooth_step(1.15, 2.2, ratio)
                * smooth_step(0.025, 0.11, depth[i])
                * smooth_step(0.02, 0.08, height)
        })
        .collect();
    if out.iter().copied().fold(0.0, f64::max) < 0.15 {
        out = reach(model, surface, &bones);
    }
    out
}

/// For tubes and toys without any depth: softness grows with the distance from the root joint.
fn reach(model: &Model, surface: &Surface, bones: &Bones) -> Vec<f64> {
    let root = bones.root(model);
    let distance: Vec<f64> = surface.points.iter().map(|p| (*p - root).length()).collect();
    let most = distance.iter().copied().fold(0.0, f64::max);
    distance.iter().map(|d| smooth_step(0.5, 1.0, d / most.max(1e-9 * surface.size))).collect()
}

/// 0 below `low`, 1 above `high`, C¹ between.
fn smooth_step(low: f64, high: f64, x: f64) -> f64 {
    let t = ((x - low) / (high - low)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

struct Bones {
    /// Position of each joint.
    joints: Vec<DVec3>,
    /// Segments of each joint: to its children, or to the middle of what it moves.
    segments: Vec<Vec<Segment>>,
}

impl Bones {
    fn new(model: &Model, surface: &Surface) -> Self {
        let nodes = model.rest_transforms();
        let joints: Vec<DVec3> = model.joints.iter().map(|j| nodes[j.node].w_axis.truncate()).collect();
        let mut segments: Vec<Vec<Segment>> = vec![Vec::new(); joints.len()];
        for (child, joint) in model.joints.iter().enumerate() {
            if let Some(parent) = joint_above(model, joint.node) {
                for (j, _) in model.joints.iter().enumerate().filter(|(_, j)| j.node == parent) {
                    segments[j].push((joints[j], joints[child]));
                }
            }
        }
        let mut sums = vec![(DVec3::ZERO, 0.0); joints.len()];
        for (i, p) in surface.points.iter().enumerate() {
            let (sum, n) = &mut sums[surface.dominant(i)];
            (*sum, *n) = (*sum + *p, *n + 1.0);
        }
        for (j, segments) in segments.iter_mut().enumerate() {
            if segments.is_empty() {
                let (sum, n) = sums[j];
                segments.push((joints[j], if n > 0.0 { sum / n } else { joints[j] }));
            }
        }
        Self { joints, segments }
    }

    /// Distance of a point from the bones of its joints, body sizes.
    fn depth(&self, surface: &Surface, i: usize) -> f64 {
        let p = surface.points[i];
        let near = |j: usize| self.segments[j].iter().map(|s| distance(p, *s)).fold(f64::INFINITY, f64::min);
        let joints = surface.weights[i].iter().filter(|(_, w)| *w > 0.15);
        let least = joints.map(|(j, _)| near(*j)).fold(f64::INFINITY, f64::min);
        if least.is_finite() { least / surface.size } else { 0.0 }
    }

    /// Bony radius of each joint, body sizes.
    fn radii(&self, surface: &Surface, depth: &[f64]) -> Vec<f64> {
        let mut of_joint = vec![Vec::new(); self.joints.len()];
        for (i, d) in depth.iter().enumerate() {
            of_joint[surface.dominant(i)].push(*d);
        }
        let percentile = |mut d: Vec<f64>| {
            d.sort_by(f64::total_cmp);
            d.get(d.len() * 2 / 5).copied().unwrap_or(0.0)
        };
        of_joint.into_iter().map(percentile).collect()
    }

    /// Position of the first joint without a joint above it.
    fn root(&self, model: &Model) -> DVec3 {
        let first = model.joints.iter().position(|j| joint_above(model, j.node).is_none());
        self.joints[first.unwrap_or(0)]
    }
}

/// Nearest node above `node` that is a joint.
pub(super) fn joint_above(model: &Model, node: usize) -> Option<usize> {
    let mut at = model.nodes[node].parent;
    let mut steps = 0;
    while let Some(parent) = at {
        if model.joints.iter().any(|j| j.node == parent) {
            return Some(parent);
        }
        steps += 1;
        at = if steps > model.nodes.len() { None } else { model.nodes[parent].parent };
    }
    None
}

fn distance(p: DVec3, (a, b): Segment) -> f64 {
    let edge = b - a;
    let square = edge.length_squared();
    let t = if square > 0.0 { ((p - a).dot(edge) / square).clamp(0.0, 1.0) } else { 0.0 };
    (p - (a + edge * t)).length()
}
