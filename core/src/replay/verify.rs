//! Runs a replay again and tells the first difference, where, and why.

use super::error::{Field, ReplayError};
use super::format::{HeaderField, KERNEL_VERSION};
use super::input::Frame;
use super::outcome::{Outcome, Stage};
use super::parse::{Record, Records, Replay, state_is_whole};
use super::place::{Detail, first_difference};
use crate::character::Character;
use crate::math::{canary, digest};
use core::fmt;

/// How far to go.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Extent {
    /// To the first difference, and on to the snapshot that tells its values.
    #[default]
    FirstDifference,
    /// To the end, counting the frames that differ.
    Whole,
}

/// What verifying found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// Every frame came out the same.
    Same {
        /// Number of frames.
        frames: u64,
    },
    /// Not the same.
    Different(Difference),
}

/// The first frame that came out different.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Difference {
    /// Number of the step, from 0.
    pub frame: u64,
    /// The earliest stage that differs; `None` where only a check of the replay itself does not fit.
    pub stage: Option<Stage>,
    /// Why, where it can be known.
    pub cause: Cause,
    /// The first number that differs, from the first snapshot at or after the frame.
    pub detail: Option<Detail>,
    /// Frames that differ among those that were run.
    pub differing: u64,
}

/// Why a replay came out different.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Cause {
    /// [`Field::Outcome`] or [`Field::Snapshot`] of the replay is damaged.
    Damaged(Field),
    /// The float environments differ (see [`canary::float_environment`]).
    Canary {
        /// Word in the replay.
        recorded: u32,
        /// Word here.
        here: u32,
    },
    /// The replay was made by another version of the arithmetic.
    Kernel {
        /// Version in the replay.
        recorded: u64,
        /// [`KERNEL_VERSION`].
        here: u32,
    },
    /// Asset, inputs, arithmetic and environment are the same: a fault, or a state changed from outside.
    Unknown,
}

impl fmt::Display for Cause {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Damaged(field) => write!(f, "the replay is damaged: {field}"),
            Self::Canary { recorded, here } => {
                let differing = recorded ^ here;
                let what = match () {
                    () if differing & 0b111 != 0 => "rounding mode",
                    () if differing & 0b11_1000 != 0 => "subnormals are flushed to zero",
                    () => "multiply and add are contracted",
                };
                write!(
                    f,
                    "float environments differ: {what} (canary {recorded:07b} recorded, {here:07b} here)"
                )
            }
            Self::Kernel { recorded, here } => {
                write!(f, "recorded by kernel version {recorded}, this is {here}")
            }
            Self::Unknown => write!(f, "same asset, inputs, kernel version and float environment"),
        }
    }
}

impl fmt::Display for Difference {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "frame {}", self.frame)?;
        if let Some(stage) = self.stage {
            write!(f, ", stage {stage}")?;
        }
        if let Some(detail) = &self.detail {
            write!(f, ", {detail}")?;
        }
        write!(f, "; {}", self.cause)
    }
}

fn environment(recorded: u32, here: u32) -> Option<Cause> {
    (recorded != here).then_some(Cause::Canary { recorded, here })
}

fn kernel(recorded: u64) -> Option<Cause> {
    (recorded != u64::from(KERNEL_VERSION)).then_some(Cause::Kernel { recorded, here: KERNEL_VERSION })
}

impl Replay<'_> {
    /// What makes a difference likely, known before a frame is run: another float environment or another kernel version.
    #[must_use]
    pub fn suspect(&self) -> Option<Cause> {
        let recorded = u32::try_from(self.header(HeaderField::Canary)).unwrap_or(u32::MAX);
        environment(recorded, canary::float_environment()).or(kernel(self.header(HeaderField::KernelVersion)))
    }
}

/// A replay that runs frame by frame; it can go on after a difference.
#[derive(Debug)]
pub struct Verifier<'r, 'c, 'a> {
    character: &'r mut Character<'c>,
    records: Records<'a>,
    kernel: u64,
    frames: u64,
    done: u64,
    difference: Option<Difference>,
    differing: u64,
}

impl<'r, 'c, 'a> Verifier<'r, 'c, 'a> {
    /// Puts `character` where the recording began; its own state is lost.
    ///
    /// # Errors
    ///
    /// [`ReplayError`] for a replay of another asset or with other digests.
    pub fn new(character: &'r mut Character<'c>, replay: &Replay<'a>) -> Result<Self, ReplayError> {
        let (recorded, found) = (replay.header(HeaderField::AssetHash), character.asset.hash);
        if recorded != found {
            return Err(ReplayError::OtherAsset { recorded, found });
        }
        let digests = replay.header(HeaderField::DigestVersion);
        if digests != u64::from(digest::VERSION) {
            return Err(ReplayError::OtherDigest(digests));
        }
        let meta = &character.asset.meta;
        let counts = [
            (HeaderField::Joints, meta.joints.into()),
            (HeaderField::ActivePoints, meta.active.into()),
            (HeaderField::StateLen, character.state_len() as u64),
        ];
        if let Some((field, _)) = counts.iter().find(|(field, count)| replay.header(*field) != *count) {
            return Err(ReplayError::Header(*field));
        }
        let damaged = ReplayError::Damaged { frame: 0, field: Field::Start };
        character.load_state(replay.start()).map_err(|_| damaged)?;
        Ok(Self {
            character,
            records: replay.records(),
            kernel: replay.header(HeaderField::KernelVersion),
            frames: replay.finished().frames,
            done: 0,
            difference: None,
            differing: 0,
        })
    }

