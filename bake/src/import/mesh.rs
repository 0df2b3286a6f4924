//! Triangle meshes: skinned ones, and rigid ones that hang on a node.

use glam::DVec3;
use gltf::json::mesh::{Mode, Primitive as JsonPrimitive, Semantic};
use gltf::json::validation::Checked;
use gltf::json::{Accessor, Index};

use super::influences::{self, Influences};
use super::source::{Source, label};
use super::{material, normal};
use crate::Error;
use crate::model::{Primitive, RigidPrimitive};

/// What skinned and rigid meshes have in common.
#[derive(Debug)]
struct Surface {
    positions: Vec<[f32; 3]>,
    normals: Vec<[f32; 3]>,
    uvs: Vec<[f32; 2]>,
    indices: Vec<[u32; 3]>,
    material: Option<usize>,
}

/// The meshes of all shown nodes; `rows` are the model's joints of each skin.
pub(super) fn read(
    source: &Source<'_>,
    shown: &[bool],
    rows: &[Vec<u16>],
) -> Result<(Vec<Primitive>, Vec<RigidPrimitive>), Error> {
    let (mut skinned, mut rigid) = (Vec::new(), Vec::new());
    for (index, node) in source.root.nodes.iter().enumerate().filter(|(index, _)| shown[*index]) {
        let Some(mesh_index) = node.mesh else { continue };
        let place = label("node", index, node.name.as_ref());
        let mesh = source.get(&source.root.meshes, mesh_index, "mesh", &place)?;
        let rows = match node.skin {
            Some(skin) => {
                source.get(&source.root.skins, skin, "skin", &place)?;
                rows.get(skin.value())
            }
            None => None,
        };
        for (number, json) in mesh.primitives.iter().enumerate() {
            let mesh_label = label("mesh", mesh_index.value(), mesh.name.as_ref());
            let place = format!("{mesh_label}, primitive {number}");
            let Some(surface) = surface(source, json, &place)? else { continue };
            let influences = match rows {
                Some(rows) => influences(source, json, surface.positions.len(), rows, &place)?,
                None => None,
            };
            match influences {
                Some(influences) => {
                    let painted = painted(source, json, surface.positions.len(), &place)?;
                    let ids = [index, mesh_index.value(), number];
                    skinned.push(skinned_primitive(
                        ids,
                        surface,
                        influences,
                        painted,
                        json.targets.is_some(),
                    ));
                }
                None => rigid.push(rigid_primitive(index, surface)),
            }
        }
    }
    Ok((skinned, rigid))
}

fn skinned_primitive(
    [node, mesh, primitive]: [usize; 3],
    surface: Surface,
    influences: Influences,
    painted: Option<Vec<f32>>,
    morphs: bool,
) -> Primitive {
    let Surface { positions, normals, uvs, indices, material } = surface;
    let Influences { stride, joints, weights } = influences;
    Primitive {
        node,
        mesh,
        primitive,
        positions,
        normals,
        uvs,
        stride,
        joints,
        weights,
        indices,
        painted,
        morphs,
        material,
    }
}

fn rigid_primitive(node: usize, surface: Surface) -> RigidPrimitive {
    let Surface { positions, normals, uvs, indices, material } = surface;
    RigidPrimitive { node, positions, normals, uvs, indices, material }
}

fn attribute(json: &JsonPrimitive, semantic: Semantic) -> Option<Index<Accessor>> {
    json.attributes.get(&Checked::Valid(semantic)).copied()
}

/// Vertices and triangles; `None` for points, lines and empty primitives.
fn surface(source: &Source<'_>, json: &JsonPrimitive, place: &str) -> Result<Option<Surface>, Error> {
    let Checked::Valid(mode) = json.mode else {
        return Err(source.damaged(place, "its mode is unknown"));
    };
    let (Mode::Triangles | Mode::TriangleStrip | Mode::TriangleFan) = mode else { return Ok(None) };
    let Some(accessor) = attribute(json, Semantic::Positions) else { return Ok(None) };
    let positions: Vec<[f32; 3]> = source.floats(accessor, &format!("{place}, POSITION"))?;
    if let Some(vertex) = positions.iter().position(|p| !p.iter().all(|x| x.is_finite())) {
        let place = format!("{place}, vertex {vertex}");
        return Err(source.error(place, "its position is not finite", "repair the mesh where it was made"));
    }
    let indices = triangles(source, json, mode, positions.len(), place)?;
    if indices.is_empty() {
        return Ok(None);
    }
    if let Some(material) = json.material {
        source.get(&source.root.materials, material, "material", place)?;
    }
    let normals = normals(source, json, &positions, &indices, place)?;
    let uvs = uvs(source, json, positions.len(), place)?;
    let material = json.material.map(|m| m.value());
    Ok(Some(Surface { positions, normals, uvs, indices, material }))
}

