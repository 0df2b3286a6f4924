//! Replays: what moved a character, what came of it, and whether it comes out the same here.
//!
//! ```text
//! Recorder ─▶ bytes ─▶ Replay::parse ─▶ verify ─▶ same, or the first frame, stage, vertex and field that is not
//! ```
//!
//! # Format, version 1
//!
//! ```text
//! header    "SNRP", then for each HeaderField: value u64, check u32
//! start     saved state before the first record (see Character::save_state)
//! records   tag (4 letters), then fields, each followed by its check u32
//!
//! "pose"    dt | root (3 f64, 4 f32) | for each joint: 12 f32       | outcome
//! "clip"    dt | root (3 f64, 4 f32) | clip u32, time f32           | outcome
//! "snAP"    saved state after the frame before (its last 8 bytes are its own check)
//! "tUnE"    tunables, `Tunables::WORDS` f32         "DIvr"  rate divisor u32
//! "rEsT" reset, "setL" settle, "TELp" teleport      "Frze"  0 or 1, u32
//! "LoaD"    saved state that was restored           "END."  frames u64, digest u64; nothing after it
//!
//! outcome   what the step returned (code u32, argument u32), canary u32, digests of pose, skin, dynamics, embed u64
//! ```
//!
//! Little-endian, whole 32-bit words. A check ([`format::check`]) covers the number of the record, the kind of the
//! field and its words: it always sees a change within one word, and any other but for one in 2³².
//! Damage to an input is an error that names frame and field ([`ReplayError::Damaged`]); damage to an
//! outcome or a snapshot is a [`Difference`] with that [`Cause`].
//!
//! A step that was held or refused ran no stage: its outcome has the digest of the dynamics, the others are 0.
//! A step refused for its number of joints cannot be told here and changed nothing: it is left out.

mod error;
pub mod format;
mod input;
mod outcome;
mod parse;
mod place;
mod recorder;
mod sink;
mod sync;
mod tape;
mod verify;

pub use error::{Field, RecordError, ReplayError};
pub use format::{HeaderField, KERNEL_VERSION, Tag};
pub use input::{Event, Frame, Motion, RecordedPose};
pub use outcome::{Outcome, Stage};
pub use parse::{Record, Records, Replay};
pub use place::{Detail, LifeField, Place, PointField};
pub use recorder::Recorder;
pub use sink::{Cursor, Sink, SinkFull};
pub use sync::{SyncError, SyncVerdict, sync_test};
pub use tape::{Finished, Tape};
pub use verify::{Cause, Difference, Extent, Verdict, Verifier, verify};
