//! The asset writer: a [`Model`] and its [`Flesh`] become the bytes that the runtime reads.
//!
//! The reader is `sinew::asset`; both take the order and the lengths of the sections from its one table.

mod points;
mod skeleton;
mod stencils;
mod writer;

use crate::recipe::{Flesh, Region};
use crate::{Error, Model};
use glam::{DMat3, DVec3};
use points::Points;
use sinew::asset::layout::{MAX_REGIONS, Meta};
use sinew::asset::{Asset, AssetError, Section};
use sinew::kernel::tiny::flush_all;
use skeleton::Skeleton;
use writer::{AssetWriter, padded};

/// Gravity under which characters are authored, body sizes per s²: 9.81 m/s² for a body 1.96 m across.
pub const AUTHORED_GRAVITY: f32 = 5.0;

/// Writes the asset of a character.
///
/// `source` is the digest of the file that it came from, 0 where there is none.
///
/// # Errors
///
/// [`Error::Unusable`] for a model that does not fit the format: over 65,536 joints, 255 influences or 4 GiB.
pub fn pack(model: &Model, flesh: &Flesh, source: u64) -> Result<Vec<u8>, Error> {
    let points = Points::new(model, flesh);
    let skeleton = Skeleton::new(model);
    let stencils = stencils::stencils(model, &points);
    let count = |n: usize| u32::try_from(n).unwrap_or(u32::MAX);
    let moved = points.moved();
    let meta = Meta {
        points: count(points.rest.len()),
        active: count(points.active),
        vertices: count(points.of_vertex.len()),
        joints: count(model.joints.len()),
        stride: count(points.stride),
        regions: count(flesh.regions.len().clamp(1, MAX_REGIONS)),
        moved: count(moved.len()),
        lit: count(stencils.vertices.len()),
        nodes: count(skeleton.parents.len()),
        clips: count(skeleton.clips.len()),
        channels: count(skeleton.channels.len()),
        times: count(skeleton.times.len()),
        values: count(skeleton.values.len()),
        primitives: count(model.primitives.len()),
        body_size: narrow(flesh.body_size),
        bind_down: bind_down(model, &points),
        gravity: AUTHORED_GRAVITY,
        source,
    };
    let mut w = AssetWriter::default();
    w.words(Section::Meta, &meta.to_words());
    w.floats(Section::JointFromBind, skeleton.joint_from_bind.as_flattened().as_flattened());
    w.words(Section::JointNode, &skeleton.joint_node);
    w.floats(Section::Rest, points.rest.as_flattened());
    w.halves(Section::InfluenceJoints, &points.joints);
    w.floats(Section::InfluenceWeights, &points.weights);
    w.bytes(Section::RegionOfPoint, &points.region[..points.active]);
    w.floats(Section::Softness, &points.softness[..points.active]);
    w.words(Section::PointOfVertex, &points.of_vertex);
    let normals: Vec<[f32; 3]> = model.primitives.iter().flat_map(|p| p.normals.iter().copied()).collect();
    w.floats(Section::Normals, normals.as_flattened());
    w.words(Section::Moved, &moved);
    w.words(Section::Lit, &stencils.vertices);
    w.words(Section::StencilPoints, stencils.points.as_flattened());
    w.floats(Section::StencilTangents, stencils.tangents.as_flattened().as_flattened());
    write_regions(&mut w, flesh);
    write_primitives(&mut w, model);
    skeleton.write(&mut w);
    let bytes = w.finish(&model.name)?;
    check(&model.name, &bytes)?;
    Ok(bytes)
}

/// Narrows to `f32`, rounding to nearest.
#[allow(clippy::cast_possible_truncation, reason = "rounding is meant")]
pub(crate) fn narrow(x: f64) -> f32 {
    x as f32
}

/// Reads the asset back: what is written can be read.
fn check(name: &str, bytes: &[u8]) -> Result<(), Error> {
    let aligned = align(bytes);
    Asset::parse(bytemuck::cast_slice(&aligned)).map(|_| ()).map_err(|error| misfit(name, error))
}

