//! What every target must agree on, from single operations up to a character: named digests.
//!
//! `cargo xtask targets` builds this for each of them, runs it, and compares. It needs nothing but the
//! runtime, so that it is quick to build where a compiler has to be emulated around.

mod functions;
pub mod golden;
mod network;
mod operations;
mod threads;

use sinew::math::digest::Digest;

/// A name, and the digest that goes with it.
pub type Named = (String, u64);

/// Digests of everything: operations of the machine first, so that what fails first is the cause.
///
/// # Errors
///
/// If the asset or the replay cannot be read, or the replay gives other bits here: frame, stage and place.
pub fn digests(asset: &[u8], replay: &[u8]) -> Result<Vec<Named>, String> {
    let mut words = vec![0; asset.len().div_ceil(4)];
    let asset = sinew::Asset::parse_into(asset, &mut words).map_err(|e| format!("asset: {e}"))?;
    let mut all = operations::digests();
    all.extend(functions::digests());
    all.extend(network::digests());
    golden::verified(asset, replay)?;
    all.extend(golden::Played::new(asset).digests());
    all.extend(threads::digests(asset));
    Ok(all)
}

/// Digest of words as they are, signs of zeros and subnormals included; NaN counts as one value.
fn of_words(words: impl IntoIterator<Item = u64>) -> u64 {
    let bytes: Vec<u8> = words.into_iter().flat_map(u64::to_le_bytes).collect();
    let mut digest = Digest::default();
    digest.bytes(&bytes);
    digest.finish()
}

/// Bits of `x`, of any NaN the same ones.
fn bits(x: f32) -> u64 {
    u64::from(if x.is_nan() { 0x7fc0_0000 } else { x.to_bits() })
}

/// Bits of `x`, of any NaN the same ones.
fn bits_wide(x: f64) -> u64 {
    if x.is_nan() { 0x7ff8_0000_0000_0000 } else { x.to_bits() }
}
