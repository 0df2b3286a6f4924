//! What is kept of a simulation: the arrays of a sample of a dataset.
//!
//! ```text
//! d = M⁻¹ x − X
//! ```
//!
//! Offsets `d` of the skin are taken to the rest pose, so that they do not turn with the bones: `X` is a point at rest,
//! `x` where the flesh has it, `M` its skinning matrix.

use super::Simulation;
use super::settle::Settled;
use crate::Model;
use crate::dataset::ArrayInfo;
use crate::fem::newton::Equilibrium;
use glam::{DMat4, DVec3};
use sinew::math::digest::Digest;

/// Arrays of one sample, being filled frame by frame.
#[derive(Clone, Debug, PartialEq)]
pub struct Record {
    /// Numbers of each of [`arrays`], in their order.
    pub arrays: Vec<Vec<f32>>,
    /// Frames that did not come to an end.
    pub failed: usize,
}

/// What each frame has: name, dimensions, unit.
#[must_use]
pub fn arrays(flesh: &Simulation<'_>, gradients: bool, motion: bool) -> Vec<ArrayInfo> {
    let count = |n: usize| n as u64;
    let nodes = count(flesh.model.nodes.len());
    let mut all = vec![
        ("rotations", vec![nodes, 4], "1"),
        ("translations", vec![nodes, 3], "m"),
        ("skin", vec![count(flesh.body.surface.points.len()), 3], "m"),
        ("nodes", vec![count(flesh.body.cage.rest.len()), 3], "m"),
        ("energies", vec![3], "J"),
        ("status", vec![3], "1"),
    ];
    if gradients {
        all.push(("gradients", vec![count(flesh.elements.len()), 9], "1"));
    }
    let info = |(name, mut shape, unit): (&str, Vec<u64>, &str)| {
        if motion {
            shape.insert(0, 0);
        }
        ArrayInfo::new(name, &shape, unit)
    };
    all.into_iter().map(info).collect()
}

impl Record {
    /// Nothing yet, of as many arrays as [`arrays`] gives.
    #[must_use]
    pub fn new(gradients: bool) -> Self {
        Self { arrays: vec![Vec::new(); if gradients { 7 } else { 6 }], failed: 0 }
    }

    /// Appends what the flesh is now, and how it came there.
    pub fn add(&mut self, flesh: &Simulation<'_>, settled: &Settled) {
        let Equilibrium { converged, inverted, .. } = settled.equilibrium;
        self.failed += usize::from(!converged);
        let mut floats = [const { Vec::new() }; 7];
        floats[0].extend(flesh.pose.rotations.iter().flat_map(|q| q.to_array()));
        floats[1].extend(flesh.pose.translations.iter().flat_map(|t| t.to_array()));
        floats[2].extend(offsets(flesh).iter().flat_map(|d| d.to_array()));
        floats[3].extend(flesh.nodes().iter().flat_map(|x| x.to_array()));
        floats[4].extend(flesh.energies());
        #[allow(clippy::cast_precision_loss, reason = "counts")]
        floats[5].extend([f64::from(u8::from(converged)), inverted as f64, settled.iterations as f64]);
        if self.arrays.len() > 6 {
            floats[6].extend(flesh.deformations().iter().flat_map(|f| f.to_cols_array()));
        }
        #[allow(clippy::cast_possible_truncation, reason = "samples are f32")]
        for (array, floats) in self.arrays.iter_mut().zip(floats) {
            array.extend(floats.into_iter().map(|x| x as f32));
        }
    }
}

/// Offsets of the skin's points from skinning, taken to the rest pose, m. Where skinning has no inverse, in the very
/// fold of a joint, they are what they are in the pose.
#[must_use]
pub fn offsets(flesh: &Simulation<'_>) -> Vec<DVec3> {
    let skinning = flesh.skinning();
    let of = |((m, x), rest): ((&DMat4, DVec3), &DVec3)| {
        let d = m.inverse().transform_point3(x) - *rest;
        if d.is_finite() { d } else { x - m.transform_point3(*rest) }
    };
    skinning.iter().zip(flesh.skin()).zip(&flesh.body.surface.points).map(of).collect()
}

/// Digest of all of a character that a simulation depends on, hexadecimal.
#[must_use]
pub fn character(model: &Model) -> String {
    let mut digest = Digest::default();
    let number = |x: f64| x.to_le_bytes();
    for node in &model.nodes {
        digest.bytes(&node.parent.map_or(u64::MAX, |p| p as u64).to_le_bytes());
        let local = node.parent_from_node().to_cols_array();
        local.iter().for_each(|x| digest.bytes(&number(*x)));
    }
    for joint in &model.joints {
        digest.bytes(&(joint.node as u64).to_le_bytes());
        joint.joint_from_bind.to_cols_array().iter().for_each(|x| digest.bytes(&number(*x)));
    }
    for p in &model.primitives {
        digest.vectors(&p.positions);
        p.indices.iter().for_each(|t| digest.bytes(bytemuck::cast_slice(t)));
        digest.bytes(bytemuck::cast_slice(&p.joints));
        digest.floats(&p.weights);
        p.painted.iter().for_each(|painted| digest.floats(painted));
    }
    format!("{:016x}", digest.finish())
}
