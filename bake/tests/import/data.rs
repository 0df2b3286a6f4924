//! Every glTF and VRM file of the shared data, with what its import must give.

use std::path::{Path, PathBuf};

use sinew_bake::Model;
use sinew_bake::import::{import, import_bytes};
use sinew_bake::model::Vrm;

const DATA: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../shared/data");

/// `[vertices, triangles, rigid vertices, joints, clips]`, counted from the JSON by other means.
type Counts = [usize; 5];

const CHARACTERS: [(&str, Counts); 36] = [
    ("asset-generator/Animation_SkinType_00.gltf", [6, 4, 0, 2, 0]),
    ("asset-generator/Animation_SkinType_01.gltf", [6, 4, 0, 2, 0]),
    ("asset-generator/Animation_Skin_00.gltf", [6, 4, 0, 2, 0]),
    ("asset-generator/Animation_Skin_01.gltf", [6, 4, 0, 2, 1]),
    ("asset-generator/Animation_Skin_02.gltf", [6, 4, 0, 2, 0]),
    ("asset-generator/Animation_Skin_03.gltf", [6, 4, 0, 2, 0]),
    ("asset-generator/Animation_Skin_04.gltf", [6, 4, 0, 2, 0]),
    ("asset-generator/Animation_Skin_05.gltf", [6, 4, 3, 2, 1]),
    ("big-buck-bunny/bunny.glb", [3241, 5262, 0, 66, 0]),
    ("big-buck-bunny/bunny_animated.glb", [3241, 5262, 0, 66, 7]),
    ("godette-vrm/Godette_vrm_v4.vrm", [8067, 3439, 0, 68, 0]),
    ("kaykit/Mage.glb", [3348, 4029, 1931, 41, 76]),
    ("khronos/CesiumMan.glb", [3273, 4672, 0, 19, 1]),
    ("khronos/Fox.glb", [1728, 576, 0, 24, 3]),
    ("khronos/RiggedFigure.gltf", [370, 256, 0, 19, 1]),
    ("khronos/RiggedSimple.gltf", [160, 188, 0, 2, 1]),
    ("khronos/SimpleSkin.gltf", [10, 8, 0, 2, 1]),
    ("makehuman/mh_f_average.glb", [17539, 32336, 0, 31, 6]),
    ("makehuman/mh_f_curvy.glb", [17539, 32336, 0, 31, 6]),
    ("makehuman/mh_f_heavy.glb", [17539, 32336, 0, 31, 6]),
    ("makehuman/mh_m_average.glb", [17539, 32336, 0, 31, 6]),
    ("makehuman/mh_m_heavy.glb", [17539, 32336, 0, 31, 6]),
    ("mesh2motion/fox.glb", [1250, 1654, 0, 49, 14]),
    ("mesh2motion/horse.glb", [2146, 3414, 0, 56, 14]),
    ("mesh2motion/panda.glb", [1129, 1564, 0, 48, 0]),
    ("quaternius/Alpaca.glb", [4156, 2060, 0, 46, 13]),
    ("quaternius/Formal.glb", [12342, 6130, 0, 51, 0]),
    ("quaternius/Puffer.glb", [3696, 2142, 0, 6, 6]),
    ("quaternius/Rat.glb", [8008, 4004, 0, 31, 6]),
    ("sintel/sintel.glb", [25413, 41306, 0, 66, 0]),
    ("sintel/sintel_animated.glb", [25413, 41306, 0, 66, 2]),
    ("vrm1-springbone/smoke_spring.vrm", [60, 96, 1225, 4, 0]),
    ("vrm1-springbone/springbone_collider_capsule_x0p02_r0p05.vrm", [60, 96, 1225, 4, 0]),
    ("vrm1-springbone/springbone_collider_sphere_x0p02_r0p05.vrm", [60, 96, 1225, 4, 0]),
    ("vrm1-springbone/swing_springbone_stiffness_0p2.vrm", [60, 96, 1225, 4, 0]),
    ("vrm1-springbone/swing_springbone_stiffness_0p8.vrm", [60, 96, 1225, 4, 0]),
];