/// Why a model does not fit the format, in words of the model where its own numbers are too large.
fn misfit(name: &str, error: AssetError) -> Error {
    let what = match error {
        AssetError::Invalid { section: Section::Meta, .. } => "the size of the whole",
        AssetError::Invalid { section: Section::Rest, .. } => "a position",
        AssetError::Invalid { section: Section::JointFromBind, .. } => "an inverse bind matrix",
        AssetError::Invalid { section: Section::NodeRest, .. } => "the transform of a node",
        AssetError::Invalid { section: Section::StencilTangents, .. } => "the bend of the surface",
        AssetError::Invalid { section: Section::Times | Section::Clips, .. } => "the time of a key",
        AssetError::Invalid { section: Section::Values, .. } => "the value of a key",
        other => {
            let problem = format!("the model does not fit the asset format: {other}");
            return Error::unusable(name, "packing", problem, "please report this file").coded(other.code());
        }
    };
    let problem = format!("{what} is beyond what the runtime takes ({error})");
    Error::unusable(
        name,
        "packing",
        problem,
        "apply the model's scale, or remove what is far away or very small",
    )
    .coded(error.code())
}

/// Bytes in memory aligned for [`Asset::parse`]: cast the result back with `bytemuck::cast_slice`.
///
/// A length that is no multiple of 4 is padded with zeros, which the reader refuses as it should.
#[must_use]
pub fn align(bytes: &[u8]) -> Vec<u32> {
    let (words, tail) = bytes.as_chunks::<4>();
    let mut out: Vec<u32> = words.iter().map(|w| u32::from_ne_bytes(*w)).collect();
    if !tail.is_empty() {
        let mut last = [0; 4];
        last[..tail.len()].copy_from_slice(tail);
        out.push(u32::from_ne_bytes(last));
    }
    out
}

fn write_regions(w: &mut AssetWriter, flesh: &Flesh) {
    // A recipe multiplies: to zero, or beyond what the runtime takes.
    let row = |r: &Region| {
        let most = |x: f32, most: f32| x.clamp(0.0, most);
        [
            most(r.frequency, 60.0),
            most(r.damping, 100.0),
            most(r.gain, 100.0),
            r.max_offset.clamp(1e-6, 100.0),
        ]
    };
    let mut rows: Vec<[f32; 4]> = flesh.regions.iter().map(row).collect();
    let mut names: Vec<[u8; 16]> = flesh.regions.iter().map(|r| padded(&r.name)).collect();
    if rows.is_empty() {
        (rows, names) = (vec![[3.0, 0.3, 1.0, 0.1]], vec![padded("none")]);
    }
    rows.truncate(MAX_REGIONS);
    names.truncate(MAX_REGIONS);
    w.floats(Section::Regions, rows.as_flattened());
    w.bytes(Section::RegionNames, names.as_flattened());
}

fn write_primitives(w: &mut AssetWriter, model: &Model) {
    let count = |n: usize| u32::try_from(n).unwrap_or(u32::MAX);
    let mut first = 0;
    let mut rows = Vec::new();
    for p in &model.primitives {
        let vertices = count(p.positions.len());
        rows.extend([count(p.node), count(p.mesh), count(p.primitive), first, vertices, 0]);
        first += vertices;
    }
    w.words(Section::Primitives, &rows);
}

/// Direction of gravity in bind space: what the rest pose's blended matrices turn into `−y`, on average.
fn bind_down(model: &Model, points: &Points) -> [f32; 3] {
    let mut sum = DVec3::ZERO;
    let mut vertex = 0;
    for primitive in &model.primitives {
        for blend in model.rest_blend(primitive) {
            let point = points.of_vertex[vertex] as usize;
            vertex += 1;
            let linear = DMat3::from_mat4(blend);
            let volume = linear.x_axis.length() * linear.y_axis.length() * linear.z_axis.length();
            if (point < points.active || points.active == 0) && linear.determinant().abs() > 1e-6 * volume {
                sum += linear.inverse() * DVec3::NEG_Y;
            }
        }
    }
    let count = if points.active == 0 { points.of_vertex.len() } else { points.moved().len() };
    #[allow(clippy::cast_precision_loss, reason = "counts are below 2^32")]
    let mean = sum / count.max(1) as f64;
    flush_all(mean.to_array().map(narrow))
}
