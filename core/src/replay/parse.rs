//! Bytes in, checked records out. After [`Replay::parse`] succeeds every input is whole.

#![deny(clippy::arithmetic_side_effects, clippy::indexing_slicing)]

use super::error::{Field, ReplayError};
use super::format::{HEADER_RECORD, HeaderField, MAGIC, Tag, VERSION, check, join};
use super::input::{Event, Frame, Motion, ROOT_WORDS, RecordedPose, root_from_words};
use super::outcome::Outcome;
use super::tape::{Finished, add_outcome};
use crate::math::digest::{self, Digest};
use crate::tunables::Tunables;

/// A replay whose structure and inputs were checked.
#[derive(Clone, Copy, Debug)]
pub struct Replay<'a> {
    header: Header,
    start: &'a [u8],
    records: &'a [u8],
    finished: Finished,
}

/// A record, in file order.
#[derive(Clone, Copy, Debug)]
#[allow(clippy::large_enum_variant, reason = "one lives at a time, on the stack")]
pub enum Record<'a> {
    /// A call between two steps.
    Event(Event<'a>),
    /// A step.
    Frame(Frame<'a>),
    /// The saved state after the last step; not checked yet.
    Snapshot(&'a [u8]),
    /// The end.
    End(Finished),
}

/// Values of the header's fields.
#[derive(Clone, Copy, Debug)]
pub(super) struct Header([u64; HeaderField::ALL.len()]);

impl Header {
    fn get(&self, field: HeaderField) -> u64 {
        self.0.get(field.index() as usize).copied().unwrap_or(0)
    }

    /// Length of a saved state; the joints of a pose.
    fn lengths(&self) -> (usize, usize) {
        let of = |field| usize::try_from(self.get(field)).unwrap_or(usize::MAX);
        (of(HeaderField::StateLen), of(HeaderField::Joints))
    }
}

impl<'a> Replay<'a> {
    /// Reads a replay and checks its structure and its inputs; outcomes and snapshots are checked by [`super::verify()`].
    ///
    /// # Errors
    ///
    /// [`ReplayError`] for bytes that are not a whole replay with undamaged inputs.
    pub fn parse(bytes: &'a [u8]) -> Result<Self, ReplayError> {
        let mut r = Reader(bytes);
        let magic = r.array().ok_or(ReplayError::NoHeader)?;
        if magic != MAGIC {
            return Err(ReplayError::BadMagic(magic));
        }
        let mut header = Header([0; HeaderField::ALL.len()]);
        for (value, field) in header.0.iter_mut().zip(HeaderField::ALL) {
            let (words, whole) = r.field(HEADER_RECORD, field.index()).ok_or(ReplayError::NoHeader)?;
            *value = join(words);
            if !whole {
                return Err(ReplayError::Header(field));
            }
            if field == HeaderField::FormatVersion && *value != VERSION {
                return Err(ReplayError::UnsupportedVersion(*value));
            }
        }
        let start = r.take(header.lengths().0).ok_or(ReplayError::Truncated { frame: 0 })?;
        if !state_is_whole(start) {
            return Err(ReplayError::Damaged { frame: 0, field: Field::Start });
        }
        let finished = check_records(&mut Records::new(header, r))?;
        Ok(Self { header, start, records: r.0, finished })
    }

    /// A field of the header.
    #[must_use]
    pub fn header(&self, field: HeaderField) -> u64 {
        self.header.get(field)
    }

    /// Number of steps, and the digest of the whole run.
    #[must_use]
    pub fn finished(&self) -> Finished {
        self.finished
    }

    /// The saved state before the first record.
    #[must_use]
    pub fn start(&self) -> &'a [u8] {
        self.start
    }

    /// All records, in file order.
    #[must_use]
    pub fn records(&self) -> Records<'a> {
        Records::new(self.header, Reader(self.records))
    }

    /// All steps.
    pub fn frames(&self) -> impl Iterator<Item = Frame<'a>> + use<'a> {
        self.records().filter_map(|record| match record {
            Record::Frame(frame) => Some(frame),
            _ => None,
        })
    }
}

/// Reads every record once.
fn check_records(records: &mut Records<'_>) -> Result<Finished, ReplayError> {
    let (mut digest, mut intact) = (Digest::default(), true);
    loop {
        match records.read()? {
            Record::Frame(frame) => {
                add_outcome(&mut digest, &frame.outcome.to_words());
                intact &= frame.intact;
            }
            Record::End(finished) => {
                let digest_fits = !intact || digest.finish() == finished.digest;
                let end = records.reader.0.is_empty() && finished.frames == records.frame;
                let damaged = ReplayError::Damaged { frame: records.frame, field: Field::End };
                return if end && digest_fits { Ok(finished) } else { Err(damaged) };
            }
            _ => {}
        }
    }
}

/// Iterator over the records of a replay.
#[derive(Clone, Debug)]
pub struct Records<'a> {
    header: Header,
    reader: Reader<'a>,
    record: u64,
    frame: u64,
}

impl<'a> Iterator for Records<'a> {
    type Item = Record<'a>;

    fn next(&mut self) -> Option<Record<'a>> {
        if self.reader.0.is_empty() {
            return None;
        }
        self.read().ok()
    }
}

impl<'a> Records<'a> {
    fn new(header: Header, reader: Reader<'a>) -> Self {
        Self { header, reader, record: 0, frame: 0 }
    }

