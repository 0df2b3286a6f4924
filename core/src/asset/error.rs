//! Why bytes are not an asset.

use super::layout::Section;
use core::fmt;

/// Why bytes are not an asset that this version can read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum AssetError {
    /// The bytes end before the header and the section table do.
    TooShort {
        /// Bytes needed.
        expected: u64,
        /// Bytes given.
        found: u64,
    },
    /// The file does not start with the magic bytes.
    BadMagic([u8; 4]),
    /// The file is of a version that this build does not know.
    UnsupportedVersion(u16),
    /// The length in the header is not the file's.
    WrongLength {
        /// Length in the header.
        expected: u64,
        /// Length of the bytes.
        found: u64,
    },
    /// The content hash does not fit: the file is damaged.
    WrongHash {
        /// Hash in the header.
        expected: u64,
        /// Hash of the content.
        found: u64,
    },
    /// The bytes do not start on a multiple of 4.
    Misaligned,
    /// The section table does not list the sections of this version in their order.
    WrongSection(Section),
    /// A section does not have the length that the counts ask for, or not its place.
    WrongExtent(Section),
    /// Bytes that must be zero are not.
    NotZero {
        /// First such byte.
        offset: u64,
    },
    /// An entry of a section is out of its range.
    Invalid {
        /// The section.
        section: Section,
        /// Index of the entry.
        index: u32,
    },
}

impl AssetError {
    /// Stable name of the error, for programs; its text may change, this does not.
    #[must_use]
    pub const fn code(&self) -> &'static str {
        match self {
            Self::TooShort { .. } => "ASSET_TOO_SHORT",
            Self::BadMagic(_) => "ASSET_BAD_MAGIC",
            Self::UnsupportedVersion(_) => "ASSET_UNSUPPORTED_VERSION",
            Self::WrongLength { .. } => "ASSET_WRONG_LENGTH",
            Self::WrongHash { .. } => "ASSET_WRONG_HASH",
            Self::Misaligned => "ASSET_MISALIGNED",
            Self::WrongSection(_) => "ASSET_WRONG_SECTION",
            Self::WrongExtent(_) => "ASSET_WRONG_EXTENT",
            Self::NotZero { .. } => "ASSET_NOT_ZERO",
            Self::Invalid { .. } => "ASSET_INVALID_ENTRY",
        }
    }
}

impl fmt::Display for AssetError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::TooShort { expected, found } => {
                write!(f, "asset has {found} bytes, at least {expected} are needed")
            }
            Self::BadMagic(bytes) => {
                write!(f, "not a sinew asset: starts with \"{}\"", bytes.escape_ascii())
            }
            Self::UnsupportedVersion(v) => {
                write!(f, "asset version {v} is not supported; bake it again with this version")
            }
            Self::WrongLength { expected, found } => {
                write!(f, "asset should have {expected} bytes but has {found}: truncated or extended")
            }
            Self::WrongHash { expected, found } => {
                write!(f, "asset is damaged: content hash {found:016x}, header says {expected:016x}")
            }
            Self::Misaligned if cfg!(target_endian = "big") => {
                f.write_str("a big-endian machine needs `parse_into`")
            }
            Self::Misaligned => f.write_str("asset bytes must start on a multiple of 4"),
            Self::WrongSection(section) => write!(f, "section {section} is missing or out of order"),
            Self::WrongExtent(section) => write!(f, "section {section} has a wrong place or length"),
            Self::NotZero { offset } => write!(f, "byte {offset} must be zero"),
            Self::Invalid { section, index } => {
                write!(f, "section {section}, entry {index} is out of range")
            }
        }
    }
}

impl core::error::Error for AssetError {}
