//! Sections, one after the other, then the header with the hash.

use crate::Error;
use sinew::asset::Section;
use sinew::asset::layout::{ALIGNMENT, ENTRY_LEN, HASH_OFFSET, HEADER_LEN, MAGIC, VERSION};
use sinew::kernel::tiny::flush;

/// Collects the sections of an asset in file order.
#[derive(Debug, Default)]
pub(super) struct AssetWriter {
    sections: Vec<Vec<u8>>,
}

/// A name cut to `N` bytes at a character, padded with zeros.
pub(super) fn padded<const N: usize>(name: &str) -> [u8; N] {
    let mut out = [0; N];
    let clean = name.split('\0').next().unwrap_or("");
    let end = (0..=N.min(clean.len())).rev().find(|i| clean.is_char_boundary(*i)).unwrap_or(0);
    out[..end].copy_from_slice(&clean.as_bytes()[..end]);
    out
}

impl AssetWriter {
    /// Adds a section of bytes.
    ///
    /// # Panics
    ///
    /// If it is not the next in file order.
    pub(super) fn bytes(&mut self, section: Section, bytes: &[u8]) {
        assert!(Section::ALL[self.sections.len()] == section, "section {section} is out of order");
        self.sections.push(bytes.to_vec());
    }

    pub(super) fn words(&mut self, section: Section, words: &[u32]) {
        let bytes: Vec<u8> = words.iter().flat_map(|w| w.to_le_bytes()).collect();
        self.bytes(section, &bytes);
    }

    pub(super) fn halves(&mut self, section: Section, words: &[u16]) {
        let bytes: Vec<u8> = words.iter().flat_map(|w| w.to_le_bytes()).collect();
        self.bytes(section, &bytes);
    }

    /// Adds floats; −0 and what is too small to matter is written as +0. Values of clips are flushed where they are
    /// sampled.
    pub(super) fn floats(&mut self, section: Section, floats: &[f32]) {
        let flush = if section == Section::Values { |x| x } else { flush };
        let bytes: Vec<u8> = floats.iter().flat_map(|x| (flush(*x) + 0.0).to_le_bytes()).collect();
        self.bytes(section, &bytes);
    }

    /// The file.
    pub(super) fn finish(self, name: &str) -> Result<Vec<u8>, Error> {
        let table_end = HEADER_LEN + Section::ALL.len() * ENTRY_LEN;
        let mut out = vec![0; table_end];
        let too_large = |_| {
            Error::unusable(
                name,
                "packing",
                "the asset is larger than 4 GiB",
                "split the character into parts",
            )
        };
        for (i, (section, bytes)) in Section::ALL.iter().zip(&self.sections).enumerate() {
            out.resize(out.len().next_multiple_of(ALIGNMENT), 0);
            let (offset, len) = (u32::try_from(out.len()), u32::try_from(bytes.len()));
            let entry = HEADER_LEN + i * ENTRY_LEN;
            out[entry..entry + 4].copy_from_slice(&section.tag());
            out[entry + 4..entry + 8].copy_from_slice(&offset.map_err(too_large)?.to_le_bytes());
            out[entry + 8..entry + 12].copy_from_slice(&len.map_err(too_large)?.to_le_bytes());
            out.extend_from_slice(bytes);
        }
        let len = u32::try_from(out.len()).map_err(too_large)?;
        let sections = u16::try_from(Section::ALL.len()).unwrap_or(u16::MAX);
        out[..4].copy_from_slice(&MAGIC);
        out[4..6].copy_from_slice(&VERSION.to_le_bytes());
        out[6..8].copy_from_slice(&sections.to_le_bytes());
        out[8..12].copy_from_slice(&len.to_le_bytes());
        let hash = sinew::asset::content_hash(&out);
        out[HASH_OFFSET..HASH_OFFSET + 8].copy_from_slice(&hash.to_le_bytes());
        Ok(out)
    }
}

#[cfg(test)]
mod tests {
    use super::padded;

    #[test]
    fn names_are_cut_at_a_character() {
        assert_eq!(&padded::<4>("abc"), b"abc\0");
        assert_eq!(&padded::<4>("abcdef"), b"abcd");
        assert_eq!(&padded::<4>("abc\u{e9}"), b"abc\0");
    }
}
