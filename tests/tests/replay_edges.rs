//! Replays at the edges: another asset, no room, rollback.

use sinew::replay::{
    Cursor, Extent, HeaderField, Recorder, Replay, ReplayError, Stage, SyncVerdict, sync_test, verify,
};
use sinew::{Asset, Character, Pose, Stepped};
use sinew_tests::asset_bytes;
use sinew_tests::recording::{pose, record, root, with_character};

#[test]
fn another_asset_is_refused() {
    let bytes = with_character(|c| record(c, 0));
    let mut other = asset_bytes::tube();
    let last = other.len() - 2;
    other[last] ^= 1; // a key of the clip
    asset_bytes::seal(&mut other);
    let words = asset_bytes::aligned(&other);
    let asset = Asset::parse(bytemuck::cast_slice(&words)).expect("a valid asset");
    let mut memory = vec![0.0; Character::required_len(&asset)];
    let mut character = Character::new(asset, &mut memory).expect("the length asked for");
    let replay = Replay::parse(&bytes).expect("a whole replay");
    let recorded = replay.header(HeaderField::AssetHash);
    let result = verify(&mut character, &replay, Extent::Whole, |_, _| {});
    assert_eq!(result, Err(ReplayError::OtherAsset { recorded, found: asset.hash }));
}

#[test]
fn a_full_sink_is_told_and_its_part_is_refused() {
    let whole = with_character(|c| short(c, usize::MAX)).expect("room");
    for len in 0..whole.len() {
        assert_eq!(with_character(|c| short(c, len)), None, "{len} bytes");
    }
    assert_eq!(with_character(|c| short(c, whole.len())), Some(whole));
}

/// A step recorded into `len` bytes.
fn short(character: &mut Character<'_>, len: usize) -> Option<Vec<u8>> {
    let mut buffer = vec![0; len.min(1 << 16)];
    let mut recorder = Recorder::new(character, 0, Cursor::new(&mut buffer)).ok()?;
    recorder.teleport().ok()?;
    recorder.step_clip(0, 0.1, root(0), 0.1).ok()?;
    recorder.finish().ok().map(|(sink, _)| sink.bytes().to_vec())
}

#[test]
fn stepping_again_after_a_rollback_is_the_same() {
    with_character(|c| {
        let mut memory = vec![0; 2 * c.state_len()];
        for i in 0..20 {
            let dt = if i % 5 == 3 { 0.0 } else { 0.02 };
            let step = |c: &mut Character<'_>| c.step(Pose { root: root(i), root_from_joint: &pose(i) }, dt);
            let held = if dt > 0.0 { Stepped::Advanced } else { Stepped::Held };
            assert_eq!(sync_test(c, step, &mut memory), Ok(SyncVerdict::Same(Ok(held))), "step {i}");
        }
        // A step that hides a state of its own is found out.
        let mut calls = 0_u8;
        let verdict = sync_test(
            c,
            |c| {
                calls += 1;
                c.step(Pose { root: root(20), root_from_joint: &pose(20 + calls) }, 0.02)
            },
            &mut memory,
        );
        let Ok(SyncVerdict::Different { stage: Some(Stage::Pose), detail: Some(detail) }) = verdict else {
            panic!("{verdict:?}")
        };
        assert_eq!(detail.place.stage(), Stage::Skin);
        assert!(sync_test(c, |_| Ok(Stepped::Held), &mut memory[1..]).is_err());
    });
}
