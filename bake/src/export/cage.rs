//! A cage as a GLB file that any viewer shows: its outer edges as lines around the skin.

use super::glb::Builder;
use crate::Error;
use crate::cage::Body;
use crate::pack::narrow;
use glam::DVec3;
use serde_json::{Map, json};

/// Linear colors of nodes that are fixed, pulled and free.
const COLORS: [[f32; 3]; 3] = [[0.02, 0.10, 0.55], [0.05, 0.40, 0.15], [0.75, 0.15, 0.02]];

/// The skin and the edges of the cage, in the colors of what holds each node: blue is fixed, green is pulled, orange is
/// free.
///
/// # Errors
///
/// [`Error::Unusable`] for more than 4 GiB.
pub fn to_glb(body: &Body) -> Result<Vec<u8>, Error> {
    let mut b = Builder::default();
    let mut root = Map::new();
    let place = |p: &DVec3| p.to_array().map(narrow);
    let points: Vec<[f32; 3]> = body.surface.points.iter().map(place).collect();
    let attributes = json!({"POSITION": b.positions(&points), "NORMAL": b.vertices(&normals(body))});
    let skin =
        json!({"attributes": attributes, "indices": b.triangles(&body.surface.triangles), "material": 0});
    let nodes: Vec<[f32; 3]> = body.cage.rest.iter().map(place).collect();
    let colors: Vec<[f32; 3]> = body.holds().into_iter().map(color).collect();
    let attributes = json!({"POSITION": b.positions(&nodes), "COLOR_0": b.vertices(&colors)});
    let cage = json!({"attributes": attributes, "indices": b.lines(&edges(body)), "mode": 1, "material": 1});
    let clay =
        json!({"baseColorFactor": [0.66, 0.60, 0.55, 1.0], "metallicFactor": 0.0, "roughnessFactor": 0.75});
    let materials = json!([
        {"name": "skin", "pbrMetallicRoughness": clay, "doubleSided": true},
        {"name": "cage", "extensions": {"KHR_materials_unlit": {}}},
    ]);
    root.insert("extensionsUsed".into(), json!(["KHR_materials_unlit"]));
    root.insert("materials".into(), materials);
    root.insert("meshes".into(), json!([{"primitives": [skin]}, {"primitives": [cage]}]));
    root.insert("nodes".into(), json!([{"name": body.surface.name, "mesh": 0}, {"name": "cage", "mesh": 1}]));
    root.insert("scenes".into(), json!([{"nodes": [0, 1]}]));
    b.finish(root)
}

fn color(hold: f64) -> [f32; 3] {
    COLORS[if hold >= 1.0 {
        0
    } else if hold > 0.0 {
        1
    } else {
        2
    }]
}

/// Edges of the cage's outer triangles, each once.
fn edges(body: &Body) -> Vec<[u32; 2]> {
    let faces = body.cage.boundary(&body.cage.tets);
    let sides = faces.iter().flat_map(|[a, b, c]| [[*a, *b], [*b, *c], [*c, *a]]);
    let mut edges: Vec<[u32; 2]> = sides.map(|[a, b]| [a.min(b), a.max(b)]).collect();
    edges.sort_unstable();
    edges.dedup();
    edges
}

/// Unit normals of points, by the areas around them.
fn normals(body: &Body) -> Vec<[f32; 3]> {
    let points = &body.surface.points;
    let mut sums = vec![DVec3::ZERO; points.len()];
    for t in &body.surface.triangles {
        let [a, b, c] = t.map(|i| points[i as usize]);
        let area = (b - a).cross(c - a);
        t.iter().for_each(|i| sums[*i as usize] += area);
    }
    sums.into_iter().map(|n| n.normalize_or(DVec3::Y).to_array().map(narrow)).collect()
}