const WITHOUT_SKIN: [&str; 3] = [
    "asset-generator/Buffer_Interleaved_00.gltf",
    "asset-generator/Buffer_Interleaved_01.gltf",
    "khronos/MorphStressTest.gltf",
];

/// A shared file; `None`, with a message, where the data is not at hand.
pub(crate) fn shared(file: &str) -> Option<PathBuf> {
    let path = Path::new(DATA).join(file);
    if path.exists() {
        return Some(path);
    }
    assert!(std::env::var("CI").as_deref() != Ok("true"), "{} is missing", path.display());
    println!("skipped: {} is not there", path.display());
    None
}

fn load(file: &str) -> Option<Model> {
    Some(import(&shared(file)?).unwrap_or_else(|e| panic!("{e}")))
}

#[test]
fn every_character_has_its_counts() {
    for (file, counts) in CHARACTERS {
        let Some(model) = load(file) else { continue };
        let found = [
            model.vertex_count(),
            model.primitives.iter().map(|p| p.indices.len()).sum(),
            model.rigid.iter().map(|p| p.positions.len()).sum(),
            model.joints.len(),
            model.clips.len(),
        ];
        assert_eq!(found, counts, "{file}");
        assert_eq!(Path::new(file).file_stem().unwrap(), model.name.as_str());
        check_invariants(&model, file);
    }
}

#[test]
fn files_without_skin_are_refused() {
    for path in WITHOUT_SKIN.iter().filter_map(|file| shared(file)) {
        let error = import(&path).unwrap_err().to_string();
        assert!(error.contains("no mesh has a skin") && error.contains("armature"), "{error}");
        assert!(error.contains(&path.display().to_string()), "{error}");
    }
}

#[test]
fn no_shared_file_is_forgotten() {
    let Some(root) = shared(".") else { return };
    let mut known: Vec<&str> = CHARACTERS.iter().map(|(file, _)| *file).chain(WITHOUT_SKIN).collect();
    known.sort_unstable();
    let mut found = Vec::new();
    for folder in std::fs::read_dir(&root).unwrap().map(|f| f.unwrap().path()).filter(|f| f.is_dir()) {
        for file in std::fs::read_dir(&folder).unwrap().map(|f| f.unwrap().path()) {
            if file.extension().is_some_and(|e| e == "glb" || e == "gltf" || e == "vrm") {
                found.push(file.strip_prefix(&root).unwrap().to_str().unwrap().to_owned());
            }
        }
    }
    found.sort_unstable();
    assert_eq!(found, known);
}

/// What the model's documentation promises.
fn check_invariants(model: &Model, file: &str) {
    for p in &model.primitives {
        let vertices = p.positions.len();
        assert!(p.stride >= 4 && p.stride.is_multiple_of(4), "{file}");
        assert_eq!([p.joints.len(), p.weights.len()], [vertices * p.stride; 2], "{file}");
        assert_eq!(p.normals.len(), vertices, "{file}");
        assert!(p.uvs.is_empty() || p.uvs.len() == vertices, "{file}");
        assert!(p.joints.iter().all(|j| usize::from(*j) < model.joints.len()), "{file}");
        assert!(p.indices.as_flattened().iter().all(|v| (*v as usize) < vertices), "{file}");
        assert!(p.material.is_none_or(|m| m < model.materials.len()), "{file}");
        for weights in p.weights.chunks_exact(p.stride) {
            assert!(weights.is_sorted_by(|a, b| a >= b) && weights.iter().all(|w| *w >= 0.0), "{file}");
            assert!((weights.iter().sum::<f32>() - 1.0).abs() < 1e-6, "{file}: {weights:?}");
        }
        for n in &p.normals {
            assert!((n.iter().map(|x| x * x).sum::<f32>() - 1.0).abs() < 1e-5, "{file}: {n:?}");
        }
    }
    for channel in model.clips.iter().flat_map(|c| &c.channels) {
        assert!(channel.node < model.nodes.len(), "{file}");
        assert!(!channel.times.is_empty() && channel.times.is_sorted_by(|a, b| a < b), "{file}");
    }
    assert!(model.rest_positions().iter().all(|p| p.is_finite()), "{file}");
}

