//! Writes a replay while a character runs.

use super::error::{Field, RecordError};
use super::format::{HEADER_RECORD, HeaderField, KERNEL_VERSION, MAGIC, Tag, VERSION, check, split};
use super::input::{Event, root_to_words};
use super::outcome::Outcome;
use super::sink::{Sink, SinkFull};
use crate::character::Character;
use crate::math::canary;
use crate::math::digest::{self, Digest};
use crate::stage::pose::Root;
use crate::step::{Pose, StepError, Stepped};

/// A recording in progress that does not hold the character: hand in the same one every time.
///
/// [`super::Recorder`] is the form that holds it.
#[derive(Debug)]
pub struct Tape<S> {
    sink: S,
    record: u64,
    frames: u64,
    every: u32,
    since_snapshot: u32,
    digest: Digest,
}

/// What a finished recording holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Finished {
    /// Steps, held and refused ones included.
    pub frames: u64,
    /// Digest of all outcomes: one number for the whole run, the same on every machine.
    pub digest: u64,
}

impl<S: Sink> Tape<S> {
    /// Begins a recording of `character` as it is, with a snapshot after every `snapshot_every`-th step
    /// (0: only at the start and the end).
    ///
    /// # Errors
    ///
    /// [`SinkFull`] where the header and the state have no room.
    pub fn begin(character: &Character<'_>, snapshot_every: u32, mut sink: S) -> Result<Self, SinkFull> {
        sink.write(&MAGIC)?;
        let meta = &character.asset.meta;
        for field in HeaderField::ALL {
            let value = match field {
                HeaderField::FormatVersion => VERSION,
                HeaderField::KernelVersion => KERNEL_VERSION.into(),
                HeaderField::DigestVersion => digest::VERSION.into(),
                HeaderField::Canary => canary::float_environment().into(),
                HeaderField::AssetHash => character.asset.hash,
                HeaderField::Joints => meta.joints.into(),
                HeaderField::ActivePoints => meta.active.into(),
                HeaderField::StateLen => character.state_len() as u64,
                HeaderField::SnapshotEvery => snapshot_every.into(),
            };
            put_field(&mut sink, HEADER_RECORD, field.index(), split(value))?;
        }
        put_state(&mut sink, character)?;
        let digest = Digest::default();
        Ok(Self { sink, record: 0, frames: 0, every: snapshot_every, since_snapshot: 0, digest })
    }

    /// Does `event` and records it.
    ///
    /// # Errors
    ///
    /// [`RecordError`] where it was refused (then it is not recorded), or has no room.
    pub fn event(&mut self, character: &mut Character<'_>, event: &Event<'_>) -> Result<(), RecordError> {
        event.apply(character)?;
        let tag = event.tag();
        self.sink.write(&tag.letters())?;
        match event {
            Event::Tunables(tunables) => self.field(Field::Event(tag), tunables.to_words().map(f32::to_bits)),
            Event::Reset | Event::Settle | Event::Teleport => self.field(Field::Event(tag), []),
            Event::Freeze(frozen) => self.field(Field::Event(tag), [u32::from(*frozen)]),
            Event::Divisor(divisor) => self.field(Field::Event(tag), [*divisor]),
            Event::Load(state) => self.sink.write(state),
        }?;
        self.record = self.record.wrapping_add(1);
        Ok(())
    }

    /// [`Character::step`], recorded with what it returns.
    ///
    /// # Errors
    ///
    /// [`RecordError::Step`] where it was refused, [`RecordError::SinkFull`] where it has no room.
    pub fn step(
        &mut self,
        character: &mut Character<'_>,
        pose: Pose<'_>,
        dt: f32,
    ) -> Result<Stepped, RecordError> {
        let result = character.step(pose, dt);
        if let Err(StepError::JointCount(_)) = result {
            return Ok(result?);
        }
        self.head(Tag::Pose, dt, &pose.root)?;
        for (i, joint) in (0..).zip(pose.root_from_joint) {
            let [a, b, c, d] = joint.map(|column| column.map(f32::to_bits));
            let [[a0, a1, a2], [b0, b1, b2], [c0, c1, c2], [d0, d1, d2]] = [a, b, c, d];
            self.field(Field::Joint(i), [a0, a1, a2, b0, b1, b2, c0, c1, c2, d0, d1, d2])?;
        }
        self.outcome(character, result)
    }

