//! Class 3, and damage to replays and states.

use crate::container::{recording, saved};
use crate::offer::{HARMLESS, Seen, asset, replay, state};
use sinew::replay::format::check;
use sinew_tests::asset_bytes::{aligned, tube};

/// What a flipped bit comes to.
pub(crate) const FLIPPED: &[Seen] = &[
    "ASSET_BAD_MAGIC",
    "ASSET_UNSUPPORTED_VERSION",
    "ASSET_WRONG_LENGTH",
    "ASSET_WRONG_HASH",
    "REPLAY_BAD_MAGIC",
    "REPLAY_DAMAGED_HEADER",
    "REPLAY_DAMAGED",
    "different",
    "STATE_BAD_HEADER",
    "STATE_OTHER_ASSET",
    "STATE_DAMAGED",
];

pub(crate) fn flipped() -> Vec<Seen> {
    let mut seen = every_bit(&tube(), asset);
    seen.extend(every_bit(&recording(), replay));
    seen.extend(every_bit(&saved(), state));
    seen
}

/// Offers the bytes with each bit flipped.
fn every_bit(whole: &[u8], offer: fn(&[u8]) -> Seen) -> Vec<Seen> {
    let mut words = aligned(whole);
    let offers = (0..whole.len() * 8).map(|bit| {
        bytemuck::cast_slice_mut::<u32, u8>(&mut words)[bit / 8] ^= 1 << (bit % 8);
        let seen = offer(&bytemuck::cast_slice(&words)[..whole.len()]);
        bytemuck::cast_slice_mut::<u32, u8>(&mut words)[bit / 8] ^= 1 << (bit % 8);
        assert_ne!(seen, HARMLESS, "bit {bit}");
        seen
    });
    offers.collect()
}

/// A replay whose header field `index` has another value, under a true check.
pub(crate) fn with_header(index: u32, value: u64) -> Seen {
    let mut bytes = recording();
    let at = 4 + 12 * index as usize;
    bytes[at..at + 8].copy_from_slice(&value.to_le_bytes());
    let (words, _) = bytes[at..at + 8].as_chunks::<4>();
    let check = check(u64::MAX, index, &[words[0], words[1]].map(u32::from_le_bytes));
    bytes[at + 8..at + 12].copy_from_slice(&check.to_le_bytes());
    replay(&bytes)
}
