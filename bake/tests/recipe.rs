//! The auto recipe on real characters and on toys.

use std::collections::BTreeMap;
use std::path::Path;

use glam::DVec3;
use sinew_bake::Model;
use sinew_bake::import::import;
use sinew_bake::model::Primitive;
use sinew_bake::recipe::{Flesh, Recipe, flesh};

/// A character of the shared data; `None` where it is missing, which is a failure on the build machine.
fn character(file: &str) -> Option<Model> {
    let path = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../shared/data")).join(file);
    if !path.exists() {
        assert!(std::env::var("CI").as_deref() != Ok("true"), "{} is missing", path.display());
        eprintln!("skipped: {} is missing", path.display());
        return None;
    }
    Some(import(&path).expect("the file is a character"))
}

fn auto(model: &Model) -> Flesh {
    flesh(model, &Recipe::default()).expect("the character has flesh")
}

/// Every kind of rig in the shared data.
const CHARACTERS: [&str; 20] = [
    "asset-generator/Animation_Skin_00.gltf",
    "asset-generator/Animation_SkinType_00.gltf",
    "big-buck-bunny/bunny.glb",
    "godette-vrm/Godette_vrm_v4.vrm",
    "kaykit/Mage.glb",
    "khronos/CesiumMan.glb",
    "khronos/Fox.glb",
    "khronos/RiggedFigure.gltf",
    "khronos/RiggedSimple.gltf",
    "khronos/SimpleSkin.gltf",
    "makehuman/mh_f_heavy.glb",
    "mesh2motion/fox.glb",
    "mesh2motion/horse.glb",
    "mesh2motion/panda.glb",
    "quaternius/Alpaca.glb",
    "quaternius/Formal.glb",
    "quaternius/Puffer.glb",
    "quaternius/Rat.glb",
    "sintel/sintel.glb",
    "vrm1-springbone/smoke_spring.vrm",
];

/// Vertices in body sizes, each with its softness.
fn places(model: &Model, flesh: &Flesh) -> Vec<(DVec3, f32)> {
    let rest = model.rest_positions().into_iter().map(|p| p / flesh.body_size);
    rest.zip(flesh.softness.iter().copied()).collect()
}

/// Softness of the vertex farthest along a direction.
fn extreme(places: &[(DVec3, f32)], direction: DVec3) -> f32 {
    let farthest = places.iter().max_by(|a, b| a.0.dot(direction).total_cmp(&b.0.dot(direction)));
    farthest.expect("there are vertices").1
}

fn softest(places: &[(DVec3, f32)], within: impl Fn(DVec3) -> bool) -> f32 {
    let inside: Vec<f32> = places.iter().filter(|(p, _)| within(*p)).map(|(_, s)| *s).collect();
    assert!(!inside.is_empty(), "no vertex is in the part that is tested");
    inside.into_iter().fold(0.0, f32::max)
}

/// Edges of all triangles as pairs of render vertices.
fn edges(model: &Model) -> Vec<(usize, usize)> {
    let mut start = 0;
    let mut out = Vec::new();
    for primitive in &model.primitives {
        for [a, b, c] in primitive.indices.iter().map(|t| t.map(|v| start + v as usize)) {
            out.extend([(a, b), (b, c), (c, a)]);
        }
        start += primitive.positions.len();
    }
    out
}

#[test]
fn foxes_have_soft_tails_and_ears_and_rigid_paws() {
    for file in ["khronos/Fox.glb", "mesh2motion/fox.glb"] {
        let Some(model) = character(file) else { continue };
        let flesh = auto(&model);
        let places = places(&model, &flesh);
        assert!(extreme(&places, DVec3::NEG_Z) > 0.9, "{file}: tip of the tail");
        assert!(extreme(&places, DVec3::Y) > 0.5, "{file}: tip of an ear");
        assert!(softest(&places, |p| p.y < 0.04) == 0.0, "{file}: paws");
        assert!(extreme(&places, DVec3::Z) == 0.0, "{file}: nose");
        assert!(softest(&places, |p| p.z.abs() < 0.1 && p.y < 0.3) > 0.5, "{file}: belly");
        let names: Vec<&str> = flesh.regions.iter().map(|r| r.name.as_str()).collect();
        assert!(names.contains(&"tail") && names.contains(&"ear"), "{file}: {names:?}");
    }
}

