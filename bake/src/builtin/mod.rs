//! The character that comes with sinew: Plum, a plump critter with long ears and a tail, made by code.
//!
//! An implicit surface (rounded parts, smoothly joined) is meshed, each part follows its own joint, and
//! belly, ears, cheeks and tail tip have no joints at all: their life is the runtime's. Every number
//! follows from `+ − × ÷ √` and `libm`, so the bits are the same on every host.

mod clips;
mod face;
mod mesh;
mod paint;
mod shape;

use crate::Model;
use crate::model::{Joint, Material, Node, Primitive};
use glam::{DMat4, DQuat, DVec3};
use shape::{BONES, Bone};

/// Nodes before the first bone: the root of the skeleton.
const FIRST: usize = 1;

/// The built-in character: +Y up, facing +Z, feet on `y = 0`, about 1.9 units tall with its ears.
#[must_use]
pub fn character() -> Model {
    let nodes = nodes();
    let joints = (0..nodes.len()).map(joint).collect();
    Model {
        name: "Plum".into(),
        joints,
        primitives: vec![body(), face::eyes(), face::sparkles(), face::nose()],
        rigid: Vec::new(),
        clips: clips::all(),
        materials: materials(),
        vrm: None,
        nodes,
    }
}

/// Position of node `i`, model space: the root, then the bones.
fn position(i: usize) -> DVec3 {
    i.checked_sub(FIRST).map_or(DVec3::ZERO, |b| DVec3::from_array(BONES[b].at))
}

/// Index of the node of the bone called `name`.
fn node_of(name: &str) -> usize {
    FIRST + BONES.iter().position(|b| b.name == name).unwrap_or(0)
}

fn nodes() -> Vec<Node> {
    let node = |name: &str, parent: Option<usize>, translation: DVec3| Node {
        name: name.into(),
        parent,
        translation,
        rotation: DQuat::IDENTITY,
        scale: DVec3::ONE,
    };
    let root = node("root", None, DVec3::ZERO);
    let bone = |(i, b): (usize, &Bone)| {
        let parent = if b.parent.is_empty() { 0 } else { node_of(b.parent) };
        node(b.name, Some(parent), position(FIRST + i) - position(parent))
    };
    core::iter::once(root).chain(BONES.iter().enumerate().map(bone)).collect()
}

fn joint(i: usize) -> Joint {
    Joint { node: i, joint_from_bind: DMat4::from_translation(-position(i)) }
}

fn materials() -> Vec<Material> {
    let plain = |base_color| Material { base_color, texture: None, double_sided: false };
    vec![
        Material { base_color: [1.0; 4], texture: Some(paint::texture()), double_sided: false },
        plain([0.012, 0.010, 0.016, 1.0]),
        plain([1.0, 1.0, 1.0, 1.0]),
        plain([0.36, 0.09, 0.12, 1.0]),
    ]
}

/// The skin: mesh, weights and paint.
fn body() -> Primitive {
    let (points, indices) = mesh::surface();
    let mut p = Primitive { stride: 4, material: Some(0), indices, ..Primitive::default() };
    for point in points {
        p.positions.push(point.to_array().map(crate::pack::narrow));
        let normal = shape::gradient(point).normalize();
        p.normals.push(normal.to_array().map(crate::pack::narrow));
        p.uvs.push(paint::uv(point, normal));
        let row = weights(point);
        p.joints.extend(row.iter().map(|(j, _)| *j));
        p.weights.extend(row.iter().map(|(_, w)| *w));
    }
    p
}

/// The four strongest joints of a point: a part holds what is near its own surface.
fn weights(p: DVec3) -> [(u16, f32); 4] {
    let mut row: Vec<(u16, f64)> = BONES
        .iter()
        .enumerate()
        .map(|(i, bone)| {
            let near = (1.0 - bone.distance(p) / 0.16).max(0.0);
            (u16::try_from(FIRST + i).unwrap_or(0), near * near * near)
        })
        .collect();
    row.sort_by(|a, b| b.1.total_cmp(&a.1).then(a.0.cmp(&b.0)));
    row.truncate(4);
    let cut = row[3].1;
    let sum: f64 = row.iter().map(|(_, w)| w - cut).sum();
    core::array::from_fn(|k| {
        let (joint, w) = row[k];
        // The fourth fades to nothing before another takes its place.
        let share = if sum > 0.0 { (w - cut) / sum } else { f64::from(u8::from(k == 0)) };
        (joint, crate::pack::narrow(share))
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeMap;

    #[test]
    fn the_body_is_closed_and_of_one_piece() {
        let body = body();
        let n = body.positions.len();
        assert!((5_000..10_000).contains(&n), "{n} vertices");
        let mut edges: BTreeMap<(u32, u32), u32> = BTreeMap::new();
        for t in &body.indices {
            for k in 0..3 {
                *edges.entry((t[k], t[(k + 1) % 3])).or_default() += 1;
            }
        }
        for ((a, b), count) in &edges {
            assert_eq!((*count, edges.get(&(*b, *a))), (1, Some(&1)), "edge {a} {b}");
        }
        let mut part: Vec<usize> = (0..n).collect();
        for _ in 0..200 {
            for (a, b) in edges.keys() {
                let (a, b) = (*a as usize, *b as usize);
                let least = part[a].min(part[b]);
                (part[a], part[b]) = (least, least);
            }
        }
        assert!(part.iter().all(|p| *p == 0), "several parts");
    }

    #[test]
    fn positions_mirror_exactly_and_weights_sum_to_one() {
        let body = body();
        let bits = |p: [f32; 3]| p.map(|x| (x + 0.0).to_bits());
        let mut known: Vec<[u32; 3]> = body.positions.iter().map(|p| bits(*p)).collect();
        known.sort_unstable();
        for p in &body.positions {
            assert!(known.binary_search(&bits([-p[0], p[1], p[2]])).is_ok(), "{p:?} has no partner");
        }
        for row in body.weights.chunks_exact(4) {
            assert!(
                (row.iter().sum::<f32>() - 1.0).abs() < 1e-6 && row.is_sorted_by(|a, b| a >= b),
                "{row:?}"
            );
        }
    }

    #[test]
    fn clips_close_and_keys_ascend() {
        for clip in character().clips {
            for c in &clip.channels {
                assert!(c.times.is_sorted_by(|a, b| a < b), "{}", clip.name);
                let n = c.values.len() / c.times.len();
                let (first, last) = (&c.values[..n], &c.values[c.values.len() - n..]);
                let gap = first.iter().zip(last).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
                assert!(gap < 1e-5, "{} {:?}: {gap}", clip.name, c.property);
            }
        }
    }
}