#[test]
fn rest_pose_stands_as_viewers_show_it() {
    // Sizes from the data's documentation: CesiumMan 1.5 m tall (Z-up data under a rotated root), the bunny 4.2 m,
    // the Fox about 155 units long.
    for (file, axis, size, tolerance) in [
        ("khronos/CesiumMan.glb", 1, 1.5, 0.05),
        ("big-buck-bunny/bunny.glb", 1, 4.2, 0.05),
        ("khronos/Fox.glb", 2, 155.0, 5.0),
    ] {
        let Some(model) = load(file) else { continue };
        let along: Vec<f64> = model.rest_positions().iter().map(|p| p[axis]).collect();
        let extent =
            along.iter().copied().fold(f64::MIN, f64::max) - along.iter().copied().fold(f64::MAX, f64::min);
        assert!((extent - size).abs() < tolerance, "{file}: {extent}");
    }
}

#[test]
fn clips_have_names_and_lengths() {
    let Some(model) = load("mesh2motion/fox.glb") else { return };
    let clip = |name: &str| model.clips.iter().find(|c| c.name == name).unwrap();
    for (name, seconds) in [("Bark", 2.80), ("Bite", 0.87), ("Rest Pose", 0.33), ("Idle Alert", 1.60)] {
        assert!((clip(name).duration - seconds).abs() < 0.005, "{name}: {}", clip(name).duration);
    }
}

#[test]
fn spring_bones_of_both_vrm_versions_are_collected() {
    if let Some(model) = load("godette-vrm/Godette_vrm_v4.vrm") {
        // Eight chains: hair buns 10, 12, 14, fringe 16, 18, 20, 22, ribbon 58; each with one node below.
        let spring_nodes = (10..=23).chain([58, 59]).collect();
        assert_eq!(model.vrm.unwrap(), Vrm { major_version: 0, spring_nodes });
    }
    if let Some(model) = load("vrm1-springbone/smoke_spring.vrm") {
        assert_eq!(model.vrm.unwrap(), Vrm { major_version: 1, spring_nodes: vec![19, 20, 21, 22] });
    }
}

#[test]
fn morphs_textures_and_names_are_noted() {
    if let Some(model) = load("sintel/sintel.glb") {
        assert_eq!(model.primitives.iter().filter(|p| p.morphs).count(), 2);
    }
    if let Some(model) = load("big-buck-bunny/bunny.glb") {
        let material = &model.materials[model.primitives[0].material.unwrap()];
        assert!(material.texture.is_some() && !model.primitives[0].uvs.is_empty());
        assert!(model.nodes.iter().any(|n| n.name == "head"));
    }
}

#[test]
fn a_missing_buffer_is_an_error_a_missing_texture_is_not() {
    let Some(path) = shared("asset-generator/Animation_Skin_00.gltf") else { return };
    let bytes = std::fs::read(&path).unwrap();
    let folder = path.parent().unwrap();
    let missing = |uri: &str| sinew_bake::Error::unusable("x.gltf", uri, "missing", "put it there");
    let model = import_bytes("x.gltf", &bytes, &mut |uri| match uri.strip_suffix(".bin") {
        Some(_) => Ok(std::fs::read(folder.join(uri)).unwrap()),
        None => Err(missing(uri)),
    });
    assert!(model.unwrap().materials.iter().all(|m| m.texture.is_none()));
    let error = import_bytes("x.gltf", &bytes, &mut |uri| Err(missing(uri))).unwrap_err().to_string();
    assert!(error.contains("Animation_Skin_00.bin: missing"), "{error}");
    let cut = import_bytes("x.gltf", &bytes, &mut |_| Ok(vec![0; 10])).unwrap_err().to_string();
    assert!(cut.contains("10 bytes where the file promises 392"), "{cut}");
}