#[test]
fn the_bunny_has_a_soft_belly_and_ears_and_rigid_hands_feet_and_face() {
    let Some(model) = character("big-buck-bunny/bunny.glb") else { return };
    let places = places(&model, &auto(&model));
    let belly = places.iter().filter(|(p, _)| (0.2..0.3).contains(&p.y) && p.x.abs() < 0.03 && p.z > 0.1);
    assert!(belly.map(|(_, s)| *s).fold(1.0, f32::min) > 0.8, "belly");
    assert!(extreme(&places, DVec3::Y) > 0.8, "tip of an ear");
    assert!(softest(&places, |p| p.x.abs() > 0.22) == 0.0, "hands");
    assert!(softest(&places, |p| p.y < 0.03) == 0.0, "feet");
    assert!(softest(&places, |p| (0.47..0.55).contains(&p.y) && p.x.abs() < 0.1 && p.z > 0.1) == 0.0, "face");
}

#[test]
fn a_heavy_body_is_softest_at_the_belly() {
    let Some(model) = character("makehuman/mh_f_heavy.glb") else { return };
    let places = places(&model, &auto(&model));
    let front = |low: f64, high: f64| softest(&places, move |p| (low..high).contains(&p.y) && p.z > 0.02);
    assert!(front(0.44, 0.55) > 0.8, "belly");
    assert!(softest(&places, |p| (0.36..0.44).contains(&p.y) && p.z < -0.02) > 0.2, "buttocks");
    assert!(softest(&places, |p| p.y > 0.74) == 0.0, "head");
    assert!(softest(&places, |p| p.y < 0.1) == 0.0, "feet");
    assert!(softest(&places, |p| p.x.abs() > 0.21) == 0.0, "hands");
}

#[test]
fn toys_wobble_at_the_free_end() {
    for file in ["khronos/SimpleSkin.gltf", "khronos/RiggedSimple.gltf"] {
        let Some(model) = character(file) else { continue };
        let places = places(&model, &auto(&model));
        assert!(extreme(&places, DVec3::Y) > 0.5, "{file}: free end");
        assert!(extreme(&places, DVec3::NEG_Y) == 0.0, "{file}: held end");
    }
}

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
            assert!(jump <= 1e-6 + 90.0 * length, "{file}: softness jumps by {jump} over {length}");
            let both = flesh.softness[a].min(flesh.softness[b]);
            let same = flesh.region[a] == flesh.region[b];
            assert!(same || both == 0.0, "{file}: regions meet at softness {both}, vertices {a} and {b}");
        }
    }
}

