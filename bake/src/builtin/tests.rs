//! The character is closed, symmetric, bound well, moves in loops, and has the same bits everywhere.

use super::skeleton::{JOINTS, mirrored};
use super::*;
use crate::model::{Channel, Interpolation, Property};
use sinew::math::digest::Digest;
use std::collections::{BTreeMap, BTreeSet};
use std::sync::OnceLock;

/// The character, made once for all tests.
fn plum() -> &'static Model {
    static MODEL: OnceLock<Model> = OnceLock::new();
    MODEL.get_or_init(character)
}

/// Edges of triangles with how often each direction occurs.
fn edges(triangles: &[[u32; 3]]) -> BTreeMap<(u32, u32), u32> {
    let mut out = BTreeMap::new();
    for t in triangles {
        for k in 0..3 {
            *out.entry((t[k], t[(k + 1) % 3])).or_default() += 1;
        }
    }
    out
}

/// Number of connected components.
fn components(vertices: usize, edges: &BTreeMap<(u32, u32), u32>) -> usize {
    let mut root: Vec<usize> = (0..vertices).collect();
    fn find(root: &mut [usize], mut v: usize) -> usize {
        while root[v] != v {
            root[v] = root[root[v]];
            v = root[v];
        }
        v
    }
    for (a, b) in edges.keys() {
        let (a, b) = (find(&mut root, *a as usize), find(&mut root, *b as usize));
        root[a.max(b)] = a.min(b);
    }
    (0..vertices).filter(|v| root[*v] == *v).count()
}

#[test]
fn every_mesh_is_closed_and_the_body_is_one_piece() {
    let model = plum();
    assert!((5_000..=10_000).contains(&model.vertex_count()), "{} vertices", model.vertex_count());
    for (p, pieces) in model.primitives.iter().zip([1, 6]) {
        let edges = edges(&p.indices);
        for ((a, b), count) in &edges {
            assert_eq!(
                (*count, edges.get(&(*b, *a))),
                (1, Some(&1)),
                "edge at {:?}",
                p.positions[*a as usize]
            );
        }
        assert_eq!(components(p.positions.len(), &edges), pieces, "eyes, lids, nose, mouth; and the body");
    }
    // Manifold at vertices, too: a closed surface of one piece has an even Euler characteristic, here 2.
    let body = &model.primitives[0];
    let characteristic = body.positions.len() + body.indices.len() - edges(&body.indices).len() / 2;
    assert_eq!(characteristic, 2, "a ball without handles");
}

#[test]
fn triangles_are_well_shaped_and_face_outwards() {
    let body = &plum().primitives[0];
    let at = |v: u32| DVec3::from_array(body.positions[v as usize].map(f64::from));
    let normal = |v: u32| DVec3::from_array(body.normals[v as usize].map(f64::from));
    let mut thin = 0;
    for [a, b, c] in body.indices.iter().copied() {
        let cross = (at(b) - at(a)).cross(at(c) - at(a));
        let longest = [at(b) - at(a), at(c) - at(b), at(a) - at(c)].map(DVec3::length_squared);
        let quality = 2.0 / libm::sqrt(3.0) * cross.length() / longest.into_iter().fold(0.0, f64::max);
        assert!(quality > 0.05, "sliver at {}: {quality}", at(a));
        thin += usize::from(quality < 0.35);
        let facing = cross.normalize().dot((normal(a) + normal(b) + normal(c)).normalize());
        assert!(facing > 0.2, "triangle at {} against its normals: {facing}", at(a));
    }
    assert!(thin * 100 < body.indices.len(), "{thin} thin triangles");
}

#[test]
fn the_character_stands_on_the_ground_and_fits_its_size() {
    let points = plum().rest_positions();
    let low = points.iter().fold(DVec3::INFINITY, |m, p| m.min(*p));
    let high = points.iter().fold(DVec3::NEG_INFINITY, |m, p| m.max(*p));
    assert!(low.y.abs() < 0.01, "feet at {}", low.y);
    assert!((1.5..1.75).contains(&high.y), "height {}", high.y);
    assert!(high.z < 0.6 && low.z < -0.8, "belly forwards, tail backwards: {low} {high}");
}

/// Bits of a vertex: position, normal, joints with weights by joint.
fn bits(p: &Primitive, v: usize, flip: bool) -> (Vec<u32>, BTreeMap<usize, u32>) {
    let sign = if flip { -1.0 } else { 1.0 };
    let vector = |[x, y, z]: [f32; 3]| [sign * x + 0.0, y, z];
    let place = vector(p.positions[v]).into_iter().chain(vector(p.normals[v])).map(f32::to_bits);
    let row = (0..p.stride).map(|k| (p.joints[v * p.stride + k], p.weights[v * p.stride + k]));
    let row = row.filter(|(_, w)| *w > 0.0).map(|(j, w)| {
        let joint = usize::from(j);
        (if flip { mirrored(joint) } else { joint }, w.to_bits())
    });
    (place.collect(), row.collect())
}

