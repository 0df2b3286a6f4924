//! Every subcommand on a real file.

use crate::support::Folder;

#[test]
fn a_fox_is_baked_inspected_played_and_verified() {
    let folder = Folder::new("whole");
    if !folder.fox() {
        return;
    }
    let baked = folder.good("bake fox.glb -o fox.sinew");
    assert!(baked.out.starts_with("fox.sinew: 1728 vertices"), "{}", baked.out);
    assert!(baked.out.contains("regions: ") && baked.out.contains("tail"), "{}", baked.out);
    assert_eq!(folder.names(), ["fox.glb", "fox.sinew", "fox.sinew.json"]);
    let inspected = folder.good("inspect fox.sinew");
    assert!(inspected.out.contains("Run (1.16 s)") && inspected.out.contains("tail: "), "{}", inspected.out);
    folder.good("play fox.glb --asset fox.sinew --clip Run --seconds 0.5 -o fox.replay");
    let verified = folder.good("verify fox.replay");
    assert!(verified.out.contains("30 frames, identical"), "{}", verified.out);
    assert!(folder.good("inspect fox.replay").out.contains("frames       30"), "frames are counted");
}

#[test]
fn json_is_one_object_and_says_what_the_lines_say() {
    let folder = Folder::new("json");
    if !folder.fox() {
        return;
    }
    let baked = folder.good("--json bake fox.glb -o fox.sinew").json();
    assert_eq!((baked["vertices"].as_u64(), baked["joints"].as_u64()), (Some(1728), Some(24)), "{baked}");
    assert_eq!(baked["bytes"].as_u64(), Some(folder.read("fox.sinew").len() as u64));
    let asset = folder.good("inspect fox.sinew --json").json();
    assert_eq!(asset["hash"], baked["hash"]);
    let character = folder.good("inspect fox.glb --json").json();
    assert_eq!((character["kind"].as_str(), character["vertices"].as_u64()), (Some("character"), Some(1728)));
    let played =
        folder.good("play fox.glb --asset fox.sinew --clip Run --fps 30 --seconds 1 -o a.replay --json");
    let played = played.json();
    assert_eq!((played["frames"].as_u64(), played["clip"].as_str()), (Some(30), Some("Run")), "{played}");
    assert!(played["largest_offset"].as_f64().is_some_and(|x| x > 0.001 && x < 0.2), "{played}");
    let verified = folder.good("verify a.replay --json").json();
    assert_eq!((verified["same"].as_bool(), verified["frames"].as_u64()), (Some(true), Some(30)));
    assert_eq!(folder.good("inspect a.replay --json").json()["digest"], verified["digest"]);
}

#[test]
fn the_same_file_gives_the_same_bytes() {
    let folder = Folder::new("same");
    if !folder.fox() {
        return;
    }
    for name in ["a", "b"] {
        folder.good(&format!("bake fox.glb -o {name}.sinew --report {name}"));
        for ending in ["png", "gif", "glb", "npy", "replay", "json"] {
            folder.good(&format!("play fox.glb --seconds 0.3 --height 64 -o {name}.{ending}"));
        }
    }
    for ending in ["sinew", "png", "gif", "glb", "npy", "replay", "json"] {
        assert!(
            folder.read(&format!("a.{ending}")) == folder.read(&format!("b.{ending}")),
            "{ending} differs"
        );
    }
    assert!(folder.read("a/index.html") == folder.read("b/index.html"), "the report differs");
}

#[test]
fn the_built_in_character_needs_no_file() {
    let folder = Folder::new("builtin");
    folder.good("bake builtin -o plum.sinew");
    let all = folder.good("play builtin --asset plum.sinew --seconds 0.2 -o plum.json --json").json();
    let file: serde_json::Value = serde_json::from_slice(&folder.read("plum.json")).expect("JSON");
    assert_eq!(file["frames"].as_array().map(Vec::len), Some(12));
    assert_eq!(file["largest_offset"], all["largest_offset"]);
    assert!(folder.good("inspect builtin").out.contains("name         Plum"), "it has a name");
}

