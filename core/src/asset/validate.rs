//! Checks of the content: after them every index is in range and every number usable.

use super::layout::{MAX_REGIONS, NO_PARENT};
use super::{Asset, AssetError, Section, text};
use crate::kernel::tiny::is_flushed;
use core::ops::RangeInclusive;

type Check = Result<(), AssetError>;

/// Fails at the first entry that does not pass.
fn each<T>(section: Section, entries: &[T], valid: impl Fn(usize, &T) -> bool) -> Check {
    match entries.iter().enumerate().position(|(i, entry)| !valid(i, entry)) {
        None => Ok(()),
        Some(index) => Err(AssetError::Invalid { section, index: u32::try_from(index).unwrap_or(u32::MAX) }),
    }
}

/// Whether `x` is in a range and none too small to matter ([`crate::kernel::tiny`]).
fn inside(x: &[f32], range: RangeInclusive<f32>) -> bool {
    x.iter().all(|x| range.contains(x) && is_flushed(*x))
}

/// Whether coordinates can be multiplied and squared without overflow.
fn usable(x: &[f32]) -> bool {
    inside(x, -1e9..=1e9)
}

fn unit(n: &[f32]) -> bool {
    let square: f32 = n.iter().map(|x| x * x).sum();
    usable(n) && square > 0.9 && square < 1.1
}

/// All checks.
pub(super) fn validate(asset: &Asset<'_>) -> Check {
    meta(asset)?;
    points(asset)?;
    surface(asset)?;
    skeleton(asset)?;
    clips(asset)
}

fn meta(asset: &Asset<'_>) -> Check {
    let m = &asset.meta;
    let counts = m.active <= m.points
        && m.points <= m.vertices
        && (4..=252).contains(&m.stride)
        && m.stride.is_multiple_of(4)
        && (1..=MAX_REGIONS as u64).contains(&m.regions.into())
        && m.joints > 0
        && m.joints <= 1 << 16
        && m.vertices < 1 << 28
        && m.values < 1 << 28
        && m.nodes < 1 << 24;
    // Their product is an acceleration, which unsprung points add up from frame to frame.
    let constants = inside(&m.bind_down, -1e6..=1e6)
        && m.body_size > 1e-12
        && m.body_size < 1e9
        && inside(&[m.gravity], 0.0..=1e4);
    each(Section::Meta, &[counts, constants], |_, valid| *valid)
}

fn points(asset: &Asset<'_>) -> Check {
    let joints = asset.meta.joints;
    each(Section::Rest, asset.rest, |_, p| usable(p))?;
    each(Section::InfluenceJoints, asset.influences.joints.as_flattened(), |_, j| u32::from(*j) < joints)?;
    let sets = asset.influences.sets.max(1);
    let row = |sets: &[[f32; 4]]| {
        let row = sets.as_flattened();
        let falling = row.is_sorted_by(|a, b| a >= b) && inside(row, 0.0..=1.0);
        let sum: f32 = row.iter().sum();
        falling && (sum - 1.0).abs() < 1e-3
    };
    for (i, weights) in asset.influences.weights.chunks_exact(sets).enumerate() {
        if !row(weights) {
            let index = u32::try_from(i).unwrap_or(u32::MAX);
            return Err(AssetError::Invalid { section: Section::InfluenceWeights, index });
        }
    }
    each(Section::RegionOfPoint, asset.region_of_point, |_, r| u32::from(*r) < asset.meta.regions)?;
    each(Section::Softness, asset.softness, |_, s| inside(&[*s], 0.0..=1.0))?;
    let tuning = |[frequency, damping, gain, limit]: [f32; 4]| {
        inside(&[frequency], 0.0..=60.0)
            && inside(&[damping, gain], 0.0..=100.0)
            && inside(&[limit], 1e-6..=100.0)
    };
    each(Section::Regions, asset.regions, |_, r| tuning(*r))?;
    let names = |_, n: &[u8; 16]| text_is_padded(n);
    each(Section::RegionNames, asset.region_names, names)
}

fn text_is_padded(bytes: &[u8]) -> bool {
    let end = bytes.iter().position(|b| *b == 0).unwrap_or(bytes.len());
    bytes.iter().skip(end).all(|b| *b == 0) && text(bytes).len() == end
}

fn surface(asset: &Asset<'_>) -> Check {
    let m = &asset.meta;
    each(Section::PointOfVertex, asset.point_of_vertex, |_, p| *p < m.points)?;
    each(Section::Normals, asset.normals, |_, n| unit(n))?;
    let active = |v: &u32| asset.point_of_vertex.get(*v as usize).is_some_and(|p| *p < m.active);
    each(Section::Moved, asset.moved, |_, v| active(v))?;
    each(Section::Lit, asset.stencils.vertices, |_, v| *v < m.vertices)?;
    each(Section::StencilPoints, asset.stencils.points, |_, p| p.iter().all(|p| *p < m.points))?;
    each(Section::StencilTangents, asset.stencils.tangents, |_, g| usable(g.as_flattened()))?;
    each(Section::Primitives, asset.primitives, |_, [_, _, _, first, count, zero]| {
        first.checked_add(*count).is_some_and(|end| end <= m.vertices) && *zero == 0
    })
}

fn skeleton(asset: &Asset<'_>) -> Check {
    let nodes = asset.meta.nodes;
    each(Section::JointFromBind, asset.joint_from_bind, |_, m| usable(m.as_flattened()))?;
    each(Section::JointNode, asset.joint_node, |_, n| *n < nodes)?;
    each(Section::Parents, asset.parents, |i, p| *p == NO_PARENT || (*p as usize) < i)?;
    each(Section::NodeRest, asset.node_rest, |_, trs| {
        let [_, _, _, x, y, z, w, ..] = *trs;
        usable(trs) && unit(&[x, y, z, w])
    })
}

fn clips(asset: &Asset<'_>) -> Check {
    let channels = &asset.channels;
    each(Section::Clips, asset.clips, |i, [_, _, duration, zero]| {
        let duration = f32::from_bits(*duration);
        asset.clip(i).is_some() && inside(&[duration], 0.0..=1e9) && *zero == 0
    })?;
    each(Section::ClipNames, asset.clip_names, |_, n| text_is_padded(n))?;
    each(Section::Values, channels.values, |_, v| (-1e9..=1e9).contains(v))?;
    each(Section::Times, channels.times, |_, t| usable(&[*t]))?;
    each(Section::Channels, channels.rows, |_, row| {
        channels.channel(row).is_some_and(|(node, _, keys)| {
            node < asset.parents.len() && keys.times.is_sorted_by(|a, b| a < b)
        })
    })
}
