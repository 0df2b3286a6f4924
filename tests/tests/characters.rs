//! Every skinned character of the shared data is baked and played; every other file is refused with a reason.

use sinew::{Asset, Character};
use sinew_bake::play::{Player, Settings};
use sinew_bake::recipe::{Recipe, flesh};
use sinew_bake::{import, pack};
use std::path::{Path, PathBuf};

/// Files without a skin: refused.
const REFUSED: [&str; 3] =
    ["Buffer_Interleaved_00.gltf", "Buffer_Interleaved_01.gltf", "MorphStressTest.gltf"];

fn files() -> Vec<PathBuf> {
    let data = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../shared/data");
    let mut stack = vec![data];
    let mut out = Vec::new();
    while let Some(folder) = stack.pop() {
        for entry in std::fs::read_dir(folder).into_iter().flatten().flatten() {
            let path = entry.path();
            let ending = path.extension().unwrap_or_default().to_string_lossy().into_owned();
            if path.is_dir() {
                stack.push(path);
            } else if ["glb", "gltf", "vrm"].contains(&ending.as_str()) {
                out.push(path);
            }
        }
    }
    out.sort();
    out
}

#[test]
fn every_character_is_baked_and_played() {
    let files = files();
    if files.is_empty() {
        assert!(std::env::var_os("CI").is_none(), "the shared data is missing");
        println!("skipped: the shared data is missing");
        return;
    }
    assert!(files.len() >= 39, "only {} files", files.len());
    for path in files {
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        let model = import::import(&path);
        if REFUSED.contains(&name.as_str()) {
            let error = model.expect_err("a file without a skin").to_string();
            assert!(error.contains("skin"), "{name}: {error}");
            continue;
        }
        let model = model.unwrap_or_else(|e| panic!("{e}"));
        let flesh = flesh(&model, &Recipe::default()).unwrap_or_else(|e| panic!("{e}"));
        let aligned = pack::align(&pack::pack(&model, &flesh, 0).unwrap_or_else(|e| panic!("{e}")));
        let asset = Asset::parse(bytemuck::cast_slice(&aligned)).expect("a valid asset");
        let mut memory = vec![0.0; Character::required_len(&asset)];
        let settings = Settings { seconds: Some(0.5), ..Settings::default() };
        let mut player = Player::new(&model, asset, &mut memory, &settings).unwrap_or_else(|e| panic!("{e}"));
        let mut largest = 0.0_f32;
        while let Some(frame) = player.next().unwrap_or_else(|e| panic!("{e}")) {
            assert!(frame.flesh.as_flattened().iter().all(|x| x.is_finite()), "{name}: not finite");
            largest = frame.heat.iter().copied().fold(largest, f32::max);
        }
        let limit = asset.regions.iter().map(|r| r[2] * r[3]).fold(0.0, f32::max);
        assert!(largest <= 1.01 * limit, "{name}: offset {largest}, limit {limit}");
        println!(
            "{name}: {} of {} points, largest offset {largest:.4}",
            asset.meta.active, asset.meta.points
        );
    }
}
