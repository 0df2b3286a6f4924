//! What moves a character: frames and the events between them.

use super::error::RecordError;
use super::format::{Tag, join, split};
use super::outcome::Outcome;
use crate::character::Character;
use crate::math::affine::Affine;
use crate::stage::pose::Root;
use crate::step::{Pose, StepError, Stepped};
use crate::tunables::Tunables;

/// A call between two steps.
#[derive(Clone, Copy, Debug, PartialEq)]
#[allow(clippy::large_enum_variant, reason = "one lives at a time, on the stack")]
pub enum Event<'a> {
    /// [`Character::set_tunables`].
    Tunables(Tunables),
    /// [`Character::reset`].
    Reset,
    /// [`Character::settle`].
    Settle,
    /// [`Character::teleport`].
    Teleport,
    /// [`Character::freeze`].
    Freeze(bool),
    /// [`Character::set_rate_divisor`].
    Divisor(u32),
    /// [`Character::load_state`].
    Load(&'a [u8]),
}

impl Event<'_> {
    /// Its tag in a replay.
    #[must_use]
    pub fn tag(&self) -> Tag {
        match self {
            Self::Tunables(_) => Tag::Tunables,
            Self::Reset => Tag::Reset,
            Self::Settle => Tag::Settle,
            Self::Teleport => Tag::Teleport,
            Self::Freeze(_) => Tag::Freeze,
            Self::Divisor(_) => Tag::Divisor,
            Self::Load(_) => Tag::Load,
        }
    }

    /// Does it.
    ///
    /// # Errors
    ///
    /// [`RecordError::Tunables`] or [`RecordError::State`] where the character refuses; nothing changes then.
    pub fn apply(&self, character: &mut Character<'_>) -> Result<(), RecordError> {
        match self {
            Self::Tunables(tunables) => character.set_tunables(tunables)?,
            Self::Reset => character.reset(),
            Self::Settle => character.settle(),
            Self::Teleport => character.teleport(),
            Self::Freeze(frozen) => character.freeze(*frozen),
            Self::Divisor(divisor) => character.set_rate_divisor(*divisor),
            Self::Load(state) => character.load_state(state)?,
        }
        Ok(())
    }
}

/// A recorded step.
#[derive(Clone, Copy, Debug)]
pub struct Frame<'a> {
    /// Number of the step, from 0.
    pub index: u64,
    /// Time, s.
    pub dt: f32,
    /// The root.
    pub root: Root,
    /// What moved the joints.
    pub motion: Motion<'a>,
    /// What came of it.
    pub outcome: Outcome,
    /// Whether the outcome is undamaged.
    pub intact: bool,
}

/// What moved the joints in a step.
#[derive(Clone, Copy, Debug)]
pub enum Motion<'a> {
    /// A pose.
    Pose(RecordedPose<'a>),
    /// A moment of one of the asset's clips.
    Clip {
        /// Index of the clip.
        clip: u32,
        /// Time in the clip, s.
        time: f32,
    },
}

/// A pose in the bytes of a replay: 12 floats and a check a joint.
#[derive(Clone, Copy, Debug)]
pub struct RecordedPose<'a>(pub(super) &'a [[u8; 52]]);

impl<'a> RecordedPose<'a> {
    /// `root_from_joint` of every joint, in the asset's order.
    #[must_use]
    pub fn joints(self) -> impl ExactSizeIterator<Item = Affine> + use<'a> {
        self.0.iter().map(|bytes| {
            let words = bytes.as_chunks::<4>().0;
            let at = |i: usize| words.get(i).map_or(0.0, |w| f32::from_le_bytes(*w));
            [0, 3, 6, 9].map(|c: usize| [0, 1, 2].map(|r: usize| at(c.saturating_add(r))))
        })
    }
}

impl Frame<'_> {
    /// Does the step.
    ///
    /// # Errors
    ///
    /// As [`Character::step`] and [`Character::step_clip`].
    pub fn run(&self, character: &mut Character<'_>) -> Result<Stepped, StepError> {
        match self.motion {
            Motion::Clip { clip, time } => character.step_clip(clip, time, self.root, self.dt),
            Motion::Pose(pose) => {
                // The character's own array for sampled joints is free here.
                let joints = core::mem::take(&mut character.memory.joints);
                for (to, from) in joints.iter_mut().zip(pose.joints()) {
                    *to = from;
                }
                let result = character.step(Pose { root: self.root, root_from_joint: joints }, self.dt);
                character.memory.joints = joints;
                result
            }
        }
    }
}

/// Words of a [`Root`].
pub(super) const ROOT_WORDS: usize = 10;

pub(super) fn root_to_words(root: &Root) -> [u32; ROOT_WORDS] {
    let [[x0, x1], [y0, y1], [z0, z1]] = root.translation.map(|x| split(x.to_bits()));
    let [a, b, c, d] = root.rotation.map(f32::to_bits);
    [x0, x1, y0, y1, z0, z1, a, b, c, d]
}

pub(super) fn root_from_words([x0, x1, y0, y1, z0, z1, a, b, c, d]: [u32; ROOT_WORDS]) -> Root {
    Root {
        translation: [[x0, x1], [y0, y1], [z0, z1]].map(|w| f64::from_bits(join(w))),
        rotation: [a, b, c, d].map(f32::from_bits),
    }
}
