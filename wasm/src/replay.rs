//! Replays run again.

use crate::asset::RawAsset;
use crate::error::Thrown;
use crate::memory::Aligned;
use sinew::Character;
use sinew::replay::{Extent, Replay, Verdict, verify};
use wasm_bindgen::prelude::wasm_bindgen;

/// What verifying a replay found.
#[wasm_bindgen]
#[derive(Debug)]
pub struct RawVerdict {
    verdict: Verdict,
    frames: u64,
    digest: u64,
}

#[wasm_bindgen]
impl RawVerdict {
    /// Runs a replay on a new character of `asset`, to the first difference.
    ///
    /// # Errors
    ///
    /// For bytes that are not a replay of this asset with undamaged inputs, and without memory.
    pub fn of(asset: &RawAsset, bytes: &[u8]) -> Result<Self, Thrown> {
        let replay = Replay::parse(bytes)?;
        let asset = *asset.0.borrow_dependent();
        let mut memory = Aligned::zeroed(Character::required_len(&asset) * size_of::<f32>())?;
        let mut character = Character::new(asset, memory.floats_mut())?;
        let verdict = verify(&mut character, &replay, Extent::FirstDifference, |_, _| {})?;
        let finished = replay.finished();
        Ok(Self { verdict, frames: finished.frames, digest: finished.digest })
    }

    /// Number of frames.
    #[must_use]
    pub fn frames(&self) -> u64 {
        self.frames
    }

    /// Digest of the whole run, 16 hexadecimal digits.
    #[must_use]
    pub fn digest(&self) -> String {
        format!("{:016x}", self.digest)
    }

    /// The first frame that differs.
    #[must_use]
    pub fn frame(&self) -> Option<u64> {
        match self.verdict {
            Verdict::Same { .. } => None,
            Verdict::Different(difference) => Some(difference.frame),
        }
    }

    /// The earliest stage that differs there, or nothing where it is the replay that is damaged.
    #[must_use]
    pub fn stage(&self) -> Option<String> {
        match self.verdict {
            Verdict::Same { .. } => None,
            Verdict::Different(difference) => difference.stage.map(|stage| stage.to_string()),
        }
    }

    /// The difference in words.
    #[must_use]
    pub fn difference(&self) -> Option<String> {
        match self.verdict {
            Verdict::Same { .. } => None,
            Verdict::Different(difference) => Some(difference.to_string()),
        }
    }
}
