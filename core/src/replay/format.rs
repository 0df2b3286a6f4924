//! Where everything stands in a replay: one table for reader, writer and documentation.

use crate::math::noise;
use core::fmt;

/// First bytes of a replay.
pub const MAGIC: [u8; 4] = *b"SNRP";
/// The version of the format that this build writes and reads.
pub const VERSION: u64 = 1;
/// Number of the arithmetic: raised with every change of the code that changes a bit of a result.
pub const KERNEL_VERSION: u32 = 3;
/// Bytes of the header.
pub const HEADER_LEN: usize = 4 + HeaderField::ALL.len() * 12;

/// Defines an enum with a table of its values and their names.
macro_rules! table {
    ($(#[$doc:meta])* $name:ident: $type:ty, $value:ident; $($(#[$d:meta])* $variant:ident $v:expr, $text:literal;)*) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub enum $name { $($(#[$d])* $variant,)* }

        impl $name {
            /// All of them, in order.
            pub const ALL: [Self; [$($text),*].len()] = [$(Self::$variant),*];

            /// What stands for it in the file.
            #[must_use]
            pub const fn $value(self) -> $type {
                match self { $(Self::$variant => $v,)* }
            }
        }

        impl fmt::Display for $name {
            fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str(match self { $(Self::$variant => $text,)* })
            }
        }
    };
}

table! {
    /// A field of the header, in file order.
    HeaderField: u32, index;
    /// Version of the format.
    FormatVersion 0, "format version";
    /// [`KERNEL_VERSION`] of the recorder.
    KernelVersion 1, "kernel version";
    /// Version of the digest's algorithm ([`crate::math::digest::VERSION`]).
    DigestVersion 2, "digest version";
    /// [`crate::math::canary`] word where the recording began.
    Canary 3, "canary";
    /// Content hash of the asset.
    AssetHash 4, "asset hash";
    /// Joints of a pose.
    Joints 5, "joint count";
    /// Moving points.
    ActivePoints 6, "active points";
    /// Bytes of a saved state.
    StateLen 7, "state length";
    /// Frames between two snapshots; 0 for none but the first and the last.
    SnapshotEvery 8, "snapshot interval";
}

table! {
    /// What a record is; any two tags differ in two letters at least.
    Tag: [u8; 4], letters;
    /// A step to a pose.
    Pose *b"pose", "step";
    /// A step to a moment of a clip.
    Clip *b"clip", "clip step";
    /// State after the frame before.
    Snapshot *b"snAP", "snapshot";
    /// Tunables changed.
    Tunables *b"tUnE", "tunables";
    /// Motion forgotten.
    Reset *b"rEsT", "reset";
    /// Settling asked for.
    Settle *b"setL", "settle";
    /// A teleport declared.
    Teleport *b"TELp", "teleport";
    /// Frozen or thawed.
    Freeze *b"Frze", "freeze";
    /// Rate divisor changed.
    Divisor *b"DIvr", "rate divisor";
    /// A saved state restored.
    Load *b"LoaD", "load";
    /// The end.
    End *b"END.", "end";
}

impl Tag {
    /// The tag with these letters.
    #[must_use]
    pub fn from_letters(letters: [u8; 4]) -> Option<Self> {
        Self::ALL.into_iter().find(|tag| tag.letters() == letters)
    }
}

/// Check of a field: of the number of its record (the header counts as the last of all), its kind and its words.
///
/// `hₖ₊₁ = rot₁₅((hₖ ⊕ wordₖ)·K)`: a bijection of each word, so a change within one word is always seen.
#[must_use]
pub fn check(record: u64, kind: u32, words: &[u32]) -> u32 {
    let [a, b, c, d, e, f, g, h] = record.to_le_bytes();
    let head = [u32::from_le_bytes([a, b, c, d]), u32::from_le_bytes([e, f, g, h]), kind];
    let mix = |h: u32, word: &u32| (h ^ word).wrapping_mul(0x9e37_79b1).rotate_left(15);
    noise::hash(head.iter().chain(words).fold(0x534e_5250, mix))
}

/// Number of the header for [`check`].
pub(super) const HEADER_RECORD: u64 = u64::MAX;

/// Low and high word.
pub(super) fn split(x: u64) -> [u32; 2] {
    #[allow(clippy::cast_possible_truncation, reason = "the low and the high half")]
    [x as u32, (x >> 32) as u32]
}

/// The inverse of [`split`].
pub(super) fn join([low, high]: [u32; 2]) -> u64 {
    u64::from(low) | (u64::from(high) << 32)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_tags_differ_in_two_letters() {
        for (i, a) in Tag::ALL.iter().enumerate() {
            for b in &Tag::ALL[..i] {
                let differing = a.letters().iter().zip(b.letters()).filter(|(x, y)| **x != *y).count();
                assert!(differing >= 2, "{a} and {b}");
            }
            assert_eq!(Tag::from_letters(a.letters()), Some(*a));
        }
    }

    #[test]
    fn every_bit_of_a_field_and_its_place_count() {
        let words: [u32; 12] = core::array::from_fn(|i| 0x3f80_0000 + 77 * u32::try_from(i).unwrap());
        let whole = check(7, 3, &words);
        for i in 0..12 {
            for bit in 0..32 {
                let mut other = words;
                other[i] ^= 1 << bit;
                assert_ne!(check(7, 3, &other), whole, "word {i} bit {bit}");
            }
        }
        assert_ne!(check(8, 3, &words), whole);
        assert_ne!(check(7, 4, &words), whole);
        assert_ne!(check(7, 3, &words[..11]), whole);
        assert_eq!(whole, 0x71de_234d, "{whole:#x}");
    }
}
