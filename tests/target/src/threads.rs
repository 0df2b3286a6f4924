//! A crowd on 1, 2, 3 and 7 threads.

use super::{Named, of_words};
use sinew::{Affine, Asset, Character, Pose, Root, step_batch};
use std::thread;

/// Characters.
const CROWD: usize = 15;
/// Frames.
const FRAMES: u8 = 10;

/// A digest a number of threads.
pub(crate) fn digests(asset: Asset<'_>) -> Vec<Named> {
    // The machine without threads runs the batch on its only one.
    let counts: &[usize] = if cfg!(target_family = "wasm") { &[1] } else { &[1, 2, 3, 7] };
    counts
        .iter()
        .map(|n| (format!("crowd on {n} thread{}", if *n == 1 { "" } else { "s" }), crowd(asset, *n)))
        .collect()
}

fn crowd(asset: Asset<'_>, threads: usize) -> u64 {
    let mut memories = vec![vec![0.0; Character::required_len(&asset)]; CROWD];
    let mut characters: Vec<Character<'_>> =
        memories.iter_mut().map(|memory| Character::new(asset, memory).expect("memory fits")).collect();
    let share = CROWD.div_ceil(threads);
    if threads == 1 {
        advance(&mut characters, 0, asset.meta.joints as usize);
    } else {
        thread::scope(|scope| {
            for (i, part) in characters.chunks_mut(share).enumerate() {
                scope.spawn(move || advance(part, i * share, asset.meta.joints as usize));
            }
        });
    }
    of_words(characters.iter().flat_map(|c| {
        let d = c.digests();
        [d.pose, d.skin, d.dynamics, d.embed]
    }))
}

/// Sways each character, the `first`-th and following of the crowd, in its own time.
fn advance(characters: &mut [Character<'_>], first: usize, joints: usize) {
    for frame in 0..FRAMES {
        let poses: Vec<Vec<Affine>> =
            (first..).take(characters.len()).map(|i| pose(frame, i, joints)).collect();
        let poses: Vec<Pose<'_>> =
            poses.iter().map(|p| Pose { root: Root::default(), root_from_joint: p }).collect();
        let batch = step_batch(characters, &poses, 1.0 / 64.0).expect("a pose a character");
        assert_eq!(batch.advanced, characters.len(), "{:?}", batch.refusal);
    }
}

/// Every joint moves with its neighbor's lag; every number is exact in binary.
fn pose(frame: u8, character: usize, joints: usize) -> Vec<Affine> {
    let sway = |joint: usize| {
        #[allow(clippy::cast_precision_loss, reason = "below 64")]
        let phase = ((usize::from(frame) * (character + 1) + joint) % 64) as f32;
        (phase - 32.0) * (1.0 / 256.0)
    };
    let [x, y, z, _] = sinew::math::affine::IDENTITY;
    (0..joints).map(|joint| [x, y, z, [sway(joint), 0.0, -sway(joint + 7)]]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn characters_of_the_crowd_differ() {
        assert_ne!(pose(3, 0, 4), pose(3, 1, 4), "each has its own time");
    }
}
