//! What holds for every character.

use std::collections::BTreeMap;

use glam::DVec3;
use sinew_bake::Model;
use sinew_bake::model::Primitive;

use super::{CHARACTERS, auto, character, edges, places, refusal};

#[test]
fn all_characters_are_finite_and_do_not_tear() {
    for file in CHARACTERS {
        let Some(model) = character(file) else { continue };
        let flesh = auto(&model);
        assert!(
            flesh.softness.len() == model.vertex_count() && flesh.region.len() == model.vertex_count(),
            "{file}"
        );
        assert!(flesh.softness.iter().all(|s| (0.0..=1.0).contains(s)), "{file}: softness out of 0..=1");
        assert!(flesh.regions.len() <= 16, "{file}");
        assert!(flesh.region.iter().all(|r| usize::from(*r) < flesh.regions.len()), "{file}");
        let rest = model.rest_positions();
        let mut at: BTreeMap<[u64; 3], (u32, u8)> = BTreeMap::new();
        for (v, p) in rest.iter().enumerate() {
            let here = (flesh.softness[v].to_bits(), flesh.region[v]);
            let other = at.entry(p.to_array().map(f64::to_bits)).or_insert(here);
            assert!(*other == here, "{file}: vertex {v} tears from another at the same place");
        }
        for (a, b) in edges(&model) {
            let length = rest[a].distance(rest[b]) / flesh.body_size;
            let jump = f64::from((flesh.softness[a] - flesh.softness[b]).abs());
            assert!(jump <= 1e-6 + 30.0 * length, "{file}: softness jumps by {jump} over {length}");
            let both = flesh.softness[a].min(flesh.softness[b]);
            let same = flesh.region[a] == flesh.region[b];
            assert!(same || both == 0.0, "{file}: regions meet at softness {both}, vertices {a} and {b}");
        }
    }
}

#[test]
fn symmetric_characters_have_symmetric_flesh() {
    let symmetric = [
        "big-buck-bunny/bunny.glb",
        "khronos/CesiumMan.glb",
        "khronos/Fox.glb",
        "makehuman/mh_f_heavy.glb",
        "mesh2motion/horse.glb",
    ];
    for file in symmetric {
        let Some(model) = character(file) else { continue };
        let flesh = auto(&model);
        let mirror = flesh.mirror.expect("the character is symmetric");
        let places = places(&model, &flesh);
        let middle = mirror.offset / flesh.body_size;
        let mut compared = 0;
        for (p, soft) in &places {
            let image = DVec3::new(2.0 * middle - p.x, p.y, p.z);
            let near = |q: &DVec3| q.distance_squared(image) < 1e-8;
            for (_, other) in places.iter().filter(|(q, _)| near(q)) {
                assert!(soft.to_bits() == other.to_bits(), "{file}: {soft} and {other} at {p}");
                compared += 1;
            }
        }
        assert!(compared > places.len() / 2, "{file}: only {compared} pairs");
    }
}

#[test]
fn scale_changes_nothing() {
    let Some(model) = character("mesh2motion/fox.glb") else { return };
    let plain = auto(&model);
    for scale in [0.01, 100.0] {
        let mut scaled = model.clone();
        for node in scaled.nodes.iter_mut().filter(|n| n.parent.is_none()) {
            node.scale *= scale;
            node.translation *= scale;
        }
        let flesh = auto(&scaled);
        assert!((flesh.body_size / plain.body_size / scale - 1.0).abs() < 1e-9, "body size");
        let differ = plain.softness.iter().zip(&flesh.softness).map(|(a, b)| (a - b).abs());
        assert!(differ.fold(0.0, f32::max) < 1e-4, "scale {scale}");
        assert_eq!(plain.region, flesh.region, "scale {scale}");
    }
}

/// A model of one joint and the given triangles.
fn toy(positions: &[[f32; 3]], indices: &[[u32; 3]]) -> Model {
    let node = sinew_bake::model::Node {
        name: String::from("joint"),
        parent: None,
        translation: DVec3::ZERO,
        rotation: glam::DQuat::IDENTITY,
        scale: DVec3::ONE,
    };
    let joint = sinew_bake::model::Joint { node: 0, joint_from_bind: glam::DMat4::IDENTITY };
    let primitive = Primitive {
        positions: positions.to_vec(),
        normals: vec![[0.0, 0.0, 1.0]; positions.len()],
        stride: 4,
        joints: vec![0; 4 * positions.len()],
        weights: [1.0, 0.0, 0.0, 0.0].repeat(positions.len()),
        indices: indices.to_vec(),
        ..Primitive::default()
    };
    Model {
        name: String::from("toy"),
        nodes: vec![node],
        joints: vec![joint],
        primitives: vec![primitive],
        ..Model::default()
    }
}

#[test]
fn degenerate_models_are_refused_or_finite() {
    let point = toy(&[[1.0; 3]; 3], &[[0, 1, 2]]);
    let error = refusal(&point);
    assert!(error.contains("toy") && error.contains("no size"), "{error}");
    assert!(refusal(&Model::default()).contains("no size"), "a model without vertices");
    let infinite = toy(&[[0.0; 3], [f32::INFINITY, 0.0, 0.0], [0.0, 1.0, 0.0]], &[[0, 1, 2]]);
    assert!(refusal(&infinite).contains("vertex 1"), "a position that is not finite");

    let flat = toy(&[[0.0; 3], [1.0, 0.0, 0.0], [0.0, 3.0, 0.0], [1.0, 3.0, 0.0]], &[[0, 1, 2], [1, 3, 2]]);
    let islands = toy(
        &[[0.0; 3], [0.1, 0.0, 0.0], [0.0, 0.1, 0.0], [2.0, 0.0, 0.0], [2.1, 0.0, 0.0], [2.0, 0.0, 0.0]],
        &[[0, 1, 2], [3, 4, 5]],
    );
    let stray = toy(&[[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [50.0; 3]], &[[0, 1, 2]]);
    let far = toy(&[[0.0; 3], [1e-30, 0.0, 0.0], [0.0, 1e-30, 0.0], [f32::MAX; 3]], &[[0, 1, 2]]);
    for model in [flat, islands, stray, far] {
        let flesh = auto(&model);
        assert!(flesh.softness.iter().all(|s| (0.0..=1.0).contains(s)), "{:?}", flesh.softness);
        assert!(flesh.body_size < 10.0, "a vertex without triangle does not count for the size");
    }
}

#[test]
fn a_mirror_image_has_the_same_ears() {
    let Some(model) = character("quaternius/Rat.glb") else { return };
    let mut image = model.clone();
    for node in image.nodes.iter_mut().filter(|n| n.parent.is_none()) {
        node.translation.x = -node.translation.x;
        node.scale.x = -node.scale.x;
        let q = node.rotation;
        node.rotation = glam::DQuat::from_xyzw(q.x, -q.y, -q.z, q.w);
    }
    let softest_ear = |model: &Model| {
        let flesh = auto(model);
        let ear = flesh.regions.iter().position(|r| r.name == "ear").expect("ears");
        let soft = flesh.region.iter().zip(&flesh.softness).filter(|(r, _)| usize::from(**r) == ear);
        soft.map(|(_, s)| *s).fold(0.0, f32::max)
    };
    assert!((softest_ear(&model) - softest_ear(&image)).abs() < 0.01, "the mirror image has other ears");
}