/// The file's indices as triangles, with the winding that `mode` says.
fn triangles(
    source: &Source<'_>,
    json: &JsonPrimitive,
    mode: Mode,
    vertices: usize,
    place: &str,
) -> Result<Vec<[u32; 3]>, Error> {
    let corners: Vec<u32> = match json.indices {
        Some(accessor) => source.integers::<1>(accessor, &format!("{place}, indices"))?.into_flattened(),
        // Accessors count to u32::MAX at most.
        None => (0..u32::try_from(vertices).unwrap_or(u32::MAX)).collect(),
    };
    if let Some(corner) = corners.iter().position(|v| *v as usize >= vertices) {
        let problem = format!("index {corner} refers to vertex {} of {vertices}", corners[corner]);
        return Err(source.damaged(place, problem));
    }
    source.charge(3 * corners.len() as u64, place)?;
    // Strips are joined by triangles without area.
    let has_area = |t: &[u32; 3]| t[0] != t[1] && t[1] != t[2] && t[2] != t[0];
    Ok(match mode {
        Mode::TriangleStrip => {
            let windows = corners.windows(3).enumerate();
            windows
                .map(|(i, t)| if i % 2 == 0 { [t[0], t[1], t[2]] } else { [t[1], t[0], t[2]] })
                .filter(has_area)
                .collect()
        }
        Mode::TriangleFan => {
            let edges = corners.get(1..).unwrap_or_default().windows(2);
            edges.map(|edge| [corners[0], edge[0], edge[1]]).filter(has_area).collect()
        }
        _ => corners.as_chunks().0.to_vec(),
    })
}

/// The file's normals, made unit; computed where the file has none or one has no direction.
fn normals(
    source: &Source<'_>,
    json: &JsonPrimitive,
    positions: &[[f32; 3]],
    triangles: &[[u32; 3]],
    place: &str,
) -> Result<Vec<[f32; 3]>, Error> {
    let Some(accessor) = attribute(json, Semantic::Normals) else {
        return Ok(normal::smooth(positions, triangles));
    };
    let place = &format!("{place}, NORMAL");
    let given: Vec<[f32; 3]> = source.floats(accessor, place)?;
    require_count(source, given.len(), positions.len(), place)?;
    let unit: Vec<_> = given.iter().map(|n| normal::to_unit(DVec3::from_array(n.map(f64::from)))).collect();
    if unit.iter().all(Option::is_some) {
        return Ok(unit.into_iter().flatten().collect());
    }
    let computed = normal::smooth(positions, triangles);
    Ok(unit.into_iter().zip(computed).map(|(given, computed)| given.unwrap_or(computed)).collect())
}

/// Texture coordinates that the material's base color uses, with its texture transform; empty if there are none.
fn uvs(
    source: &Source<'_>,
    json: &JsonPrimitive,
    vertices: usize,
    place: &str,
) -> Result<Vec<[f32; 2]>, Error> {
    let texture = material::base_color_texture(source, json.material);
    let set = texture.map_or(0, material::uv_set);
    let Some(accessor) = attribute(json, Semantic::TexCoords(set)) else { return Ok(Vec::new()) };
    let place = &format!("{place}, TEXCOORD_{set}");
    let mut uvs: Vec<[f32; 2]> = source.floats(accessor, place)?;
    require_count(source, uvs.len(), vertices, place)?;
    if let Some(texture) = texture {
        material::transform_uvs(texture, &mut uvs);
    }
    // A broken coordinate spoils a picture, not the flesh.
    for x in uvs.as_flattened_mut().iter_mut().filter(|x| !x.is_finite()) {
        *x = 0.0;
    }
    Ok(uvs)
}

/// Joints and weights of all sets; `None` if the primitive has none, so that it only follows its node.
fn influences(
    source: &Source<'_>,
    json: &JsonPrimitive,
    vertices: usize,
    rows: &[u16],
    place: &str,
) -> Result<Option<Influences>, Error> {
    let mut sets = Vec::new();
    for set in 0_u32.. {
        let accessors = (attribute(json, Semantic::Joints(set)), attribute(json, Semantic::Weights(set)));
        let (joints, weights) = match accessors {
            (Some(joints), Some(weights)) => (joints, weights),
            (None, None) => break,
            _ => {
                return Err(
                    source.damaged(place, format!("it has one of JOINTS_{set} and WEIGHTS_{set} only"))
                );
            }
        };
        let joints_place = format!("{place}, JOINTS_{set}");
        let joints = source.integers(joints, &joints_place)?;
        require_count(source, joints.len(), vertices, &joints_place)?;
        let weights_place = format!("{place}, WEIGHTS_{set}");
        let weights = source.floats(weights, &weights_place)?;
        require_count(source, weights.len(), vertices, &weights_place)?;
        sets.push((joints, weights));
    }
    if sets.is_empty() {
        return Ok(None);
    }
    influences::join(source, &sets, vertices, rows, place).map(Some)
}

/// The painted softness, cut to `0..=1`.
fn painted(
    source: &Source<'_>,
    json: &JsonPrimitive,
    vertices: usize,
    place: &str,
) -> Result<Option<Vec<f32>>, Error> {
    let Some(accessor) = attribute(json, Semantic::Extras("SINEW".to_owned())) else { return Ok(None) };
    let place = &format!("{place}, _SINEW");
    let painted = source.first_floats(accessor, place)?;
    require_count(source, painted.len(), vertices, place)?;
    if let Some(vertex) = painted.iter().position(|x| x.is_nan()) {
        return Err(source.error(format!("{place}, vertex {vertex}"), "it is not a number", "paint it anew"));
    }
    Ok(Some(painted.into_iter().map(|x| x.clamp(0.0, 1.0)).collect()))
}

fn require_count(source: &Source<'_>, count: usize, vertices: usize, place: &str) -> Result<(), Error> {
    if count == vertices {
        return Ok(());
    }
    Err(source.damaged(place, format!("{count} elements for {vertices} vertices")))
}
