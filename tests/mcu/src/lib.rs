//! A character small enough for a microcontroller, and what its frames must come to there.

#![no_std]

#[cfg(all(target_arch = "arm", target_os = "none"))]
pub mod board;
pub mod figures;
mod network;

pub use network::{INPUTS, NETWORK};

use core::hint::black_box;
use sinew::math::digest::Digest;
use sinew::{Asset, Character, Root};

/// Frames.
pub const FRAMES: u16 = 300;
/// Time of a frame, s.
pub const STEP: f32 = 1.0 / 64.0;
/// Floats of memory for the character and what it shows: those of the tube, exactly.
pub const MEMORY: usize = 10_938;
/// Digest of the frames.
pub const GOLDEN: u64 = 0xf74e_b531_187d_9c74;

/// Bytes on a multiple of 16, as an asset is read without copying.
#[derive(Debug)]
#[repr(C, align(16))]
pub struct Aligned<T: ?Sized>(pub T);

/// A soft tube on three joints: `sinew_tests::tube::asset(1.0)`, which its test compares.
pub static TUBE: &Aligned<[u8]> = &Aligned(*include_bytes!("../tube.sinew"));

/// Where a count of instructions is read: an emulator watches this address.
#[inline(never)]
pub fn mark() {
    // Else a call without effect would be left out.
    black_box(0_u32);
}

/// Where the count of every single instruction is read, and starts anew.
#[inline(never)]
pub fn detail() {
    // Not the value of `mark`: equal functions would become one.
    black_box(1_u32);
}

/// Floats that a character of `asset` needs, with the skinned vertices.
#[must_use]
pub fn required_len(asset: &Asset<'_>) -> usize {
    Character::required_len(asset) + 6 * asset.meta.vertices as usize
}

/// Vectors taken from the front of `memory`; `None` if they do not fit.
pub(crate) fn take<'a, const N: usize>(memory: &mut &'a mut [f32], n: usize) -> Option<&'a mut [[f32; N]]> {
    let (head, rest) = core::mem::take(memory).split_at_mut_checked(n.checked_mul(N)?)?;
    *memory = rest;
    Some(head.as_chunks_mut().0)
}

/// Plays the tube's clip, skins it, asks the network, and mixes the digests of all stages of all frames;
/// `None` for an asset that is refused or does not fit.
///
/// Four [`mark`]s a frame: before the step, the skinning of the vertices, the network, and after it.
#[must_use]
pub fn play(bytes: &[u8], mut memory: &mut [f32]) -> Option<u64> {
    let asset = Asset::parse(bytes).ok()?;
    let vertices = asset.meta.vertices as usize;
    let own = take::<1>(&mut memory, Character::required_len(&asset))?.as_flattened_mut();
    let (positions, normals) = (take(&mut memory, vertices)?, take(&mut memory, vertices)?);
    let mut character = Character::new(asset, own).ok()?;
    let mut all = Digest::default();
    for frame in 0..FRAMES {
        mark();
        let stepped = character.step_clip(0, time(frame), root(frame), STEP);
        mark();
        let skinned = character.skin_surface(true, positions, normals);
        mark();
        let answer = NETWORK.forward(&network::inputs(character.palette()));
        mark();
        stepped.ok()?;
        skinned.ok()?;
        let d = character.digests();
        for stage in [d.pose, d.skin, d.dynamics, d.embed] {
            all.bytes(&stage.to_le_bytes());
        }
        all.vectors(positions);
        all.vectors(normals);
        all.floats(&answer);
    }
    Some(all.finish())
}

/// Time of a frame in the clip, s.
fn time(frame: u16) -> f32 {
    f32::from(frame % 64) / 64.0
}

/// Where the root sways to.
fn root(frame: u16) -> Root {
    let sway = f64::from(frame % 32) / 256.0;
    Root { translation: [sway, 0.0, -sway], ..Root::default() }
}

#[cfg(test)]
mod tests {
    extern crate std;
    use super::*;

    #[test]
    fn golden_frames_of_the_tube() {
        let asset = Asset::parse(&TUBE.0).expect("the tube is an asset");
        assert_eq!(required_len(&asset), MEMORY, "the constant");
        let digest = play(&TUBE.0, &mut [0.0; MEMORY]).expect("the tube plays");
        assert_eq!(digest, GOLDEN, "as on a microcontroller: {digest:#018x}");
    }

    #[test]
    fn memory_that_is_too_short_is_refused() {
        assert_eq!(play(&TUBE.0, &mut [0.0; MEMORY - 1]), None, "one float short");
        assert_eq!(play(&TUBE.0[..100], &mut [0.0; MEMORY]), None, "half an asset");
    }

    #[test]
    fn the_figures_run() {
        let mut names = std::vec::Vec::new();
        let done = figures::run(&TUBE.0, &mut [0.0; MEMORY], &mut |name, _| {
            names.push(std::string::String::from(name));
        });
        assert_eq!((done, names.len()), (Some(()), 11), "{names:?}");
    }
}