#[test]
fn the_mirror_image_is_the_same_to_the_bit() {
    for p in &plum().primitives {
        let known: BTreeSet<_> = (0..p.positions.len()).map(|v| bits(p, v, false)).collect();
        for v in 0..p.positions.len() {
            assert!(known.contains(&bits(p, v, true)), "vertex {v} at {:?} has no partner", p.positions[v]);
        }
    }
    for (i, node) in plum().nodes.iter().take(JOINTS).enumerate() {
        let t = plum().nodes[mirrored(i)].translation;
        assert_eq!(t.with_x(-t.x + 0.0), node.translation, "{}", node.name);
    }
}

#[test]
fn weights_are_whole_and_smooth() {
    for p in &plum().primitives {
        for row in p.weights.chunks_exact(p.stride) {
            assert!((row.iter().sum::<f32>() - 1.0).abs() < 1e-6, "{row:?}");
            assert!(row.is_sorted_by(|a, b| a >= b) && row.iter().all(|w| *w >= 0.0), "{row:?}");
        }
    }
    let body = &plum().primitives[0];
    let full = |v: u32| {
        let mut out = [0.0_f32; JOINTS];
        for k in 0..4 {
            out[usize::from(body.joints[v as usize * 4 + k])] += body.weights[v as usize * 4 + k];
        }
        out
    };
    for (a, b) in edges(&body.indices).keys() {
        let step: f32 = full(*a).iter().zip(full(*b)).map(|(x, y)| (x - y).abs()).sum();
        assert!(step < 0.5, "weights jump by {step} along edge {a} {b} at {:?}", body.positions[*a as usize]);
    }
}

#[test]
fn a_lid_is_within_the_open_eye_and_a_closed_eye_within_the_head() {
    let shape = Shape::creature();
    let features = face::features(&shape);
    for (eye, lid) in [(&features[0], &features[2]), (&features[1], &features[3])] {
        for t in &eye.triangles {
            let [a, b, c] = t.map(|v| eye.positions[v]);
            let out = (b - a).cross(c - a).normalize();
            let highest = lid.positions.iter().map(|p| (*p - a).dot(out)).fold(f64::NEG_INFINITY, f64::max);
            assert!(highest < 0.0, "a lid shows by {highest}");
        }
        let joint = DVec3::from_array(plum().joints[eye.joint].joint_from_bind.w_axis.truncate().to_array());
        let scale = DVec3::new(0.1, 0.08, 0.1);
        let shut = eye.positions.iter().map(|p| shape.field((*p + joint) * scale - joint));
        let highest = shut.fold(f64::NEG_INFINITY, f64::max);
        assert!(highest < 0.0, "a closed eye shows by {highest}");
    }
}

#[test]
fn no_joint_moves_ears_belly_or_cheeks_alone() {
    let names: Vec<&str> = plum().nodes.iter().map(|n| n.name.as_str()).collect();
    for flesh in ["ear", "belly", "cheek"] {
        assert!(!names.iter().any(|n| n.split('_').any(|part| part == flesh)), "{flesh}");
    }
}

/// Values and slopes of the first or last key of a spline.
fn end(c: &Channel, last: bool) -> &[f32] {
    let width = c.values.len() / c.times.len();
    if last { &c.values[c.values.len() - width..] } else { &c.values[..width] }
}

#[test]
fn clips_loop_with_their_slopes() {
    let names: Vec<&str> = plum().clips.iter().map(|c| c.name.as_str()).collect();
    assert_eq!(names, ["walk", "jump", "shake", "idle"]);
    for clip in &plum().clips {
        for c in &clip.channels {
            assert!(c.times.is_sorted_by(|a, b| a < b), "{}", clip.name);
            assert_eq!((c.times[0], c.times.last()), (0.0, Some(&clip.duration)), "{}", clip.name);
            assert_eq!(c.interpolation, Interpolation::CubicSpline);
            assert_eq!(end(c, false), end(c, true), "{} node {}", clip.name, c.node);
        }
        let moved: BTreeSet<_> = clip.channels.iter().map(|c| (c.node, c.property)).collect();
        assert_eq!(moved.len(), clip.channels.len(), "{}: one channel a property", clip.name);
    }
}

