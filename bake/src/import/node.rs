//! Nodes: hierarchy, rest transforms, and which of them the file shows.

use glam::{DMat3, DMat4, DQuat, DVec3};
use gltf::json::scene;

use super::source::{Source, label};
use crate::Error;
use crate::model::Node;

/// All nodes of the file.
pub(super) fn read(source: &Source<'_>) -> Result<Vec<Node>, Error> {
    let list = &source.root.nodes;
    let mut nodes = Vec::with_capacity(list.len());
    for (index, node) in list.iter().enumerate() {
        nodes.push(rest(node).ok_or_else(|| {
            source.damaged(label("node", index, node.name.as_ref()), "its transform is not finite")
        })?);
    }
    for (index, node) in list.iter().enumerate() {
        let place = label("node", index, node.name.as_ref());
        for &child in node.children.iter().flatten() {
            source.get(list, child, "node", &place)?;
            let parent = &mut nodes[child.value()].parent;
            if let Some(other) = parent.filter(|p| *p != index) {
                return Err(
                    source.damaged(place, format!("its child {child} is also a child of node {other}"))
                );
            }
            *parent = Some(index);
        }
    }
    refuse_cycles(source, &nodes)?;
    Ok(nodes)
}

/// Walks up from every node once; a walk that meets itself has found a cycle.
fn refuse_cycles(source: &Source<'_>, nodes: &[Node]) -> Result<(), Error> {
    let mut walk_of: Vec<Option<usize>> = vec![None; nodes.len()];
    for start in 0..nodes.len() {
        let mut at = Some(start);
        while let Some(node) = at.filter(|n| walk_of[*n] != Some(start)) {
            if walk_of[node].is_some() {
                break;
            }
            walk_of[node] = Some(start);
            at = nodes[node].parent;
        }
        if let Some(node) = at.filter(|n| walk_of[*n] == Some(start)) {
            return Err(
                source.damaged(label("node", node, Some(&nodes[node].name)), "it is its own ancestor")
            );
        }
    }
    Ok(())
}

/// Rest transform of a node, without its parent; `None` if it is not finite.
fn rest(node: &scene::Node) -> Option<Node> {
    let (scale, rotation, translation) = if let Some(matrix) = &node.matrix {
        decompose(&DMat4::from_cols_array(&matrix.map(f64::from)))
    } else {
        let vector =
            |v: Option<[f32; 3]>, default| v.map_or(default, |v| DVec3::from_array(v.map(f64::from)));
        let rotation = node.rotation.map_or(DQuat::IDENTITY, |q| DQuat::from_array(q.0.map(f64::from)));
        (vector(node.scale, DVec3::ONE), rotation, vector(node.translation, DVec3::ZERO))
    };
    if !(scale.is_finite() && rotation.is_finite() && translation.is_finite()) {
        return None;
    }
    // A zero quaternion is no rotation at all.
    let rotation = if rotation.length_squared() > 0.0 { rotation.normalize() } else { DQuat::IDENTITY };
    Some(Node { name: node.name.clone().unwrap_or_default(), parent: None, translation, rotation, scale })
}

/// Scale, rotation, translation of a matrix without shear; a mirrored one gets a negative scale in x. An axis of
/// length 0 leaves the rotation open: the identity is taken.
fn decompose(matrix: &DMat4) -> (DVec3, DQuat, DVec3) {
    let axes = DMat3::from_mat4(*matrix);
    let sign = if axes.determinant() < 0.0 { -1.0 } else { 1.0 };
    let scale = DVec3::new(axes.x_axis.length() * sign, axes.y_axis.length(), axes.z_axis.length());
    let rotation = if scale.min_element().abs() > 0.0 && scale.x.abs() > 0.0 {
        DQuat::from_mat3(&DMat3::from_cols(
            axes.x_axis / scale.x,
            axes.y_axis / scale.y,
            axes.z_axis / scale.z,
        ))
    } else {
        DQuat::IDENTITY
    };
    (scale, rotation, matrix.w_axis.truncate())
}

/// Whether each node belongs to the scene that viewers show; all do in a file without scenes.
pub(super) fn shown(source: &Source<'_>, nodes: &[Node]) -> Result<Vec<bool>, Error> {
    let scenes = &source.root.scenes;
    let scene = match source.root.scene {
        Some(index) => Some(source.get(scenes, index, "scene", "scene")?),
        None => scenes.first(),
    };
    let Some(scene) = scene else { return Ok(vec![true; nodes.len()]) };
    let mut shown = vec![false; nodes.len()];
    for &root in &scene.nodes {
        source.get(&source.root.nodes, root, "node", "scene")?;
        shown[root.value()] = true;
    }
    spread_to_descendants(nodes, &mut shown);
    Ok(shown)
}

/// Marks every node below a marked one.
pub(super) fn spread_to_descendants(nodes: &[Node], marked: &mut [bool]) {
    let mut settled = vec![false; nodes.len()];
    for start in 0..nodes.len() {
        let mut path = Vec::new();
        let mut at = Some(start);
        while let Some(node) = at.filter(|n| !settled[*n] && !marked[*n]) {
            path.push(node);
            at = nodes[node].parent;
        }
        let mark = at.is_some_and(|n| marked[n]);
        for node in path {
            settled[node] = true;
            marked[node] = mark;
        }
    }
}
