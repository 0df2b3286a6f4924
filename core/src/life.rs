//! Time and interruptions: what a character remembers besides its arrays, and what may befall it.

use crate::character::{Character, surface};
use crate::math::float;
use crate::stage::embed;
use crate::stage::pose::Root;
use crate::step::StepError;
use crate::tunables::Tunables;

/// Where the character is in its life.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Phase {
    /// The next step settles at its pose.
    Settle,
    /// Settled one step ago: the next step starts with the target's slope.
    Fresh,
    /// Running.
    Running,
}

/// Everything of a character that is not an array, and that a saved state holds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Life {
    pub(crate) phase: Phase,
    pub(crate) frozen: bool,
    pub(crate) teleport: bool,
    pub(crate) divisor: u32,
    pub(crate) turn: u32,
    pub(crate) pending: f32,
    pub(crate) gust_ticks: u64,
    pub(crate) root: Root,
    pub(crate) tunables: Tunables,
}

impl Character<'_> {
    /// Forgets all motion: the next step starts at rest in its pose.
    pub fn reset(&mut self) {
        self.settle();
        self.life.gust_ticks = 0;
        self.life.pending = 0.0;
        self.memory.offsets.fill([0.0; 3]);
        embed::rest(surface(&self.asset), self.memory.positions, self.memory.normals);
    }

    /// Lets the next step put the flesh where it would come to rest in its pose.
    pub fn settle(&mut self) {
        self.life.phase = Phase::Settle;
    }

    /// Declares that the next step of the root is a teleport, whatever its length: it is not felt.
    pub fn teleport(&mut self) {
        self.life.teleport = true;
    }

    /// Plays `clip` in a loop for `loops` rounds in steps of `dt` seconds, so that the first frame shown does not pop.
    ///
    /// # Errors
    ///
    /// As [`Self::step_clip`].
    pub fn warm_up(&mut self, clip: u32, loops: u32, root: Root, dt: f32) -> Result<(), StepError> {
        let duration = self.asset.clip(clip as usize).ok_or(StepError::NoSuchClip(clip))?.duration;
        if !(dt > 0.0 && dt.is_finite()) {
            return Err(StepError::TimeNotFinite);
        }
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "saturating")]
        let frames = float::min(duration / dt + 0.5, 100_000.0) as u32;
        self.settle();
        for _ in 0..loops.min(1_000) {
            for frame in 0..frames {
                #[allow(clippy::cast_precision_loss, reason = "at most 100,000")]
                self.step_clip(clip, frame as f32 * dt, root, dt)?;
            }
        }
        Ok(())
    }

    /// Advances only every `divisor`-th step (0 counts as 1), by all the time since the last.
    pub fn set_rate_divisor(&mut self, divisor: u32) {
        self.life.divisor = divisor.max(1);
        self.life.turn = 0;
    }

    /// Stops the flesh where it is (`true`), or lets it catch up at the next step (`false`).
    pub fn freeze(&mut self, frozen: bool) {
        self.life.frozen = frozen;
    }
}
