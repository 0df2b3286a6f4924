//! One hash on every target: the built-in character, baked and played for 600 frames.
//!
//! The constants are what every target and every build must give; `wasm/test/golden.test.mjs` asserts the same.
//! A change of the recipe, of the built-in character or of any number of the runtime changes them: then
//! `cargo test -p sinew-tests golden` prints the new ones, and the commit says why.

use sinew::replay::{Extent, Replay, Tape, Verdict, verify};
use sinew::{Asset, Character, Root};
use sinew_bake::recipe::{Recipe, flesh};
use sinew_bake::{builtin, pack};

/// Content hash of the built-in character's asset.
const ASSET: u64 = 0x5159_9b1e_d303_687b;
/// Digest of the 600 frames.
const REPLAY: u64 = 0x42fd_34b2_7db7_cb51;
/// Frames.
const FRAMES: u32 = 600;

/// Frame `i`: clip, its time, and the root; every number is exact in binary.
fn input(i: u32) -> (u32, f32, Root) {
    let part = |k: u32, n: u32| f64::from(i * k % n) / 256.0;
    #[allow(clippy::cast_possible_truncation, reason = "exact")]
    let turn = (part(3, 64) - 0.125) as f32;
    let root =
        Root { translation: [part(5, 64), part(7, 32), -part(1, 128)], rotation: [0.0, turn, 0.0, 1.0] };
    #[allow(clippy::cast_possible_truncation, reason = "exact")]
    let time = (f64::from(i % 96) / 64.0) as f32;
    (i / 150, time, root)
}

fn asset() -> Vec<u8> {
    let model = builtin::character();
    let flesh = flesh(&model, &Recipe::default()).expect("flesh");
    pack::pack(&model, &flesh, 0).expect("an asset")
}

fn play(aligned: &[u32]) -> (Vec<u8>, u64) {
    let asset = Asset::parse(bytemuck::cast_slice(aligned)).expect("a valid asset");
    let mut memory = vec![0.0; Character::required_len(&asset)];
    let mut character = Character::new(asset, &mut memory).expect("memory fits");
    let mut tape = Tape::begin(&character, 120, Vec::new()).expect("a vector takes everything");
    for i in 0..FRAMES {
        let (clip, time, root) = input(i);
        tape.step_clip(&mut character, clip, time, root, 1.0 / 64.0).expect("valid input");
    }
    let (bytes, finished) = tape.finish(&character).expect("a vector takes everything");
    (bytes, finished.digest)
}

#[test]
fn golden_replay_of_the_built_in_character() {
    let bytes = asset();
    let aligned = pack::align(&bytes);
    let hash = Asset::parse(bytemuck::cast_slice(&aligned)).expect("a valid asset").hash;
    let (replay, digest) = play(&aligned);
    assert_eq!(
        (format!("{hash:#018x}"), format!("{digest:#018x}")),
        (format!("{ASSET:#018x}"), format!("{REPLAY:#018x}")),
        "asset and replay: found, expected"
    );
    let asset = Asset::parse(bytemuck::cast_slice(&aligned)).expect("a valid asset");
    let mut memory = vec![0.0; Character::required_len(&asset)];
    let mut character = Character::new(asset, &mut memory).expect("memory fits");
    let replay = Replay::parse(&replay).expect("a replay");
    let verdict = verify(&mut character, &replay, Extent::Whole, |_, _| {}).expect("the same asset");
    assert_eq!(verdict, Verdict::Same { frames: u64::from(FRAMES) });
}
