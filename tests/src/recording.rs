//! A short recorded life of the tube, with everything that can happen in it.

use crate::asset_bytes;
use sinew::replay::{RecordError, Recorder};
use sinew::{Affine, Asset, Character, Pose, Root, StepError, Stepped, Tunables};

/// Steps of [`record`].
pub const FRAMES: u64 = 24;

/// Runs `f` with a new character on the tube.
///
/// # Panics
///
/// If the tube is not valid.
pub fn with_character<T>(f: impl FnOnce(&mut Character<'_>) -> T) -> T {
    let words = asset_bytes::aligned(&asset_bytes::tube());
    let asset = Asset::parse(bytemuck::cast_slice(&words)).expect("a valid asset");
    let mut memory = vec![0.0; Character::required_len(&asset)];
    f(&mut Character::new(asset, &mut memory).expect("the length asked for"))
}

/// The root at step `i`.
#[must_use]
pub fn root(i: u8) -> Root {
    let i = f32::from(i);
    Root { translation: [f64::from(i) * 0.03, 0.0, 1.0], rotation: [0.0, 0.02 * i, 0.0, 1.0] }
}

/// A pose at step `i`: the joints lean more and more.
#[must_use]
pub fn pose(i: u8) -> [Affine; 3] {
    [0.0, 0.5, 1.0].map(|y: f32| {
        let lean = 0.01 * f32::from(i) * y;
        [[1.0, 0.0, 0.0], [lean, 1.0, 0.0], [0.0, 0.0, 1.0], [lean, y, 0.0]]
    })
}

/// Records [`FRAMES`] steps with a snapshot after every `every`-th.
///
/// # Panics
///
/// If a step does not return what it should.
pub fn record(character: &mut Character<'_>, every: u32) -> Vec<u8> {
    let mut recorder = Recorder::new(character, every, Vec::new()).expect("memory");
    let mut saved = Vec::new();
    for i in 0..FRAMES {
        let i = u8::try_from(i).expect("few frames");
        events(&mut recorder, i, &mut saved).expect("valid events");
        let dt = if i == 3 { 0.0 } else { 0.02 };
        let joints = pose(i);
        let result = match i {
            11 => {
                let mut joints = joints;
                joints[1][3][2] = f32::NAN;
                recorder.step(Pose { root: root(i), root_from_joint: &joints }, dt)
            }
            12 => recorder.step_clip(9, 0.0, root(i), dt),
            13 => recorder.step_clip(0, 0.1, root(i), f32::INFINITY),
            _ if i % 2 == 0 => recorder.step(Pose { root: root(i), root_from_joint: &joints }, dt),
            _ => recorder.step_clip(0, f32::from(i) * dt, root(i), dt),
        };
        assert_eq!(result, expected(i), "frame {i}");
    }
    recorder.finish().expect("memory").0
}

fn expected(i: u8) -> Result<Stepped, RecordError> {
    match i {
        // dt = 0; frozen; every other step only.
        3 | 7 | 8 | 15 | 17 => Ok(Stepped::Held),
        11 => Err(RecordError::Step(StepError::BadJoint(1))),
        12 => Err(RecordError::Step(StepError::NoSuchClip(9))),
        13 => Err(RecordError::Step(StepError::TimeNotFinite)),
        _ => Ok(Stepped::Advanced),
    }
}

fn events(recorder: &mut Recorder<'_, '_, Vec<u8>>, i: u8, saved: &mut Vec<u8>) -> Result<(), RecordError> {
    match i {
        5 => recorder.set_tunables(&Tunables { wind: [0.5, 0.0, 1.0], ..*recorder.character().tunables() }),
        6 => {
            saved.resize(recorder.character().state_len(), 0);
            Ok(recorder.character().save_state(saved)?)
        }
        7 => recorder.freeze(true),
        9 => recorder.freeze(false),
        10 => recorder.teleport(),
        14 => recorder.load_state(saved),
        15 => recorder.set_rate_divisor(2),
        19 => recorder.set_rate_divisor(1),
        20 => recorder.settle(),
        22 => recorder.reset(),
        _ => Ok(()),
    }
}
