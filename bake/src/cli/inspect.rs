//! `sinew inspect`.

use super::{Outcome, kilobytes, load};
use serde_json::{Value, json};
use sinew::Character;
use sinew_bake::{Error, pack};
use std::path::Path;

pub(super) fn run(file: &Path) -> Result<Outcome, Error> {
    let head = if file.exists() { load::read(file)? } else { Vec::new() };
    let json = match head.first_chunk() {
        Some(b"SINW") => asset(file, &head)?,
        Some(b"SNRP") => super::verify::inspect(file, &head)?,
        _ => character(file)?,
    };
    let lines = match &json {
        Value::Object(fields) => fields.iter().map(|(k, v)| format!("{k:12} {}", plain(v))).collect(),
        other => vec![other.to_string()],
    };
    Ok(Outcome { json, lines, ok: true })
}

fn plain(v: &Value) -> String {
    match v {
        Value::String(s) => s.clone(),
        Value::Array(a) => a.iter().map(plain).collect::<Vec<_>>().join(", "),
        other => other.to_string(),
    }
}

fn asset(file: &Path, bytes: &[u8]) -> Result<Value, Error> {
    let aligned = pack::align(bytes);
    let asset = load::parse(file, &aligned)?;
    let m = &asset.meta;
    let clips: Vec<String> = (0..m.clips as usize)
        .filter_map(|i| asset.clip(i))
        .map(|c| format!("{} ({:.2} s)", c.name, c.duration))
        .collect();
    let regions: Vec<String> = asset
        .regions
        .iter()
        .enumerate()
        .map(|(i, r)| format!("{}: {} Hz, damping {}, gain {}", asset.region_name(i), r[0], r[1], r[2]))
        .collect();
    Ok(json!({
        "kind": "sinew asset", "hash": format!("{:016x}", asset.hash), "size": kilobytes(bytes.len()),
        "memory": kilobytes(4 * Character::required_len(&asset)),
        "vertices": m.vertices, "points": m.points, "active": m.active, "joints": m.joints,
        "influences": m.stride, "body_size": m.body_size, "regions": regions, "clips": clips,
    }))
}

fn character(file: &Path) -> Result<Value, Error> {
    let model = load::character(file)?;
    let positions = model.rest_positions();
    let low = positions.iter().copied().reduce(glam::DVec3::min).unwrap_or_default();
    let high = positions.iter().copied().reduce(glam::DVec3::max).unwrap_or_default();
    let clips: Vec<String> =
        model.clips.iter().map(|c| format!("{} ({:.2} s)", c.name, c.duration)).collect();
    let triangles: usize = model.primitives.iter().map(|p| p.indices.len()).sum();
    let stride = model.primitives.iter().map(|p| p.stride).max();
    Ok(json!({
        "kind": "character", "name": model.name, "nodes": model.nodes.len(), "joints": model.joints.len(),
        "primitives": model.primitives.len(), "rigid": model.rigid.len(), "vertices": model.vertex_count(),
        "triangles": triangles, "influences": stride, "from": low.to_array(), "to": high.to_array(),
        "morphs": model.primitives.iter().any(|p| p.morphs), "clips": clips,
        "painted": model.primitives.iter().any(|p| p.painted.is_some()),
        "vrm": model.vrm.as_ref().map(|v| v.major_version),
    }))
}
