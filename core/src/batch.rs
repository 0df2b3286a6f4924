//! Many characters in one call.

use crate::character::Character;
use crate::step::{Pose, StepError, Stepped};
use crate::workspace::LengthError;

/// What became of a batch.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Batch {
    /// How many characters advanced: their buffers are new.
    pub advanced: usize,
    /// How many were refused; they are as they were.
    pub refused: usize,
    /// Index of the first that was refused, and why.
    pub refusal: Option<(usize, StepError)>,
}

/// Advances `characters` by `dt` seconds, each to its pose. One that is refused holds up no other.
///
/// The same bits as [`Character::step`] on each. Characters share nothing that changes, so a host
/// with threads may split the slices as it likes.
///
/// # Errors
///
/// [`LengthError`] unless there is one pose a character; nothing changes then.
///
/// # Examples
///
/// ```no_run
/// # fn run(crowd: &mut [sinew::Character<'_>], poses: &[sinew::Pose<'_>]) -> Result<(), sinew::LengthError> {
/// let batch = sinew::step_batch(crowd, poses, 1.0 / 60.0)?;
/// if let Some((index, why)) = batch.refusal {
///     eprintln!("character {index}: {why}");
/// }
/// # Ok(()) }
/// ```
pub fn step_batch(
    characters: &mut [Character<'_>],
    poses: &[Pose<'_>],
    dt: f32,
) -> Result<Batch, LengthError> {
    let (expected, found) = (characters.len(), poses.len());
    if expected != found {
        return Err(LengthError { expected, found });
    }
    let mut batch = Batch::default();
    for (i, (character, pose)) in characters.iter_mut().zip(poses).enumerate() {
        match character.step(*pose, dt) {
            Ok(Stepped::Advanced) => batch.advanced += 1,
            Ok(Stepped::Held) => {}
            Err(why) => {
                batch.refused += 1;
                batch.refusal = batch.refusal.or(Some((i, why)));
            }
        }
    }
    Ok(batch)
}
