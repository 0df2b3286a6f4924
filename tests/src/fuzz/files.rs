//! Files: assets, replays, characters, recipes, tunables.

use super::{assert_finite, assert_state_returns, reseal, with_tube};
use crate::asset_bytes::{aligned, seal};
use crate::recording::{pose, root};
use crate::tube;
use sinew::asset::layout::HEADER_LEN;
use sinew::replay::{Extent, Replay, Verdict, verify};
use sinew::{Asset, Character, Pose, Root};
use sinew_bake::dataset::Reader;
use sinew_bake::pose::bvh::Bvh;
use sinew_bake::recipe::{Recipe, flesh};
use sinew_bake::tunables::TunablesFile;
use sinew_bake::{Error, Model, import, pack};
use std::io::Cursor;

/// Most memory, in floats, of a character that is tried: larger ones are right, but slow to try.
const MOST_MEMORY: usize = 1 << 22;
/// Most vertices of a model that is baked.
const MOST_VERTICES: usize = 5_000;

/// Bytes as they are, then with length and hash made to fit.
pub(super) fn asset(bytes: &[u8]) {
    play(bytes);
    let mut bytes = bytes.to_vec();
    if bytes.len() >= HEADER_LEN {
        let len = u32::try_from(bytes.len()).unwrap_or(u32::MAX);
        bytes[8..12].copy_from_slice(&len.to_le_bytes());
        seal(&mut bytes);
        play(&bytes);
    }
}

/// Plays bytes that are an asset.
fn play(bytes: &[u8]) {
    let words = aligned(bytes);
    let Ok(asset) = Asset::parse(&bytemuck::cast_slice(&words)[..bytes.len()]) else { return };
    if Character::required_len(&asset) <= MOST_MEMORY {
        let mut memory = vec![0.0; Character::required_len(&asset)];
        live(&mut Character::new(asset, &mut memory).expect("the length asked for"));
    }
}

/// A short life with everything in it.
fn live(c: &mut Character<'_>) {
    let joints = vec![sinew::math::affine::IDENTITY; c.asset().joint_from_bind.len()];
    for frame in 0..6_u8 {
        let (t, dt) = (f32::from(frame) * 0.2, [0.01, 0.3, 2.0][usize::from(frame % 3)]);
        // Any of them may be refused: a clip may move joints out of reach.
        let _ = c.step_clip(u32::from(frame / 3), t, root(frame), dt);
        let _ = c.step_rest(root(frame), dt);
        let _ = c.step(Pose { root: root(frame), root_from_joint: &joints }, dt);
        assert_finite(c);
    }
    assert_state_returns(c);
    let vertices = c.positions().len();
    let (mut positions, mut normals) = (vec![[0.0; 3]; vertices], vec![[0.0; 3]; vertices]);
    assert_eq!(c.skin_surface(true, &mut positions, &mut normals), Ok(()), "buffers of its length");
    assert!(positions.iter().chain(&normals).flatten().all(|x| x.is_finite()), "skinned");
}

/// Bytes as they are, then with every check made to fit.
pub(super) fn replay(bytes: &[u8]) {
    rerun(bytes);
    let mut bytes = bytes.to_vec();
    reseal::replay(&mut bytes);
    rerun(&bytes);
}

fn rerun(bytes: &[u8]) {
    let Ok(replay) = Replay::parse(bytes) else { return };
    with_tube(|c| {
        for extent in [Extent::FirstDifference, Extent::Whole] {
            let told = match verify(c, &replay, extent, |_, _| {}) {
                Ok(Verdict::Different(difference)) => difference.to_string(),
                Ok(Verdict::Same { frames }) => frames.to_string(),
                Err(error) => error.to_string(),
            };
            assert!(!told.is_empty(), "every verdict has a text");
            assert_finite(c);
        }
    });
}

/// A file that stands alone: nothing is beside it.
fn alone(uri: &str) -> Result<Vec<u8>, Error> {
    Err(Error::unusable("fuzz", uri, "the file beside it is missing", "export it as one file"))
}

