//! The asset's reader against damage: error or the same asset, never a panic.

use sinew::asset::layout::HASH_OFFSET;
use sinew::{Affine, Asset, AssetError, Character, Pose, Root};
use sinew_tests::asset_bytes::{aligned, seal, tube};

fn parse(words: &[u32], len: usize) -> Result<Asset<'_>, AssetError> {
    Asset::parse(&bytemuck::cast_slice(words)[..len])
}

#[test]
fn the_tube_is_valid_and_moves() {
    let bytes = tube();
    let words = aligned(&bytes);
    let asset = parse(&words, bytes.len()).expect("a valid asset");
    assert_eq!((asset.clip(0).map(|c| c.name), asset.region_name(1)), (Some("sway"), "middle"));
    assert_eq!(run(asset).map(|offsets| offsets > 1e-3), Some(true));
}

/// Steps through the clip and to poses; the largest offset, if all is finite.
fn run(asset: Asset<'_>) -> Option<f32> {
    let mut memory = vec![0.0; Character::required_len(&asset)];
    let mut character = Character::new(asset, &mut memory).expect("the length asked for");
    for frame in 0..4_u8 {
        let t = f32::from(frame) * 0.125;
        // A hostile asset may refuse steps, which is fine.
        let _ = character.step_clip(0, t, Root::default(), 0.125);
        let [x, y, z, _] = sinew::math::affine::IDENTITY;
        let pose: Vec<Affine> = vec![[x, y, z, [t, 0.0, 0.0]]; asset.meta.joints as usize];
        let _ = character.step(Pose { root: Root::default(), root_from_joint: &pose }, 0.125);
    }
    let positions = character.positions().as_flattened();
    let largest = character.offsets().as_flattened().iter().fold(0.0, |a: f32, b| a.max(b.abs()));
    positions.iter().chain(character.normals().as_flattened()).all(|x| x.is_finite()).then_some(largest)
}

#[test]
fn a_copy_may_lie_anywhere() {
    let bytes = tube();
    let words = aligned(&bytes);
    let there = parse(&words, bytes.len()).expect("a valid asset");
    for shift in 0..4 {
        let shifted = [&vec![0xAA; shift][..], &bytes].concat();
        let mut buffer = vec![0; bytes.len().div_ceil(4) + shift];
        let here = Asset::parse_into(&shifted[shift..], &mut buffer).expect("a valid asset");
        assert_eq!((here.hash, here.rest, here.regions), (there.hash, there.rest, there.regions));
        assert_eq!(run(here), run(there), "{shift} bytes off");
        let mut short = vec![0; bytes.len().div_ceil(4) - 1];
        let refused = Asset::parse_into(&shifted[shift..], &mut short).map(|asset| asset.hash);
        let (expected, found) = (bytes.len() as u64, short.len() as u64 * 4);
        assert_eq!(refused, Err(AssetError::TooShort { expected, found }));
    }
}

#[test]
fn every_truncation_is_an_error() {
    let bytes = tube();
    let words = aligned(&bytes);
    for len in 0..bytes.len() {
        assert!(parse(&words, len).is_err(), "{len} bytes");
    }
    let mut longer = words;
    longer.push(0);
    for extra in 1..=4 {
        assert!(parse(&longer, bytes.len() + extra).is_err(), "{extra} bytes more");
    }
}

#[test]
fn every_flipped_bit_is_an_error() {
    let bytes = tube();
    let mut words = aligned(&bytes);
    for bit in 0..bytes.len() * 8 {
        words[bit / 32] ^= 1 << (bit % 32);
        assert!(parse(&words, bytes.len()).is_err(), "bit {bit}");
        words[bit / 32] ^= 1 << (bit % 32);
    }
    assert!(parse(&words, bytes.len()).is_ok(), "all bits are back");
}

/// Content that is hostile, not damaged: the hash fits. What is accepted must run.
#[test]
fn every_flipped_bit_under_a_true_hash_is_an_error_or_runs() {
    let bytes = tube();
    let (mut accepted, mut refused) = (0, 0);
    for bit in (0..bytes.len() * 8).filter(|bit| !(HASH_OFFSET..HASH_OFFSET + 8).contains(&(bit / 8))) {
        let mut hostile = bytes.clone();
        hostile[bit / 8] ^= 1 << (bit % 8);
        seal(&mut hostile);
        let words = aligned(&hostile);
        match parse(&words, hostile.len()) {
            Err(_) => refused += 1,
            Ok(asset) => {
                accepted += 1;
                assert!(
                    run(asset).is_some(),
                    "bit {bit} (byte {}) makes numbers that are not finite",
                    bit / 8
                );
            }
        }
    }
    assert!(accepted > 1000 && refused > 1000, "{accepted} accepted, {refused} refused");
}

#[test]
fn misaligned_bytes_are_refused() {
    let bytes = tube();
    let mut shifted = vec![0_u8; bytes.len() + 8];
    let start = bytemuck::cast_slice::<u32, u8>(&aligned(&bytes)).len(); // whole words
    assert_eq!(start, bytes.len(), "the tube fills whole words");
    for shift in 0..4 {
        shifted[shift..shift + bytes.len()].copy_from_slice(&bytes);
        let slice = &shifted[shift..shift + bytes.len()];
        let is_aligned = slice.as_ptr().addr().is_multiple_of(4);
        assert_eq!(Asset::parse(slice).is_ok(), is_aligned, "shift {shift}");
    }
}
