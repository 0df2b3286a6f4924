//! One hash on every target: 600 frames of a character.
//!
//! The constants are what every target and every build must give; the tests of the npm package assert the same.
//! A change of the recipe, of the built-in character or of any number of the runtime changes them: then
//! `cargo test -p sinew-tests golden` prints the new ones, and the commit says why.

use super::{Named, of_words};
use sinew::replay::{Extent, Replay, Tape, Verdict, verify};
use sinew::{Asset, Character, Root};

/// Content hash of the built-in character's asset.
pub const ASSET: u64 = 0x5159_9b1e_d303_687b;
/// Digest of the 600 frames.
pub const REPLAY: u64 = 0x42fd_34b2_7db7_cb51;
/// Frames.
pub const FRAMES: u32 = 600;

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

/// The golden frames, played.
#[derive(Debug)]
pub struct Played {
    /// Digests of each frame: pose, skin, dynamics, embed.
    stages: [Vec<u64>; 4],
    /// The recording.
    pub replay: Vec<u8>,
    /// Its digest.
    pub digest: u64,
}

impl Played {
    /// Plays them.
    ///
    /// # Panics
    ///
    /// If `asset` is not the built-in character's.
    #[must_use]
    pub fn new(asset: Asset<'_>) -> Self {
        let mut memory = vec![0.0; Character::required_len(&asset)];
        let mut character = Character::new(asset, &mut memory).expect("memory fits");
        let mut tape = Tape::begin(&character, 120, Vec::new()).expect("a vector takes everything");
        let mut stages = [const { Vec::new() }; 4];
        for i in 0..FRAMES {
            let (clip, time, root) = input(i);
            tape.step_clip(&mut character, clip, time, root, 1.0 / 64.0).expect("valid input");
            let d = character.digests();
            stages.iter_mut().zip([d.pose, d.skin, d.dynamics, d.embed]).for_each(|(s, d)| s.push(d));
        }
        let (replay, finished) = tape.finish(&character).expect("a vector takes everything");
        Self { stages, replay, digest: finished.digest }
    }

    /// A digest a stage, and [`Self::digest`] as `golden`.
    pub(crate) fn digests(self) -> Vec<Named> {
        let names = ["pose", "skin", "dynamics", "embed"].map(|stage| format!("stage {stage}"));
        let stages = names.into_iter().zip(self.stages).map(|(name, frames)| (name, of_words(frames)));
        stages.chain([("golden".to_owned(), self.digest)]).collect()
    }
}

/// Compares every frame with a recording of [`Played`].
///
/// # Errors
///
/// Where they differ first, or why they cannot be compared.
pub fn verified(asset: Asset<'_>, replay: &[u8]) -> Result<(), String> {
    let mut memory = vec![0.0; Character::required_len(&asset)];
    let mut character = Character::new(asset, &mut memory).map_err(|e| e.to_string())?;
    let replay = Replay::parse(replay).map_err(|e| format!("replay: {e}"))?;
    match verify(&mut character, &replay, Extent::Whole, |_, _| {}).map_err(|e| format!("replay: {e}"))? {
        Verdict::Same { frames } if frames == u64::from(FRAMES) => Ok(()),
        Verdict::Same { frames } => Err(format!("replay: {frames} frames instead of {FRAMES}")),
        Verdict::Different(difference) => Err(format!("replay: {difference}")),
    }
}