/// Imports, and where that goes bakes and plays.
pub(super) fn gltf(bytes: &[u8]) {
    match import::import_bytes("fuzz.glb", bytes, &mut |uri| alone(uri)) {
        Ok(model) if model.vertex_count() <= MOST_VERTICES => bake(&model, &Recipe::default()),
        Ok(_) => {}
        Err(error) => assert_told(&error),
    }
}

/// That an error is one line that says what to do.
fn assert_told(error: &Error) {
    let text = error.to_string();
    assert!(text.contains("; ") && !error.code().is_empty(), "no remedy: {text}");
}

fn bake(model: &Model, recipe: &Recipe) {
    match flesh(model, recipe).and_then(|flesh| pack::pack(model, &flesh, 0)) {
        Ok(bytes) => {
            let aligned = pack::align(&bytes);
            let asset = Asset::parse(bytemuck::cast_slice(&aligned)).expect("what was baked can be read");
            if Character::required_len(&asset) <= MOST_MEMORY {
                let mut memory = vec![0.0; Character::required_len(&asset)];
                live(&mut Character::new(asset, &mut memory).expect("the length asked for"));
            }
        }
        Err(error) => {
            assert_told(&error);
            // What the importer and the recipe let in must fit the format.
            assert!(!error.to_string().contains("please report"), "{error}");
        }
    }
}

/// Recipes for the tube.
pub(super) fn recipe(bytes: &[u8]) {
    let Ok(text) = core::str::from_utf8(bytes) else { return };
    match Recipe::from_toml("fuzz.toml", text) {
        Ok(recipe) => bake(&tube::model(1.0), &recipe),
        Err(error) => assert_told(&error),
    }
}

/// Tunables for the tube; what is taken must run.
pub(super) fn tunables(bytes: &[u8]) {
    let Ok(text) = core::str::from_utf8(bytes) else { return };
    with_tube(|c| match TunablesFile::read("fuzz.json", text, c.asset()) {
        Err(error) => assert_told(&error),
        Ok(tunables) => {
            c.set_tunables(&tunables).expect("what the reader takes is in range");
            for i in 0..4 {
                let joints = pose(i * 20);
                let root = Root { translation: [f64::from(i), 0.0, 0.0], ..root(i) };
                c.step(Pose { root, root_from_joint: &joints }, 0.02).expect("a valid frame");
                assert_finite(c);
            }
            assert_state_returns(c);
        }
    });
}

/// A recording: what is read is finite, and its joints are a tree.
pub(super) fn bvh(bytes: &[u8]) {
    let Ok(bvh) = Bvh::from_bytes("fuzz", bytes) else { return };
    assert!(bvh.joints.iter().enumerate().all(|(i, j)| j.parent.is_none_or(|p| p < i)), "parents come first");
    assert!(bvh.frame_time.is_finite() && bvh.frame_time > 0.0, "a time between frames");
    for frame in
        [0, bvh.frames() / 2, bvh.frames().saturating_sub(1)].into_iter().filter(|f| *f < bvh.frames())
    {
        let placed = bvh.placed(frame);
        assert!(placed.iter().all(|p| p.rotation.is_finite() && p.translation.is_finite()), "finite places");
    }
    let _ = bvh.first_frame();
}

/// Bytes as they are, then with the digest of the head made to fit.
pub(super) fn dataset(bytes: &[u8]) {
    walk(bytes);
    let Some(json) = bytes.get(12..16).map(|n| u32::from_le_bytes([n[0], n[1], n[2], n[3]]) as usize) else {
        return;
    };
    let mut bytes = bytes.to_vec();
    if json < bytes.len() && bytes.len() >= 16 + json + 8 {
        let digest = sinew::math::digest::of_bytes(&bytes[..16 + json]);
        bytes[16 + json..24 + json].copy_from_slice(&digest.to_le_bytes());
        walk(&bytes);
    }
}

/// Every sample that is promised is there or refused.
fn walk(bytes: &[u8]) {
    let Ok(mut reader) = Reader::over(vec![("fuzz".into(), Cursor::new(bytes))]) else { return };
    let indices: Vec<u64> = reader.indices().collect();
    let arrays = reader.header().arrays.len();
    for index in indices {
        if let Ok(sample) = reader.sample(index) {
            assert!(sample.index == index && sample.arrays.len() == arrays, "as the header says");
        }
    }
    let _ = reader.missing();
}