    /// [`Character::step_clip`], recorded with what it returns.
    ///
    /// # Errors
    ///
    /// As [`Self::step`].
    pub fn step_clip(
        &mut self,
        character: &mut Character<'_>,
        clip: u32,
        t: f32,
        root: Root,
        dt: f32,
    ) -> Result<Stepped, RecordError> {
        let result = character.step_clip(clip, t, root, dt);
        self.head(Tag::Clip, dt, &root)?;
        self.field(Field::Clip, [clip, t.to_bits()])?;
        self.outcome(character, result)
    }

    /// Ends the recording with a snapshot and gives the sink back.
    ///
    /// # Errors
    ///
    /// [`SinkFull`] where the end has no room.
    pub fn finish(mut self, character: &Character<'_>) -> Result<(S, Finished), SinkFull> {
        if self.since_snapshot > 0 {
            self.snapshot(character)?;
        }
        let finished = Finished { frames: self.frames, digest: self.digest.finish() };
        let ([f0, f1], [d0, d1]) = (split(finished.frames), split(finished.digest));
        self.sink.write(&Tag::End.letters())?;
        self.field(Field::End, [f0, f1, d0, d1])?;
        Ok((self.sink, finished))
    }

    fn field<const N: usize>(&mut self, field: Field, words: [u32; N]) -> Result<(), SinkFull> {
        put_field(&mut self.sink, self.record, field.kind(), words)
    }

    fn head(&mut self, tag: Tag, dt: f32, root: &Root) -> Result<(), SinkFull> {
        self.sink.write(&tag.letters())?;
        self.field(Field::Dt, [dt.to_bits()])?;
        self.field(Field::Root, root_to_words(root))
    }

    fn outcome(
        &mut self,
        character: &Character<'_>,
        result: Result<Stepped, StepError>,
    ) -> Result<Stepped, RecordError> {
        let words = Outcome::of(character, result).to_words();
        self.field(Field::Outcome, words)?;
        add_outcome(&mut self.digest, &words);
        self.record = self.record.wrapping_add(1);
        self.frames = self.frames.wrapping_add(1);
        self.since_snapshot = self.since_snapshot.wrapping_add(1);
        if self.since_snapshot == self.every {
            self.snapshot(character)?;
        }
        Ok(result?)
    }

    fn snapshot(&mut self, character: &Character<'_>) -> Result<(), SinkFull> {
        self.sink.write(&Tag::Snapshot.letters())?;
        put_state(&mut self.sink, character)?;
        self.record = self.record.wrapping_add(1);
        self.since_snapshot = 0;
        Ok(())
    }
}

/// Adds an outcome to the digest of a whole run; the canary is the machine's and stays out.
pub(super) fn add_outcome(digest: &mut Digest, words: &[u32; Outcome::WORDS]) {
    let [code, argument, _, rest @ ..] = words;
    digest.bytes([*code, *argument].map(u32::to_le_bytes).as_flattened());
    digest.bytes(rest.map(u32::to_le_bytes).as_flattened());
}

fn put_field<const N: usize>(
    sink: &mut impl Sink,
    record: u64,
    kind: u32,
    words: [u32; N],
) -> Result<(), SinkFull> {
    sink.write(words.map(u32::to_le_bytes).as_flattened())?;
    sink.write(&check(record, kind, &words).to_le_bytes())
}

/// Writes a saved state without a buffer of its length.
fn put_state(sink: &mut impl Sink, character: &Character<'_>) -> Result<(), SinkFull> {
    // Whole blocks of the digest, so that the parts give the digest of the whole.
    let mut block = [0; 512];
    let (mut used, mut result, mut digest) = (0, Ok(()), Digest::default());
    character.write_state(&mut |mut bytes| {
        while !bytes.is_empty() {
            let room = block.get_mut(used..).unwrap_or_default();
            let n = room.len().min(bytes.len());
            let (now, later) = bytes.split_at(n);
            room.iter_mut().zip(now).for_each(|(to, from)| *to = *from);
            (used, bytes) = (used.saturating_add(n), later);
            if used == block.len() {
                digest.bytes(&block);
                result = result.and_then(|()| sink.write(&block));
                used = 0;
            }
        }
    });
    let rest = block.get(..used).unwrap_or_default();
    digest.bytes(rest);
    result?;
    sink.write(rest)?;
    sink.write(&digest.finish().to_le_bytes())
}
