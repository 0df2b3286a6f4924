//! A character that is recorded.

use super::error::RecordError;
use super::input::Event;
use super::sink::{Sink, SinkFull};
use super::tape::{Finished, Tape};
use crate::character::Character;
use crate::stage::pose::Root;
use crate::step::{Pose, Stepped};
use crate::tunables::Tunables;

/// Holds a character while it is recorded, so that nothing moves it unrecorded.
///
/// # Examples
///
/// ```no_run
/// # fn run(character: &mut sinew::Character<'_>) -> Result<(), Box<dyn core::error::Error>> {
/// use sinew::replay::{Cursor, Recorder, Replay, verify, Extent};
/// let mut buffer = vec![0; 1 << 20];
/// let mut recorder = Recorder::new(character, 60, Cursor::new(&mut buffer))?;
/// for frame in 0..600_u16 {
///     recorder.step_clip(0, f32::from(frame) / 60.0, sinew::Root::default(), 1.0 / 60.0)?;
/// }
/// let (sink, finished) = recorder.finish()?;
/// let replay = Replay::parse(sink.bytes())?;
/// let verdict = verify(character, &replay, Extent::FirstDifference, |_done, _of| {})?;
/// # Ok(()) }
/// ```
#[derive(Debug)]
pub struct Recorder<'r, 'c, S> {
    character: &'r mut Character<'c>,
    tape: Tape<S>,
}

impl<'r, 'c, S: Sink> Recorder<'r, 'c, S> {
    /// Begins a recording of `character` as it is; `snapshot_every` as in [`Tape::begin`].
    ///
    /// # Errors
    ///
    /// [`SinkFull`] where the header and the state have no room.
    pub fn new(character: &'r mut Character<'c>, snapshot_every: u32, sink: S) -> Result<Self, SinkFull> {
        let tape = Tape::begin(character, snapshot_every, sink)?;
        Ok(Self { character, tape })
    }

    /// The character, to look at.
    #[must_use]
    pub fn character(&self) -> &Character<'c> {
        self.character
    }

    /// [`Character::step`].
    ///
    /// # Errors
    ///
    /// As [`Tape::step`].
    pub fn step(&mut self, pose: Pose<'_>, dt: f32) -> Result<Stepped, RecordError> {
        self.tape.step(self.character, pose, dt)
    }

    /// [`Character::step_clip`].
    ///
    /// # Errors
    ///
    /// As [`Tape::step`].
    pub fn step_clip(&mut self, clip: u32, t: f32, root: Root, dt: f32) -> Result<Stepped, RecordError> {
        self.tape.step_clip(self.character, clip, t, root, dt)
    }

    /// Any call between two steps.
    ///
    /// # Errors
    ///
    /// As [`Tape::event`].
    pub fn event(&mut self, event: &Event<'_>) -> Result<(), RecordError> {
        self.tape.event(self.character, event)
    }

    /// [`Character::set_tunables`].
    ///
    /// # Errors
    ///
    /// As [`Tape::event`].
    pub fn set_tunables(&mut self, tunables: &Tunables) -> Result<(), RecordError> {
        self.event(&Event::Tunables(*tunables))
    }

    /// [`Character::reset`].
    ///
    /// # Errors
    ///
    /// As [`Tape::event`].
    pub fn reset(&mut self) -> Result<(), RecordError> {
        self.event(&Event::Reset)
    }

    /// [`Character::settle`].
    ///
    /// # Errors
    ///
    /// As [`Tape::event`].
    pub fn settle(&mut self) -> Result<(), RecordError> {
        self.event(&Event::Settle)
    }

    /// [`Character::teleport`].
    ///
    /// # Errors
    ///
    /// As [`Tape::event`].
    pub fn teleport(&mut self) -> Result<(), RecordError> {
        self.event(&Event::Teleport)
    }

    /// [`Character::freeze`].
    ///
    /// # Errors
    ///
    /// As [`Tape::event`].
    pub fn freeze(&mut self, frozen: bool) -> Result<(), RecordError> {
        self.event(&Event::Freeze(frozen))
    }

    /// [`Character::set_rate_divisor`].
    ///
    /// # Errors
    ///
    /// As [`Tape::event`].
    pub fn set_rate_divisor(&mut self, divisor: u32) -> Result<(), RecordError> {
        self.event(&Event::Divisor(divisor))
    }

    /// [`Character::load_state`].
    ///
    /// # Errors
    ///
    /// As [`Tape::event`].
    pub fn load_state(&mut self, state: &[u8]) -> Result<(), RecordError> {
        self.event(&Event::Load(state))
    }

    /// Ends the recording.
    ///
    /// # Errors
    ///
    /// As [`Tape::finish`].
    pub fn finish(self) -> Result<(S, Finished), SinkFull> {
        self.tape.finish(self.character)
    }
}
