//! The golden frames on this machine, of an asset baked here; see [`sinew_target::golden`].

use sinew::Asset;
use sinew_bake::pack;
use sinew_target::golden::{ASSET, Played, REPLAY, verified};
use sinew_tests::golden;

#[test]
fn golden_replay_of_the_built_in_character() {
    let aligned = pack::align(&golden::asset());
    let asset = Asset::parse(bytemuck::cast_slice(&aligned)).expect("a valid asset");
    let played = Played::new(asset);
    assert_eq!(
        (format!("{:#018x}", asset.hash), format!("{:#018x}", played.digest)),
        (format!("{ASSET:#018x}"), format!("{REPLAY:#018x}")),
        "asset and replay: found, expected"
    );
    assert_eq!(verified(asset, &played.replay), Ok(()));
}

/// The microcontroller's asset is made anew here, byte for byte.
#[test]
fn golden_tube_of_the_microcontroller() {
    let made = sinew_tests::tube::asset(1.0);
    let kept = include_bytes!("../mcu/tube.sinew");
    assert_eq!(bytemuck::cast_slice::<u32, u8>(&made), kept, "write it anew");
}
