//! The rollback check: step, restore, step again, compare.

use super::outcome::{Outcome, Stage};
use super::place::{Detail, first_difference};
use crate::character::Character;
use crate::state::StateError;
use crate::step::{StepError, Stepped};
use core::fmt;

/// What [`sync_test`] found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SyncVerdict {
    /// The step came out the same after the state was restored.
    Same(Result<Stepped, StepError>),
    /// Not the same.
    Different {
        /// The earliest stage that differs; `None` where only bits differ that no digest counts.
        stage: Option<Stage>,
        /// The first number that differs: "recorded" is the first run, "computed" the second.
        detail: Option<Detail>,
    },
}

/// Why a rollback check could not be made.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum SyncError {
    /// The state cannot be saved in that memory.
    Save(StateError),
    /// A state saved a moment ago was refused: a fault of this library.
    Restore(StateError),
}

impl SyncError {
    /// Stable name of the error, for programs; its text may change, this does not.
    #[must_use]
    pub const fn code(&self) -> &'static str {
        match self {
            Self::Save(e) | Self::Restore(e) => e.code(),
        }
    }
}

impl fmt::Display for SyncError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Save(e) => write!(f, "cannot save the state: {e}"),
            Self::Restore(e) => write!(f, "cannot restore the state: {e}"),
        }
    }
}

impl core::error::Error for SyncError {}

/// Steps, restores the state of before, steps again, and compares state and digests; time goes on by one step.
///
/// * `step`: one step; called twice, it must do the same both times.
/// * `memory`: 2·[`Character::state_len`] bytes.
///
/// # Errors
///
/// [`SyncError`] where the memory has another length.
pub fn sync_test<'c>(
    character: &mut Character<'c>,
    mut step: impl FnMut(&mut Character<'c>) -> Result<Stepped, StepError>,
    memory: &mut [u8],
) -> Result<SyncVerdict, SyncError> {
    let (before, after) = memory.split_at_mut(character.state_len().min(memory.len()));
    character.save_state(before).map_err(SyncError::Save)?;
    let first = step(character);
    let outcome = Outcome::of(character, first);
    character.save_state(after).map_err(SyncError::Save)?;
    character.load_state(before).map_err(SyncError::Restore)?;
    let second = step(character);
    let again = Outcome::of(character, second);
    let stage = outcome.first_difference(&again);
    let detail = first_difference(character, after, true).map(|(place, [recorded, computed])| Detail {
        frame: 0,
        place,
        recorded,
        computed,
    });
    Ok(if stage.is_none() && detail.is_none() {
        SyncVerdict::Same(first)
    } else {
        SyncVerdict::Different { stage, detail }
    })
}
