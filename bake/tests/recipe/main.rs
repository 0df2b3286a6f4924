//! The auto recipe on real characters and on toys.

mod anatomy;
mod laws;
mod wishes;

use std::path::Path;

use glam::DVec3;
use sinew_bake::Model;
use sinew_bake::import::import;
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

/// The same with the smallest coordinates at the origin.
fn from_corner(places: &[(DVec3, f32)]) -> Vec<(DVec3, f32)> {
    let corner = places.iter().map(|(p, _)| *p).reduce(DVec3::min).expect("there are vertices");
    places.iter().map(|(p, s)| (*p - corner, *s)).collect()
}

/// Why a model is refused.
fn refusal(model: &Model) -> String {
    flesh(model, &Recipe::default()).expect_err("the model is not usable").to_string()
}