/// Where a joint is at each key of a clip: time and position.
fn path(clip: &str, joint: &str) -> Vec<(f64, DVec3)> {
    let nodes = &plum().nodes;
    let clip = plum().clips.iter().find(|c| c.name == clip).unwrap();
    let at_key = |k: usize| {
        let mut p = DVec3::ZERO;
        let mut next = nodes.iter().position(|n| n.name == joint);
        while let Some(n) = next {
            let (mut moved, mut turned) = (nodes[n].translation, nodes[n].rotation);
            for c in clip.channels.iter().filter(|c| c.node == n) {
                let width = c.values.len() / c.times.len() / 3;
                let v: Vec<f64> =
                    c.values[(3 * k + 1) * width..][..width].iter().map(|x| f64::from(*x)).collect();
                match c.property {
                    Property::Translation => moved = DVec3::from_slice(&v),
                    Property::Rotation => turned = DQuat::from_slice(&v),
                    Property::Scale => {}
                }
            }
            p = moved + turned * p;
            next = nodes[n].parent;
        }
        p
    };
    let times = &clip.channels[0].times;
    times.iter().enumerate().map(|(k, t)| (f64::from(*t), at_key(k))).collect()
}

#[test]
fn feet_do_not_slide() {
    for foot in ["foot_l", "foot_r"] {
        let rest = path("idle", foot)[0].1;
        for clip in ["idle", "shake", "jump"] {
            // The jump's heels rise at 0.34 s and are back at 1.0 s.
            let down = |t: f64| clip != "jump" || !(0.32..1.02).contains(&t);
            for (t, p) in path(clip, foot).into_iter().filter(|(t, _)| down(*t)) {
                assert!(p.distance(rest) < 2e-3, "{clip}: {foot} slides by {} at {t} s", p - rest);
            }
        }
    }
    // On a ground that moves backwards evenly, a foot that is down moves with it.
    let stand: Vec<_> = path("walk", "foot_l").into_iter().filter(|(t, _)| (0.05..0.5).contains(t)).collect();
    for pair in stand.windows(2) {
        let speed = (pair[1].1 - pair[0].1) / (pair[1].0 - pair[0].0);
        assert!((speed.z + 0.35).abs() < 0.02 && speed.x.abs() < 0.02, "{speed} at {} s", pair[0].0);
    }
}

#[test]
fn the_jump_leaves_the_ground() {
    let jump = plum().clips.iter().find(|c| c.name == "jump").unwrap();
    let hips = plum().nodes.iter().position(|n| n.name == "hips").unwrap();
    let c = jump.channels.iter().find(|c| c.node == hips && c.property == Property::Translation).unwrap();
    let heights: Vec<f32> = c.values.chunks_exact(9).map(|k| k[4]).collect();
    let rise = |pick: fn(f32, f32) -> f32| heights.iter().copied().fold(heights[0], pick) - heights[0];
    assert!(rise(f32::max) > 0.25 && rise(f32::min) < -0.08, "{heights:?}");
}

#[test]
fn the_texture_is_a_picture() {
    let bytes = plum().materials[0].texture.as_deref().unwrap();
    let mut reader = png::Decoder::new(std::io::Cursor::new(bytes)).read_info().unwrap();
    let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
    let info = reader.next_frame(&mut pixels).unwrap();
    assert_eq!((info.width, info.height), (512, 256));
    assert_eq!(pixels[(128 * 512 + 128) * 3..][..3], [0x8E, 0x70, 0xC4], "the wheel's middle is the body");
}

/// A digest of everything, so that a change of a single bit on any host is seen.
fn digest(model: &Model) -> u64 {
    let mut d = Digest::default();
    for node in &model.nodes {
        d.bytes(node.name.as_bytes());
        d.floats(&node.translation.to_array().map(narrow));
    }
    for p in &model.primitives {
        d.vectors(&p.positions);
        d.vectors(&p.normals);
        d.floats(p.uvs.as_flattened());
        d.floats(&p.weights);
        d.bytes(bytemuck::cast_slice(&p.joints));
        d.bytes(bytemuck::cast_slice(p.indices.as_flattened()));
    }
    for channel in model.clips.iter().flat_map(|c| &c.channels) {
        d.floats(&channel.times);
        d.floats(&channel.values);
    }
    d.bytes(model.materials[0].texture.as_deref().unwrap());
    d.finish()
}

#[test]
#[cfg(target_endian = "little")]
fn the_bits_are_the_same_everywhere() {
    assert_eq!(format!("{:016x}", digest(plum())), "fb271c005864673a");
}
