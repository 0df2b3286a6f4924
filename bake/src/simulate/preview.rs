//! Frames to look at of samples of a dataset.

use super::job::{Job, Work};
use super::{Simulation, blended};
use crate::cage::STRAY;
use crate::dataset::Sample;
use crate::pack::narrow;
use crate::play::Frame;
use crate::pose::Pose;
use glam::{DMat4, DQuat, DVec3};
use sinew::Root;

/// Frames of a sample: one of an equilibrium, all of a motion; numbers go on from `first`.
///
/// Nothing is simulated for them: they are what the file says.
#[must_use]
pub fn frames(job: &Job<'_>, flesh: &Simulation<'_>, sample: &Sample, first: u32) -> Vec<Frame> {
    let counts = [4 * job.model.nodes.len(), 3 * job.model.nodes.len(), 3 * job.body.surface.points.len()];
    let [rotations, translations, skin] = [0, 1, 2].map(|k| sample.arrays[k].chunks_exact(counts[k].max(1)));
    let rate = if let Work::Motions { rate, .. } = job.work { rate } else { 1.0 };
    let vectors = |x: &[f32]| -> Vec<DVec3> {
        x.as_chunks().0.iter().map(|v| DVec3::from_array(v.map(f64::from))).collect()
    };
    let turn = |q: &[f32; 4]| DQuat::from_array(q.map(f64::from)).normalize();
    let mut frames = Vec::new();
    for (k, ((r, t), d)) in (0_u32..).zip(rotations.zip(translations).zip(skin)) {
        let pose = Pose { rotations: r.as_chunks().0.iter().map(turn).collect(), translations: vectors(t) };
        let (index, time) = (first + k, narrow(f64::from(k) / rate));
        frames.push(Frame { index, time, ..draw(job, flesh, &pose, &vectors(d)) });
    }
    frames
}

/// A pose with offsets of the skin, as it is drawn.
fn draw(job: &Job<'_>, flesh: &Simulation<'_>, pose: &Pose, offsets: &[DVec3]) -> Frame {
    let surface = &job.body.surface;
    let skinning = blended(&flesh.moved(pose), &surface.weights);
    let at = |d: f64| -> Vec<DVec3> {
        let places = skinning.iter().zip(&surface.points).zip(offsets);
        places.map(|((m, p), o)| m.transform_point3(*p + d * *o)).collect()
    };
    let (skinned, fleshed) = (at(0.0), at(1.0));
    let heat: Vec<f64> = skinned.iter().zip(&fleshed).map(|(a, b)| a.distance(*b) / surface.size).collect();
    // Vertices without a triangle are not seen.
    let of =
        |v: &[DVec3], i: &u32| if *i == STRAY { [0.0; 3] } else { v[*i as usize].to_array().map(narrow) };
    let spread = |v: &[DVec3]| surface.point_of.iter().map(|i| of(v, i)).collect();
    let nodes = pose.transforms(job.model);
    Frame {
        index: 0,
        time: 0.0,
        flesh_normals: spread(&normals(&surface.triangles, &fleshed)),
        skinned_normals: spread(&normals(&surface.triangles, &skinned)),
        flesh: spread(&fleshed),
        skinned: spread(&skinned),
        heat: surface
            .point_of
            .iter()
            .map(|i| if *i == STRAY { 0.0 } else { narrow(heat[*i as usize]) })
            .collect(),
        root: Root::default(),
        rigid: job
            .model
            .rigid
            .iter()
            .map(|r| nodes.get(r.node).copied().unwrap_or(DMat4::IDENTITY))
            .collect(),
    }
}

/// Normals of points: those of their triangles, by area.
fn normals(triangles: &[[u32; 3]], points: &[DVec3]) -> Vec<DVec3> {
    let mut sums = vec![DVec3::ZERO; points.len()];
    for t in triangles {
        let [a, b, c] = t.map(|i| points[i as usize]);
        t.iter().for_each(|i| sums[*i as usize] += (b - a).cross(c - a));
    }
    sums.into_iter().map(DVec3::normalize_or_zero).collect()
}