#[test]
fn an_array_is_what_numpy_reads_and_without_flesh_it_is_skinning() {
    let folder = Folder::new("array");
    if !folder.fox() {
        return;
    }
    folder.good("play fox.glb --clip Run --fps 30 --seconds 0.2 -o with.npy");
    folder.good("play fox.glb --clip Run --fps 30 --seconds 0.2 --no-flesh -o without.npy");
    let (with, without) = (folder.read("with.npy"), folder.read("without.npy"));
    let start = 10 + usize::from(u16::from_le_bytes([with[8], with[9]]));
    let header = String::from_utf8_lossy(&with[10..start]).into_owned();
    assert!(with.starts_with(b"\x93NUMPY\x01\x00") && header.contains("'shape': (6, 1728, 3)"), "{header}");
    assert_eq!((with.len() - start, without.len()), (6 * 1728 * 3 * 4, with.len()));
    let floats = |bytes: &[u8]| -> Vec<f32> {
        let words = bytes[start..].chunks_exact(4);
        words.map(|w| f32::from_le_bytes([w[0], w[1], w[2], w[3]])).collect()
    };
    let (with, without) = (floats(&with), floats(&without));
    let moved = with.iter().zip(&without).filter(|(a, b)| a.to_bits() != b.to_bits()).count();
    assert!(moved > 1000 && moved < with.len() / 2, "flesh moves some vertices, not all: {moved}");
    assert!(with.iter().all(|x| x.is_finite() && x.abs() < 300.0), "in the file's own units");
}

#[test]
fn a_baked_animation_is_a_file_that_is_read_back() {
    let folder = Folder::new("morph");
    if !folder.fox() {
        return;
    }
    folder.good("play fox.glb --clip Run --fps 30 -o run.glb");
    let file = gltf::Gltf::from_slice(&folder.read("run.glb")).expect("a valid glTF");
    let primitive = file.meshes().next().expect("a mesh").primitives().next().expect("a primitive");
    let animation = file.animations().next().expect("an animation");
    assert_eq!((primitive.morph_targets().len(), animation.name()), (59, Some("Run")));
    assert_eq!(file.skins().count(), 0, "any viewer shows it: no skin");
}

#[test]
fn knobs_are_kept_for_the_same_asset_and_put_aside_for_another() {
    let folder = Folder::new("knobs");
    if !folder.fox() {
        return;
    }
    folder.good("bake fox.glb -o fox.sinew");
    let text = String::from_utf8(folder.read("fox.sinew.json")).expect("text");
    let turned = text.replace("\"gain\": 1.0,\n    \"frequency\"", "\"gain\": 0.0,\n    \"frequency\"");
    assert_ne!(turned, text, "the overall gain is in the file");
    let before =
        folder.good("play fox.glb --asset fox.sinew --clip Run --seconds 0.3 -o a.json --json").json();
    folder.write("fox.sinew.json", &turned);
    let after =
        folder.good("play fox.glb --asset fox.sinew --clip Run --seconds 0.3 -o a.json --json").json();
    assert!(before["largest_offset"].as_f64() > Some(0.01), "{before}");
    assert_eq!(after["largest_offset"].as_f64(), Some(0.0), "a gain of 0 is skinning");
    assert!(
        folder.good("bake fox.glb -o fox.sinew").out.contains("fox.sinew.json is kept"),
        "the same asset"
    );
    assert_eq!(folder.read("fox.sinew.json"), turned.as_bytes());
    folder.write("soft.toml", "softness = 0.5");
    let baked = folder.good("bake fox.glb -o fox.sinew --recipe soft.toml");
    assert!(baked.out.contains("kept as fox.sinew.json.old"), "{}", baked.out);
    assert_eq!(folder.read("fox.sinew.json.old"), turned.as_bytes());
}

#[test]
fn speed_is_measured_in_the_shape_that_is_followed_over_time() {
    let folder = Folder::new("bench");
    let bench = folder.good("bench springs --json").json();
    let result = &bench["results"][0];
    assert!(
        bench["machine"].is_string() && bench["results"].as_array().is_some_and(|r| r.len() == 1),
        "{bench}"
    );
    assert_eq!((result["name"].as_str(), result["unit"].as_str()), (Some("springs"), Some("ns/vertex")));
    assert!(
        result["value"].as_f64() > Some(0.0) && result["peers"][0]["value"].as_f64() > Some(0.0),
        "{result}"
    );
}
