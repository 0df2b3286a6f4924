//! Inputs to begin with, all made of the project's own characters.

use super::with_tube;
use crate::asset_bytes;
use crate::recording::{record, with_character};
use crate::tube;
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use sinew_bake::builtin;
use sinew_bake::dataset::{Array, ArrayInfo, Header, Shard, Writer};
use sinew_bake::export::glb::to_glb;
use sinew_bake::model::{Channel, Interpolation, Model, Property};
use sinew_bake::recipe::{Recipe, flesh};
use sinew_bake::tunables::TunablesFile;

type Seeds = Vec<(&'static str, Vec<u8>)>;

/// The tube with a clip that has every property, shrunk to few rings: a seed should be small.
fn small() -> Model {
    let mut model = tube::model(1.0);
    let p = &mut model.primitives[0];
    p.indices.retain(|t| t.iter().all(|v| *v < 60));
    p.positions.truncate(60);
    p.normals.truncate(60);
    p.joints.truncate(240);
    p.weights.truncate(240);
    let channel = |property, values: &[f32]| Channel {
        node: 1,
        property,
        interpolation: Interpolation::Step,
        times: vec![0.0, 0.5],
        values: values.to_vec(),
    };
    model.clips[0].channels.push(channel(Property::Scale, &[1.0, 1.0, 1.0, 1.1, 0.9, 1.0]));
    model.clips[0].channels.push(channel(Property::Translation, &[0.0, 0.6, 0.0, 0.1, 0.6, 0.0]));
    model
}

pub(super) fn assets() -> Seeds {
    let model = small();
    let baked = flesh(&model, &Recipe::default()).and_then(|f| sinew_bake::pack::pack(&model, &f, 7));
    vec![("handmade", asset_bytes::tube()), ("baked", baked.expect("the tube bakes"))]
}

pub(super) fn replays() -> Seeds {
    vec![("life", with_character(|c| record(c, 6))), ("bare", with_character(|c| record(c, 0)))]
}

pub(super) fn gltfs() -> Seeds {
    let glb = to_glb(&small()).expect("a model fits");
    let json = as_json(&glb);
    // The head of the built-in character's own file: its JSON without the bytes.
    let plum = to_glb(&builtin::character()).expect("a model fits");
    let json_end = 20 + u32::from_le_bytes([plum[12], plum[13], plum[14], plum[15]]) as usize;
    vec![("tube.glb", glb), ("tube.gltf", json), ("plum-head.gltf", plum[20..json_end].to_vec())]
}

/// The same file as JSON with its bytes as a data URI.
fn as_json(glb: &[u8]) -> Vec<u8> {
    let length = u32::from_le_bytes([glb[12], glb[13], glb[14], glb[15]]) as usize;
    let json = String::from_utf8_lossy(&glb[20..20 + length]).into_owned();
    let data = STANDARD.encode(&glb[20 + length + 8..]);
    let uri = format!("\"buffers\":[{{\"uri\":\"data:application/octet-stream;base64,{data}\",");
    json.replacen("\"buffers\":[{", &uri, 1).into_bytes()
}

/// The recipe of the manual, and some rules more.
pub(super) fn recipes() -> Seeds {
    let manual = include_str!("../../../docs/recipe.md");
    let example =
        manual.split("```toml\n").nth(1).and_then(|rest| rest.split("```").next()).unwrap_or_default();
    let rules = "softness = 2\n[[rule]]\njoints = [\"joint?\"]\nsoftness = 0.5\nregion = \"a\"\n\
                 [[rule]]\njoints = [\"*\"]\nmultiply = 0.1\nfrequency = 30\ndamping = 2\nmax_offset = 1\n";
    vec![("manual.toml", example.into()), ("rules.toml", rules.into()), ("empty.toml", Vec::new())]
}

pub(super) fn tunables() -> Seeds {
    with_tube(|c| {
        let file = TunablesFile::of(c.asset());
        let whole = serde_json::to_vec_pretty(&file).expect("plain data");
        let part = format!("{{\"asset\":\"{}\",\"tunables\":{{\"wind\":[1,2e0,-3.5]}}}}", file.asset);
        vec![("whole.json", whole), ("part.json", part.into_bytes())]
    })
}

/// Scripts for the setters: each call once, then all in a row with floats of their own.
pub(super) fn scripts() -> Seeds {
    let each: Vec<u8> =
        (0..16_u8).flat_map(|call| [call, 1, 0, 0x10, 2, 0, 3, 4, 0, 1, 0, 9, 0, 2, 200, 0]).collect();
    let steps: Vec<u8> = (0..40_u8)
        .flat_map(|i| [10 + i % 6, i, 1, 3, i, 0, 2, i, 0, 1, i, 0, 1, 1, i, 0, 0, 200, 0])
        .collect();
    vec![("each", each), ("steps", steps)]
}

pub(super) fn bvhs() -> Seeds {
    let walk = "HIERARCHY\nROOT hip\n{\n OFFSET 0 1 0\n CHANNELS 6 Xposition Yposition Zposition Zrotation Yrotation Xrotation\n JOINT leg\n {\n  OFFSET 0 -0.5 0\n  CHANNELS 3 Zrotation Xrotation Yrotation\n  End Site\n  {\n   OFFSET 0 -0.5 0\n  }\n }\n}\nMOTION\nFrames: 2\nFrame Time: 0.01\n0 1 0 0 0 0 0 0 0\n0 1 0.1 5 -3 1e1 30 0 -2\n";
    vec![("walk", walk.into())]
}

pub(super) fn datasets() -> Seeds {
    let header = Header {
        seed: 1,
        samples: 3,
        shard: Shard::WHOLE,
        character: "0f".to_owned(),
        setting: serde_json::json!({ "cage": "none" }),
        arrays: vec![ArrayInfo::new("skin", &[2, 3], "m"), ArrayInfo::new("motion", &[0, 2], "1")],
    };
    let path = std::env::temp_dir().join(format!(
        "sinew-seed-{}-{:?}",
        std::process::id(),
        std::thread::current().id()
    ));
    let mut writer = Writer::open(&path, &header).expect("a file");
    for (index, frames) in [(0, 1), (2, 3)] {
        let motion = vec![0.5; 2 * frames];
        let arrays = [Array { name: "skin", values: &[0.25; 6] }, Array { name: "motion", values: &motion }];
        writer.append(index, &arrays).expect("room");
    }
    drop(writer);
    let bytes = std::fs::read(&path).expect("what was written");
    std::fs::remove_file(&path).expect("what was written");
    vec![("two-of-three", bytes)]
}
