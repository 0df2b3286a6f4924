//! What came of a step.

use super::format::{join, split};
use crate::character::Character;
use crate::math::canary;
use crate::step::{Digests, StepError, Stepped};
use core::fmt;

/// Where two runs differ first, in the order of the data flow.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Stage {
    /// Time, root and tunables; what the step returned.
    Life,
    /// The palette.
    Pose,
    /// Targets and accelerations.
    Skin,
    /// State of the springs.
    Dynamics,
    /// Offsets, positions, normals.
    Embed,
}

impl fmt::Display for Stage {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Life => "life",
            Self::Pose => "pose",
            Self::Skin => "skin",
            Self::Dynamics => "dynamics",
            Self::Embed => "embed",
        })
    }
}

impl Stage {
    /// The earliest stage whose digests differ.
    #[must_use]
    pub fn first_difference(a: &Digests, b: &Digests) -> Option<Self> {
        let differ = [
            (Self::Pose, a.pose != b.pose),
            (Self::Skin, a.skin != b.skin),
            (Self::Dynamics, a.dynamics != b.dynamics),
            (Self::Embed, a.embed != b.embed),
        ];
        differ.into_iter().find_map(|(stage, differs)| differs.then_some(stage))
    }
}

/// What a step returned and what its stages made.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Outcome {
    returned: [u32; 2],
    /// [`canary::float_environment`] after the step.
    pub canary: u32,
    /// Digests of the stages; of a step that was held or refused only that of the dynamics, the others are 0.
    pub digests: Digests,
}

impl Outcome {
    pub(super) const WORDS: usize = 11;

    /// The outcome of a step of `character` that returned `result`.
    pub(super) fn of(character: &Character<'_>, result: Result<Stepped, StepError>) -> Self {
        let digests = match result {
            Ok(Stepped::Advanced) => character.digests(),
            _ => Digests::of_dynamics(&character.memory.state),
        };
        Self { returned: code(result), canary: canary::float_environment(), digests }
    }

    /// What the step returned; `None` for a code that no version writes.
    #[must_use]
    pub fn returned(&self) -> Option<Result<Stepped, StepError>> {
        let [code, argument] = self.returned;
        Some(match code {
            0 => Ok(Stepped::Advanced),
            1 => Ok(Stepped::Held),
            2 => Err(StepError::TimeNotFinite),
            3 => Err(StepError::BadRoot),
            4 => Err(StepError::BadJoint(argument)),
            5 => Err(StepError::NoSuchClip(argument)),
            7 => Err(StepError::FloatEnvironment(argument)),
            _ => return None,
        })
    }

    /// The earliest difference; the canary is not compared.
    #[must_use]
    pub fn first_difference(&self, other: &Self) -> Option<Stage> {
        if self.returned != other.returned {
            return Some(Stage::Life);
        }
        Stage::first_difference(&self.digests, &other.digests)
    }

    pub(super) fn to_words(self) -> [u32; Self::WORDS] {
        let d = &self.digests;
        let [[p0, p1], [s0, s1], [d0, d1], [e0, e1]] = [d.pose, d.skin, d.dynamics, d.embed].map(split);
        let [code, argument] = self.returned;
        [code, argument, self.canary, p0, p1, s0, s1, d0, d1, e0, e1]
    }

    pub(super) fn from_words(words: [u32; Self::WORDS]) -> Self {
        let [code, argument, canary, p0, p1, s0, s1, d0, d1, e0, e1] = words;
        let [pose, skin, dynamics, embed] = [[p0, p1], [s0, s1], [d0, d1], [e0, e1]].map(join);
        Self { returned: [code, argument], canary, digests: Digests { pose, skin, dynamics, embed } }
    }
}

fn code(result: Result<Stepped, StepError>) -> [u32; 2] {
    match result {
        Ok(Stepped::Advanced) => [0, 0],
        Ok(Stepped::Held) => [1, 0],
        Err(StepError::TimeNotFinite) => [2, 0],
        Err(StepError::BadRoot) => [3, 0],
        Err(StepError::BadJoint(i)) => [4, i],
        Err(StepError::NoSuchClip(i)) => [5, i],
        Err(StepError::JointCount(_)) => [6, 0],
        Err(StepError::FloatEnvironment(word)) => [7, word],
    }
}
