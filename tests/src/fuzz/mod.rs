//! What a fuzzer may try: targets as plain functions, seeds, and a mutator for where there is no libFuzzer.
//!
//! ```text
//! cargo-fuzz (tests/fuzz) ─▶ target(bytes) ◀─ mutate ◀─ seeds       (the binary `fuzz` of this crate)
//! ```
//!
//! A target panics where a promise is broken: a panic below it, a number that is not finite, a state that cannot be
//! loaded again. Bytes that are refused with a code are as good as any.

mod files;
pub mod mutate;
mod reseal;
mod running;
mod seeds;

use crate::asset_bytes::{aligned, tube};
use sinew::{Asset, Character};
use std::sync::LazyLock;

/// What is fuzzed.
#[derive(Clone, Copy, Debug)]
pub struct Target {
    /// Name of the target and of its folder of seeds.
    pub name: &'static str,
    /// Tries bytes.
    pub run: fn(&[u8]),
    /// Inputs to begin with, named; made anew by a command, from the project's own characters.
    pub seeds: fn() -> Vec<(&'static str, Vec<u8>)>,
}

/// All targets.
pub const TARGETS: [Target; 8] = [
    Target { name: "asset", run: files::asset, seeds: seeds::assets },
    Target { name: "replay", run: files::replay, seeds: seeds::replays },
    Target { name: "gltf", run: files::gltf, seeds: seeds::gltfs },
    Target { name: "recipe", run: files::recipe, seeds: seeds::recipes },
    Target { name: "tunables", run: files::tunables, seeds: seeds::tunables },
    Target { name: "bvh", run: files::bvh, seeds: seeds::bvhs },
    Target { name: "dataset", run: files::dataset, seeds: seeds::datasets },
    Target { name: "setters", run: running::setters, seeds: seeds::scripts },
];

/// The target called `name`.
#[must_use]
pub fn target(name: &str) -> Option<Target> {
    TARGETS.into_iter().find(|t| t.name == name)
}

/// Tries `bytes` on the target called `name`.
///
/// # Panics
///
/// Where a promise is broken, and for a name that is none.
pub fn run(name: &str, bytes: &[u8]) {
    let target = target(name).expect("the name of a target");
    (target.run)(bytes);
}

/// Runs `f` with a new character on the tube of [`crate::asset_bytes`], parsed once.
fn with_tube<T>(f: impl FnOnce(&mut Character<'_>) -> T) -> T {
    static WORDS: LazyLock<Vec<u32>> = LazyLock::new(|| aligned(&tube()));
    static ASSET: LazyLock<Asset<'static>> = LazyLock::new(|| crate::run::parse(&WORDS));
    let mut memory = vec![0.0; Character::required_len(&ASSET)];
    f(&mut Character::new(*ASSET, &mut memory).expect("memory fits"))
}

/// That all a character shows and keeps is finite.
fn assert_finite(c: &Character<'_>) {
    let finite = |v: &[[f32; 3]]| v.as_flattened().iter().all(|x| x.is_finite());
    let shown = [c.raw_offsets(), c.offsets(), c.positions(), c.normals()];
    assert!(shown.into_iter().all(finite), "numbers that are not finite");
}

/// That a state can be saved, loaded, and is then the same.
fn assert_state_returns(c: &mut Character<'_>) {
    let mut states = [vec![0; c.state_len()], vec![0; c.state_len()]];
    c.save_state(&mut states[0]).expect("its length");
    c.load_state(&states[0]).expect("its own state");
    c.save_state(&mut states[1]).expect("its length");
    assert!(states[0] == states[1], "a state comes back as it was saved");
}

#[cfg(test)]
mod tests {
    use super::TARGETS;

    #[test]
    fn every_seed_is_survived_and_there_are_some() {
        for target in TARGETS {
            let seeds = (target.seeds)();
            assert!(!seeds.is_empty(), "{} has no seeds", target.name);
            for (_, bytes) in seeds {
                (target.run)(&bytes);
            }
        }
    }
}
