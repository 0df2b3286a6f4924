//! Why bytes are not a replay, or not one of this character; and why a recording stopped.

use super::format::{HeaderField, Tag};
use super::sink::SinkFull;
use crate::step::StepError;
use crate::{StateError, TunableError};
use core::fmt;

/// A field of a record.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Field {
    /// The record's tag.
    Tag,
    /// Time of a step.
    Dt,
    /// The root.
    Root,
    /// Index of the clip and time in it.
    Clip,
    /// Pose of a joint.
    Joint(u32),
    /// What an event holds.
    Event(Tag),
    /// The state at the start.
    Start,
    /// What a step returned and its digests.
    Outcome,
    /// The state after a frame.
    Snapshot,
    /// Count and digest at the end, or bytes after it.
    End,
}

impl Field {
    /// Number for the check; joints follow the others.
    pub(super) fn kind(self) -> u32 {
        match self {
            Self::Tag => 0,
            Self::Dt => 1,
            Self::Root => 2,
            Self::Clip => 3,
            Self::Start => 4,
            Self::Outcome => 5,
            Self::Snapshot => 6,
            Self::End => 7,
            Self::Event(tag) => u32::from_le_bytes(tag.letters()),
            Self::Joint(i) => i.wrapping_add(16),
        }
    }
}

impl fmt::Display for Field {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Tag => write!(f, "kind of record"),
            Self::Dt => write!(f, "dt"),
            Self::Root => write!(f, "root"),
            Self::Clip => write!(f, "clip"),
            Self::Joint(i) => write!(f, "pose of joint {i}"),
            Self::Event(tag) => write!(f, "{tag}"),
            Self::Start => write!(f, "state at the start"),
            Self::Outcome => write!(f, "digests"),
            Self::Snapshot => write!(f, "snapshot"),
            Self::End => write!(f, "end"),
        }
    }
}

/// Why bytes are not a replay that can be run here.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum ReplayError {
    /// The bytes do not start with the magic bytes (the header field "magic").
    BadMagic([u8; 4]),
    /// The bytes end inside the header.
    NoHeader,
    /// A header field is damaged.
    Header(HeaderField),
    /// A format that this build does not read.
    UnsupportedVersion(u64),
    /// The bytes end inside or before the record after this many frames.
    Truncated {
        /// Frames before it.
        frame: u64,
    },
    /// An input is damaged.
    Damaged {
        /// Frame that it belongs to (an event: the next one), from 0.
        frame: u64,
        /// What is damaged.
        field: Field,
    },
    /// The replay is of another asset.
    OtherAsset {
        /// Hash in the replay.
        recorded: u64,
        /// Hash of the character's asset.
        found: u64,
    },
    /// The digests were made by another algorithm.
    OtherDigest(u64),
}

impl ReplayError {
    /// Stable name of the error, for programs; its text may change, this does not.
    #[must_use]
    pub const fn code(&self) -> &'static str {
        match self {
            Self::BadMagic(_) => "REPLAY_BAD_MAGIC",
            Self::NoHeader => "REPLAY_NO_HEADER",
            Self::Header(_) => "REPLAY_DAMAGED_HEADER",
            Self::UnsupportedVersion(_) => "REPLAY_UNSUPPORTED_VERSION",
            Self::Truncated { .. } => "REPLAY_TRUNCATED",
            Self::Damaged { .. } => "REPLAY_DAMAGED",
            Self::OtherAsset { .. } => "REPLAY_OTHER_ASSET",
            Self::OtherDigest(_) => "REPLAY_OTHER_DIGEST",
        }
    }
}

impl fmt::Display for ReplayError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::BadMagic(bytes) => {
                write!(f, "not a sinew replay: header field magic is \"{}\"", bytes.escape_ascii())
            }
            Self::NoHeader => write!(f, "replay ends inside its header"),
            Self::Header(field) => write!(f, "replay is damaged: header field {field}"),
            Self::UnsupportedVersion(v) => write!(f, "replay version {v} is not supported by this build"),
            Self::Truncated { frame } => write!(f, "replay is truncated after {frame} frames"),
            Self::Damaged { frame, field } => write!(f, "replay is damaged: frame {frame}, {field}"),
            Self::OtherAsset { recorded, found } => {
                write!(f, "replay is of asset {recorded:016x}, the asset given is {found:016x}")
            }
            Self::OtherDigest(v) => {
                write!(f, "replay has digests of version {v}; record it again with this version")
            }
        }
    }
}

impl core::error::Error for ReplayError {}

/// Why something was not recorded, or was refused.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum RecordError {
    /// The sink is full: what was asked for was done, but the recording is not whole.
    SinkFull,
    /// The step was refused (and recorded so).
    Step(StepError),
    /// The tunables were refused.
    Tunables(TunableError),
    /// The state was refused.
    State(StateError),
}

impl RecordError {
    /// Stable name of the error, for programs; its text may change, this does not.
    #[must_use]
    pub const fn code(&self) -> &'static str {
        match self {
            Self::SinkFull => SinkFull.code(),
            Self::Step(e) => e.code(),
            Self::Tunables(e) => e.code(),
            Self::State(e) => e.code(),
        }
    }
}

impl fmt::Display for RecordError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::SinkFull => SinkFull.fmt(f),
            Self::Step(e) => e.fmt(f),
            Self::Tunables(e) => e.fmt(f),
            Self::State(e) => e.fmt(f),
        }
    }
}

impl core::error::Error for RecordError {}

impl From<SinkFull> for RecordError {
    fn from(_: SinkFull) -> Self {
        Self::SinkFull
    }
}

impl From<StepError> for RecordError {
    fn from(e: StepError) -> Self {
        Self::Step(e)
    }
}

impl From<TunableError> for RecordError {
    fn from(e: TunableError) -> Self {
        Self::Tunables(e)
    }
}

impl From<StateError> for RecordError {
    fn from(e: StateError) -> Self {
        Self::State(e)
    }
}