#[test]
fn symmetric_characters_have_symmetric_flesh() {
    let symmetric =
        ["big-buck-bunny/bunny.glb", "khronos/Fox.glb", "mesh2motion/horse.glb", "khronos/CesiumMan.glb"];
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

#[test]
fn paint_overrides_and_is_checked() {
    let Some(mut model) = character("quaternius/Alpaca.glb") else { return };
    let rest = model.rest_positions();
    let top = rest.iter().map(|p| p.y).fold(0.0, f64::max);
    let mut start = 0;
    for primitive in &mut model.primitives {
        let count = primitive.positions.len();
        #[expect(clippy::cast_possible_truncation, reason = "a shade from 0 to 1")]
        let shade = |p: &DVec3| (p.y / top).clamp(0.0, 1.0) as f32;
        primitive.painted = Some(rest[start..start + count].iter().map(shade).collect());
        start += count;
    }
    let flesh = auto(&model);
    for (p, soft) in rest.iter().zip(&flesh.softness) {
        assert!(
            (f64::from(*soft) - (p.y / top).clamp(0.0, 1.0)).abs() < 1e-4,
            "painted softness is used as it is"
        );
    }
    model.primitives[0].painted.as_mut().expect("painted")[3] = f32::NAN;
    let error = refusal(&model);
    assert!(error.contains("vertex 3, _SINEW"), "{error}");
}

fn refusal(model: &Model) -> String {
    flesh(model, &Recipe::default()).expect_err("the model is not usable").to_string()
}

#[test]
fn rules_override() {
    let Some(model) = character("khronos/Fox.glb") else { return };
    let text = "softness = 0.5\n[[rule]]\njoints = [\"B_TAIL*\"]\nregion = \"brush\"\nfrequency = 1.25\n\
                [[rule]]\njoints = [\"b_Head_05\"]\nsoftness = 0.0\n[[rule]]\njoints = [\"wing\"]\nsoftness = 1.0\n";
    let recipe = Recipe::from_toml("fox.toml", text).expect("a good recipe");
    let ruled = flesh(&model, &recipe).expect("usable");
    let plain = auto(&model);
    let places = places(&model, &ruled);
    assert!(extreme(&places, DVec3::Y) == 0.0, "ears are rigid by rule");
    assert!((extreme(&places, DVec3::NEG_Z) - 0.5).abs() < 0.06, "the tip of the tail is half as soft");
    let brush = ruled.regions.iter().position(|r| r.name == "brush").expect("the rule's region");
    assert_eq!(ruled.regions[brush].frequency.to_bits(), 1.25_f32.to_bits(), "frequency of the rule");
    let tail = plain.regions.iter().find(|r| r.name == "tail").expect("a tail");
    assert_eq!(ruled.regions[brush].damping.to_bits(), tail.damping.to_bits(), "what is not given stays");
    let used = ruled.region.iter().filter(|r| usize::from(**r) == brush).count();
    assert!(used > 100, "{used} vertices in the region");
    assert!(
        ruled.notes.iter().any(|n| n.contains("fox.toml: rule 3") && n.contains("wing")),
        "{:?}",
        ruled.notes
    );
}

#[test]
fn bad_recipes_are_refused_by_name() {
    let cases = [
        ("softness = -1", "softness"),
        ("gain = nan", "gain"),
        ("\nwobble = 1", "line 2"),
        ("[[rule]]\nsoftness = 0.5", "rule 1, joints"),
        ("[[rule]]\njoints = [\"a\"]\nfrequency = 99", "rule 1, frequency"),
        ("[[rule]]\njoints = 3", "line 2"),
        ("softness =", "line 1"),
    ];
    for (text, place) in cases {
        let error = Recipe::from_toml("r.toml", text).expect_err(text).to_string();
        assert!(error.starts_with("r.toml: ") && error.contains(place), "{text:?}: {error}");
    }
}

#[test]
fn spring_bones_are_left_alone() {
    let Some(model) = character("godette-vrm/Godette_vrm_v4.vrm") else { return };
    let flesh = auto(&model);
    let springs = &model.vrm.as_ref().expect("a VRM file").spring_nodes;
    let mut v = 0;
    let mut left = 0;
    for primitive in &model.primitives {
        let joints = primitive.joints.chunks_exact(primitive.stride);
        for (joints, weights) in joints.zip(primitive.weights.chunks_exact(primitive.stride)) {
            let held = |j: &u16| springs.contains(&model.joints[usize::from(*j)].node);
            let share: f32 = joints.iter().zip(weights).filter(|(j, _)| held(j)).map(|(_, w)| w).sum();
            if share > 0.5 {
                assert!(flesh.softness[v] == 0.0, "vertex {v} is moved twice");
                left += 1;
            }
            v += 1;
        }
    }
    assert!(left > 0, "no vertex is moved by spring bones");
    assert!(flesh.notes.iter().any(|n| n.contains("spring bones")), "{:?}", flesh.notes);
    assert!(flesh.softness.iter().any(|s| *s > 0.5), "the rest has flesh");
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
fn clothes_and_eyes_move_with_the_skin_beneath() {
    let Some(model) = character("makehuman/mh_f_heavy.glb") else { return };
    let flesh = auto(&model);
    let places = places(&model, &flesh);
    let counts: Vec<usize> = model.primitives.iter().map(|p| p.positions.len()).collect();
    let body = (0..counts.len()).max_by_key(|p| counts[*p]).expect("a body");
    let start: usize = counts[..body].iter().sum();
    let skin = start..start + counts[body];
    let (mut worst, mut worn) = (0.0_f32, 0);
    for (_, (p, soft)) in places.iter().enumerate().filter(|(v, _)| !skin.contains(v)) {
        let beneath = places[skin.clone()].iter().map(|(q, s)| (p.distance_squared(*q), *s));
        let (distance, under) = beneath.min_by(|a, b| a.0.total_cmp(&b.0)).expect("skin");
        if distance < 0.01 * 0.01 {
            worst = worst.max((soft - under).abs());
            worn += 1;
        }
    }
    assert!(worn > 1000, "only {worn} vertices of clothes");
    assert!(worst < 0.1, "softness differs by {worst} from the skin beneath");
}
