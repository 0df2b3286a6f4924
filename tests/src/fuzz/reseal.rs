//! Makes the checks of a mutated replay fit again, so that the mutation is read and not only refused.

use sinew::replay::format::{HEADER_LEN, HeaderField, Tag, check};

/// Kinds of fields, as the format numbers them.
const DT: u32 = 1;
const ROOT: u32 = 2;
const CLIP: u32 = 3;
const OUTCOME: u32 = 5;
const END: u32 = 7;
const FIRST_JOINT: u32 = 16;

/// Walks over the bytes; `None` past their end.
struct Walk<'a> {
    bytes: &'a mut [u8],
    at: usize,
}

impl Walk<'_> {
    fn word(&self, at: usize) -> Option<u32> {
        self.bytes.get(at..)?.first_chunk().map(|w| u32::from_le_bytes(*w))
    }

    /// Writes the check of a field of `words` words, and steps over it.
    fn field(&mut self, record: u64, kind: u32, words: usize) -> Option<()> {
        let end = self.at.checked_add(4 * words)?;
        let content: Option<Vec<u32>> = (0..words).map(|i| self.word(self.at + 4 * i)).collect();
        let sum = check(record, kind, &content?);
        self.bytes.get_mut(end..end + 4)?.copy_from_slice(&sum.to_le_bytes());
        self.at = end + 4;
        Some(())
    }

    /// Writes the digest of a saved state, and steps over it.
    fn state(&mut self, len: usize) -> Option<()> {
        let state = self.bytes.get_mut(self.at..self.at.checked_add(len)?)?;
        let (content, hash) = state.split_last_chunk_mut::<8>()?;
        *hash = sinew::math::digest::of_bytes(content).to_le_bytes();
        self.at += len;
        Some(())
    }

    fn record(&mut self, record: u64, joints: u32, state: usize) -> Option<Tag> {
        let letters = *self.bytes.get(self.at..)?.first_chunk()?;
        let tag = Tag::from_letters(letters)?;
        self.at += 4;
        let event = u32::from_le_bytes(letters);
        match tag {
            Tag::Pose | Tag::Clip => {
                self.field(record, DT, 1)?;
                self.field(record, ROOT, 10)?;
                if tag == Tag::Clip {
                    self.field(record, CLIP, 2)?;
                } else {
                    (0..joints).try_for_each(|i| self.field(record, FIRST_JOINT + i, 12))?;
                }
                self.field(record, OUTCOME, 11)?;
            }
            Tag::Snapshot | Tag::Load => self.state(state)?,
            Tag::Tunables => self.field(record, event, sinew::Tunables::WORDS)?,
            Tag::Freeze | Tag::Divisor => self.field(record, event, 1)?,
            Tag::Reset | Tag::Settle | Tag::Teleport => self.field(record, event, 0)?,
            Tag::End => self.field(record, END, 4)?,
        }
        Some(tag)
    }
}

/// Rewrites the checks of header, states and records, as far as they can be read.
pub(super) fn replay(bytes: &mut [u8]) {
    if bytes.len() < HEADER_LEN {
        return;
    }
    let mut walk = Walk { bytes, at: 4 };
    for field in HeaderField::ALL {
        walk.field(u64::MAX, field.index(), 2);
    }
    let value = |walk: &Walk<'_>, field: HeaderField| walk.word(4 + 12 * field.index() as usize).unwrap_or(0);
    let (joints, state) = (value(&walk, HeaderField::Joints), value(&walk, HeaderField::StateLen) as usize);
    // A count beyond the bytes ends the walk by itself, field by field.
    let mut record = 0;
    if walk.state(state).is_some() {
        while walk.record(record, joints, state).is_some_and(|tag| tag != Tag::End) {
            record += 1;
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::recording::{record, with_character};

    /// On an undamaged recording there is nothing to do; with its checks wiped out they come back.
    #[test]
    fn wiped_checks_come_back() {
        let whole = with_character(|c| record(c, 6));
        let mut bytes = whole.clone();
        super::replay(&mut bytes);
        assert!(bytes == whole, "nothing changes");
        bytes[4 + 8] ^= 0xff; // of the header
        let end = bytes.len() - 1;
        bytes[end] ^= 0xff; // of the end
        super::replay(&mut bytes);
        assert!(bytes == whole, "both are back");
    }
}