    /// The character, to look at or to disturb.
    pub fn character(&mut self) -> &mut Character<'c> {
        self.character
    }

    /// Frames in all.
    #[must_use]
    pub fn frames(&self) -> u64 {
        self.frames
    }

    /// The first difference so far.
    #[must_use]
    pub fn difference(&self) -> Option<Difference> {
        self.difference.map(|difference| Difference { differing: self.differing, ..difference })
    }

    /// Runs the next step with the events before it; `false` at the end.
    ///
    /// # Errors
    ///
    /// [`ReplayError::Damaged`] for an event that the character refuses.
    pub fn advance(&mut self) -> Result<bool, ReplayError> {
        while let Some(record) = self.records.next() {
            match record {
                Record::Event(event) => {
                    let damaged = ReplayError::Damaged { frame: self.done, field: Field::Event(event.tag()) };
                    event.apply(self.character).map_err(|_| damaged)?;
                }
                Record::Frame(frame) => {
                    self.frame(&frame);
                    return Ok(true);
                }
                Record::Snapshot(_) | Record::End(_) => {}
            }
        }
        Ok(false)
    }

    /// Runs a step and compares what came of it, then the snapshot after it.
    fn frame(&mut self, frame: &Frame<'_>) {
        let result = frame.run(self.character);
        let outcome = Outcome::of(self.character, result);
        let mut stage = frame.outcome.first_difference(&outcome);
        let mut differs = stage.is_some() || !frame.intact;
        let mut cause = self.cause(frame, &outcome);
        let mut detail = None;
        let mut ahead = self.records.clone();
        if let Some(Record::Snapshot(saved)) = ahead.next() {
            self.records = ahead;
            let whole = state_is_whole(saved);
            detail = self.detail(frame.index, saved, whole);
            if !differs && (!whole || detail.is_some()) {
                // The digests agree, so it is the snapshot that is wrong, unless time or tunables differ.
                differs = true;
                stage = detail.map(|d| d.place.stage());
                if !whole || stage != Some(Stage::Life) {
                    cause = Cause::Damaged(Field::Snapshot);
                }
            } else if !whole {
                detail = None;
            }
        }
        self.done = frame.index.wrapping_add(1);
        self.differing = self.differing.wrapping_add(differs.into());
        match &mut self.difference {
            None if differs => {
                let differing = self.differing;
                self.difference = Some(Difference { frame: frame.index, stage, cause, detail, differing });
            }
            Some(difference) if difference.detail.is_none() => difference.detail = detail,
            _ => {}
        }
    }

    fn cause(&self, frame: &Frame<'_>, outcome: &Outcome) -> Cause {
        let (recorded, here) = (frame.outcome.canary, outcome.canary);
        if !frame.intact {
            return Cause::Damaged(Field::Outcome);
        }
        environment(recorded, here).or(kernel(self.kernel)).unwrap_or(Cause::Unknown)
    }

    fn detail(&self, frame: u64, saved: &[u8], whole: bool) -> Option<Detail> {
        let (place, [recorded, computed]) = first_difference(self.character, saved, !whole)?;
        Some(Detail { frame, place, recorded, computed })
    }

    /// Whether nothing more can be learned of the first difference.
    fn is_told(&self) -> bool {
        self.difference.is_some_and(|d| d.detail.is_some() || matches!(d.cause, Cause::Damaged(_)))
    }
}

/// Runs `replay` on `character` and compares every frame. `progress` is called after each with the frames done
/// and their number.
///
/// The character's own state is lost; after the last frame it is that of the recording's end.
///
/// # Errors
///
/// [`ReplayError`] for a replay that cannot be run: of another asset, with other digests, with damaged events.
pub fn verify(
    character: &mut Character<'_>,
    replay: &Replay<'_>,
    extent: Extent,
    mut progress: impl FnMut(u64, u64),
) -> Result<Verdict, ReplayError> {
    let mut verifier = Verifier::new(character, replay)?;
    let frames = verifier.frames();
    while verifier.advance()? {
        progress(verifier.done, frames);
        if extent == Extent::FirstDifference && verifier.is_told() {
            break;
        }
    }
    Ok(verifier.difference().map_or(Verdict::Same { frames }, Verdict::Different))
}
