//! A character small enough for a microcontroller, and what its frames must come to there.

#![no_std]

use sinew::math::digest::Digest;
use sinew::{Asset, Character, Root};

/// Frames.
pub const FRAMES: u16 = 300;
/// Floats of working memory.
pub const MEMORY: usize = 16_384;
/// Digest of the frames.
pub const GOLDEN: u64 = 0x785c_6269_e8e0_3bcc;

/// Bytes on a multiple of 16, as an asset is read without copying.
#[derive(Debug)]
#[repr(C, align(16))]
pub struct Aligned<T: ?Sized>(pub T);

/// A soft tube on three joints: `sinew_tests::tube::asset(1.0)`, which its test compares.
pub static TUBE: &Aligned<[u8]> = &Aligned(*include_bytes!("../tube.sinew"));

/// Plays the tube's clip and mixes the digests of all stages of all frames; 0 for an asset that is refused.
#[must_use]
pub fn play(bytes: &[u8], memory: &mut [f32; MEMORY]) -> u64 {
    let Ok(asset) = Asset::parse(bytes) else { return 0 };
    let Some(memory) = memory.get_mut(..Character::required_len(&asset)) else { return 0 };
    let Ok(mut character) = Character::new(asset, memory) else { return 0 };
    let mut all = Digest::default();
    for frame in 0..FRAMES {
        let sway = f64::from(frame % 32) / 256.0;
        let root = Root { translation: [sway, 0.0, -sway], ..Root::default() };
        let time = f32::from(frame % 64) / 64.0;
        if character.step_clip(0, time, root, 1.0 / 64.0).is_err() {
            return 0;
        }
        let d = character.digests();
        for stage in [d.pose, d.skin, d.dynamics, d.embed] {
            all.bytes(&stage.to_le_bytes());
        }
    }
    all.finish()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn golden_frames_of_the_tube() {
        assert_eq!(play(&TUBE.0, &mut [0.0; MEMORY]), GOLDEN, "as on a microcontroller");
    }
}