    fn read(&mut self) -> Result<Record<'a>, ReplayError> {
        let letters = self.reader.array().ok_or(self.truncated())?;
        let tag = Tag::from_letters(letters).ok_or(self.damaged(Field::Tag))?;
        let record = match tag {
            Tag::Pose | Tag::Clip => self.frame(tag)?,
            Tag::Snapshot => Record::Snapshot(self.state()?),
            Tag::End => {
                let [f0, f1, d0, d1] = self.input(Field::End)?;
                Record::End(Finished { frames: join([f0, f1]), digest: join([d0, d1]) })
            }
            _ => Record::Event(self.event(tag)?),
        };
        self.record = self.record.wrapping_add(1);
        Ok(record)
    }

    fn event(&mut self, tag: Tag) -> Result<Event<'a>, ReplayError> {
        let field = Field::Event(tag);
        Ok(match tag {
            Tag::Tunables => {
                let words = self.input::<{ Tunables::WORDS }>(field)?.map(f32::from_bits);
                Event::Tunables(Tunables::from_words(&words).map_err(|_| self.damaged(field))?)
            }
            Tag::Freeze => match self.input(field)? {
                [0] => Event::Freeze(false),
                [1] => Event::Freeze(true),
                _ => return Err(self.damaged(field)),
            },
            Tag::Divisor => {
                let [divisor] = self.input(field)?;
                Event::Divisor(divisor)
            }
            Tag::Load => {
                let state = self.state()?;
                if !state_is_whole(state) {
                    return Err(self.damaged(field));
                }
                Event::Load(state)
            }
            simple => {
                let [] = self.input(field)?;
                match simple {
                    Tag::Reset => Event::Reset,
                    Tag::Settle => Event::Settle,
                    _ => Event::Teleport,
                }
            }
        })
    }

    fn frame(&mut self, tag: Tag) -> Result<Record<'a>, ReplayError> {
        let [dt] = self.input(Field::Dt)?;
        let root = root_from_words(self.input::<ROOT_WORDS>(Field::Root)?);
        let motion = if tag == Tag::Clip {
            let [clip, time] = self.input(Field::Clip)?;
            Motion::Clip { clip, time: f32::from_bits(time) }
        } else {
            Motion::Pose(self.pose()?)
        };
        let (words, intact) =
            self.reader.field(self.record, Field::Outcome.kind()).ok_or(self.truncated())?;
        let index = self.frame;
        self.frame = index.wrapping_add(1);
        let (dt, outcome) = (f32::from_bits(dt), Outcome::from_words(words));
        Ok(Record::Frame(Frame { index, dt, root, motion, outcome, intact }))
    }

    fn pose(&mut self) -> Result<RecordedPose<'a>, ReplayError> {
        let (_, joints) = self.header.lengths();
        let len = joints.checked_mul(52).ok_or(self.truncated())?;
        let mut fields = self.reader;
        let bytes = self.reader.take(len).ok_or(self.truncated())?;
        for i in 0..u32::try_from(joints).unwrap_or(u32::MAX) {
            let field = fields.field::<12>(self.record, Field::Joint(i).kind());
            if !field.is_some_and(|(_, whole)| whole) {
                return Err(self.damaged(Field::Joint(i)));
            }
        }
        Ok(RecordedPose(bytes.as_chunks().0))
    }

    fn state(&mut self) -> Result<&'a [u8], ReplayError> {
        let (len, _) = self.header.lengths();
        self.reader.take(len).ok_or(self.truncated())
    }

    /// A field that must be whole.
    fn input<const N: usize>(&mut self, field: Field) -> Result<[u32; N], ReplayError> {
        let (words, whole) = self.reader.field(self.record, field.kind()).ok_or(self.truncated())?;
        if whole { Ok(words) } else { Err(self.damaged(field)) }
    }

    fn damaged(&self, field: Field) -> ReplayError {
        ReplayError::Damaged { frame: self.frame, field }
    }

    fn truncated(&self) -> ReplayError {
        ReplayError::Truncated { frame: self.frame }
    }
}

/// Whether the digest that closes a saved state fits.
pub(super) fn state_is_whole(state: &[u8]) -> bool {
    state
        .split_last_chunk::<8>()
        .is_some_and(|(content, hash)| digest::of_bytes(content).to_le_bytes() == *hash)
}

/// All access to the bytes.
#[derive(Clone, Copy, Debug)]
struct Reader<'a>(&'a [u8]);

impl<'a> Reader<'a> {
    fn take(&mut self, n: usize) -> Option<&'a [u8]> {
        let (head, rest) = self.0.split_at_checked(n)?;
        self.0 = rest;
        Some(head)
    }

    fn array<const N: usize>(&mut self) -> Option<[u8; N]> {
        let (head, rest) = self.0.split_first_chunk()?;
        self.0 = rest;
        Some(*head)
    }

    /// A field of `N` words, and whether its check fits.
    fn field<const N: usize>(&mut self, record: u64, kind: u32) -> Option<([u32; N], bool)> {
        let mut words = [0; N];
        for word in &mut words {
            *word = u32::from_le_bytes(self.array()?);
        }
        let whole = u32::from_le_bytes(self.array()?) == check(record, kind, &words);
        Some((words, whole))
    }
}
