//! The asset: bytes in, validated views out, once. After [`Asset::parse`] succeeds nothing can fail.
//!
//! ```text
//! header   32 bytes: "SINW", version u16, sections u16, length u32, 0 u32, content hash u64, 0 u64
//! table    16 bytes a section: tag, offset u32, length u32, 0 u32
//! sections in the order of [`Section`], each on a multiple of 16, gaps zero, nothing after the last
//! ```
//!
//! Little-endian. The content hash ([`crate::math::digest`]) covers every byte but its own eight.
//! Views borrow the bytes; nothing is copied. Lengths follow from the counts in [`Meta`].

#![deny(clippy::arithmetic_side_effects, clippy::indexing_slicing)]

mod error;
pub mod layout;
mod validate;

pub use error::AssetError;
pub use layout::{Meta, Section};

use crate::kernel::clip::Channels;
use crate::kernel::normal::Stencils;
use crate::kernel::skin::Influences;
use crate::math::affine::Affine;
use crate::math::digest::Digest;
use layout::{ALIGNMENT, ENTRY_LEN, HASH_OFFSET, HEADER_LEN, MAGIC, META_WORDS, VERSION};

/// A character as the runtime needs it: views over the bytes of a file.
#[derive(Clone, Copy, Debug)]
pub struct Asset<'a> {
    /// Counts and constants.
    pub meta: Meta,
    /// Content hash: the identity of the asset.
    pub hash: u64,
    /// Inverse bind matrix of each joint.
    pub joint_from_bind: &'a [Affine],
    /// Node of each joint.
    pub joint_node: &'a [u32],
    /// Rest position of each point, bind space.
    pub rest: &'a [[f32; 3]],
    /// Influences of each point.
    pub influences: Influences<'a>,
    /// Region of each active point.
    pub region_of_point: &'a [u8],
    /// Softness of each active point.
    pub softness: &'a [f32],
    /// Point of each render vertex.
    pub point_of_vertex: &'a [u32],
    /// Rest normal of each render vertex, bind space.
    pub normals: &'a [[f32; 3]],
    /// Render vertices on active points.
    pub moved: &'a [u32],
    /// Render vertices whose normals turn.
    pub stencils: Stencils<'a>,
    /// Frequency, damping ratio, gain, largest offset of each region.
    pub regions: &'a [[f32; 4]],
    region_names: &'a [[u8; 16]],
    /// `[node in the file, mesh, primitive, first vertex, vertices, 0]` of each primitive.
    pub primitives: &'a [[u32; 6]],
    /// Parent of each node.
    pub parents: &'a [u32],
    /// Index of each node in the file it came from.
    pub node_index: &'a [u32],
    /// Rest translation, rotation and scale of each node.
    pub node_rest: &'a [[f32; 10]],
    clips: &'a [[u32; 4]],
    clip_names: &'a [[u8; 32]],
    channels: Channels<'a>,
}

/// An animation clip of an asset.
#[derive(Clone, Copy, Debug)]
pub struct Clip<'a> {
    /// Name.
    pub name: &'a str,
    /// Length, s.
    pub duration: f32,
    /// Animated properties.
    pub channels: Channels<'a>,
}

/// Text up to the first zero byte; validated by [`Asset::parse`].
fn text(bytes: &[u8]) -> &str {
    let end = bytes.iter().position(|b| *b == 0).unwrap_or(bytes.len());
    bytes.get(..end).and_then(|b| core::str::from_utf8(b).ok()).unwrap_or("")
}

impl<'a> Asset<'a> {
    /// Reads and checks an asset where it lies, on a multiple of 4 bytes.
    ///
    /// # Errors
    ///
    /// [`AssetError`] for bytes that are not a whole, undamaged asset of this version;
    /// [`AssetError::Misaligned`] always on a big-endian machine, where [`Self::parse_into`] reads it.
    pub fn parse(bytes: &'a [u8]) -> Result<Self, AssetError> {
        let (hash, meta) = check(bytes)?;
        if cfg!(target_endian = "big") {
            return Err(AssetError::Misaligned);
        }
        Self::of_sections(meta, hash, bytes)
    }

    /// Reads and checks an asset that lies anywhere, on a machine of any byte order: `buffer` takes a copy.
    ///
    /// # Errors
    ///
    /// As [`Self::parse`]; [`AssetError::TooShort`] if `buffer` has fewer than `bytes.len() / 4` words, rounded up.
    pub fn parse_into(bytes: &[u8], buffer: &'a mut [u32]) -> Result<Self, AssetError> {
        let (hash, meta) = check(bytes)?;
        let (expected, found) = (bytes.len() as u64, (buffer.len() as u64).saturating_mul(4));
        let copy: &mut [u8] = bytemuck::cast_slice_mut(buffer);
        let copy = copy.get_mut(..bytes.len()).ok_or(AssetError::TooShort { expected, found })?;
        copy.copy_from_slice(bytes);
        if cfg!(target_endian = "big") {
            Sections::locate(bytes, &meta)?;
            swap_sections(copy, &meta);
        }
        Self::of_sections(meta, hash, copy)
    }

    /// Views of sections in this machine's byte order.
    fn of_sections(meta: Meta, hash: u64, bytes: &'a [u8]) -> Result<Self, AssetError> {
        let asset = Self::view(meta, hash, &Sections::locate(bytes, &meta)?)?;
        validate::validate(&asset)?;
        Ok(asset)
    }

    fn view(meta: Meta, hash: u64, s: &Sections<'a>) -> Result<Self, AssetError> {
        Ok(Self {
            meta,
            hash,
            joint_from_bind: s.cast(Section::JointFromBind)?,
            joint_node: s.cast(Section::JointNode)?,
            rest: s.cast(Section::Rest)?,
            influences: Influences {
                sets: (meta.stride / 4) as usize,
                joints: s.cast(Section::InfluenceJoints)?,
                weights: s.cast(Section::InfluenceWeights)?,
            },
            region_of_point: s.cast(Section::RegionOfPoint)?,
            softness: s.cast(Section::Softness)?,
            point_of_vertex: s.cast(Section::PointOfVertex)?,
            normals: s.cast(Section::Normals)?,
            moved: s.cast(Section::Moved)?,
            stencils: Stencils {
                vertices: s.cast(Section::Lit)?,
                points: s.cast(Section::StencilPoints)?,
                tangents: s.cast(Section::StencilTangents)?,
            },
            regions: s.cast(Section::Regions)?,
            region_names: s.cast(Section::RegionNames)?,
            primitives: s.cast(Section::Primitives)?,
            parents: s.cast(Section::Parents)?,
            node_index: s.cast(Section::NodeIndex)?,
            node_rest: s.cast(Section::NodeRest)?,
            clips: s.cast(Section::Clips)?,
            clip_names: s.cast(Section::ClipNames)?,
            channels: Channels {
                rows: s.cast(Section::Channels)?,
                times: s.cast(Section::Times)?,
                values: s.cast(Section::Values)?,
            },
        })
    }

    /// Clip `i`, or `None` past the last.
    #[must_use]
    pub fn clip(&self, i: usize) -> Option<Clip<'a>> {
        let [first, count, duration, _] = *self.clips.get(i)?;
        let end = (first as usize).checked_add(count as usize)?;
        let channels = Channels { rows: self.channels.rows.get(first as usize..end)?, ..self.channels };
        let duration = f32::from_bits(duration);
        Some(Clip { name: text(self.clip_names.get(i)?), duration, channels })
    }

    /// Index of the clip called `name`.
    #[must_use]
    pub fn clip_index(&self, name: &str) -> Option<usize> {
        self.clip_names.iter().position(|n| text(n) == name)
    }

    /// Name of region `i`, empty past the last.
    #[must_use]
    pub fn region_name(&self, i: usize) -> &'a str {
        self.region_names.get(i).map_or("", |n| text(n))
    }
}

/// Header and counts.
fn check(bytes: &[u8]) -> Result<(u64, Meta), AssetError> {
    let hash = check_header(bytes)?;
    let start = TABLE_END.next_multiple_of(ALIGNMENT);
    let meta_bytes = bytes.get(start..).unwrap_or_default();
    let words: [u8; META_WORDS * 4] =
        *meta_bytes.first_chunk().ok_or(AssetError::WrongExtent(Section::Meta))?;
    let words = core::array::from_fn(|i| {
        let start = i.saturating_mul(4);
        words.get(start..).and_then(|w| w.first_chunk()).map_or(0, |w| u32::from_le_bytes(*w))
    });
    let meta = Meta::from_words(&words);
    if meta.to_words() != words {
        return Err(AssetError::NotZero { offset: start as u64 });
    }
    Ok((hash, meta))
}

/// Reverses the bytes of every number in the sections of a located asset.
fn swap_sections(bytes: &mut [u8], meta: &Meta) {
    let mut rest = bytes.get_mut(TABLE_END..).unwrap_or_default();
    let mut at = TABLE_END;
    for section in Section::ALL {
        let start = at.next_multiple_of(ALIGNMENT);
        let len = usize::try_from(section.byte_len(meta)).unwrap_or(usize::MAX);
        let (Some(gap), end) = (start.checked_sub(at), start.saturating_add(len)) else { return };
        let Some((_, tail)) = rest.split_at_mut_checked(gap) else { return };
        let Some((content, tail)) = tail.split_at_mut_checked(len) else { return };
        content.chunks_exact_mut(section.width()).for_each(<[u8]>::reverse);
        (rest, at) = (tail, end);
    }
}

/// Where the table ends.
const TABLE_END: usize = HEADER_LEN + Section::ALL.len() * ENTRY_LEN;

/// Magic, version, lengths, hash.
fn check_header(bytes: &[u8]) -> Result<u64, AssetError> {
    let header: &[u8; HEADER_LEN] = bytes
        .first_chunk()
        .ok_or(AssetError::TooShort { expected: HEADER_LEN as u64, found: bytes.len() as u64 })?;
    let [m0, m1, m2, m3, v0, v1, n0, n1, l0, l1, l2, l3, rest @ ..] = *header;
    let [z0, z1, z2, z3, h0, h1, h2, h3, h4, h5, h6, h7, tail @ ..] = rest;
    if [m0, m1, m2, m3] != MAGIC {
        return Err(AssetError::BadMagic([m0, m1, m2, m3]));
    }
    let version = u16::from_le_bytes([v0, v1]);
    if version != VERSION {
        return Err(AssetError::UnsupportedVersion(version));
    }
    let (expected, found) = (u64::from(u32::from_le_bytes([l0, l1, l2, l3])), bytes.len() as u64);
    if expected != found {
        return Err(AssetError::WrongLength { expected, found });
    }
    let hash = u64::from_le_bytes([h0, h1, h2, h3, h4, h5, h6, h7]);
    let content = content_hash(bytes);
    if hash != content {
        return Err(AssetError::WrongHash { expected: hash, found: content });
    }
    if tail != [0; 8] {
        return Err(AssetError::NotZero { offset: HASH_OFFSET.saturating_add(8) as u64 });
    }
    let sections = usize::from(u16::from_le_bytes([n0, n1]));
    if sections != Section::ALL.len() || [z0, z1, z2, z3] != [0; 4] {
        return Err(AssetError::WrongSection(Section::Meta));
    }
    Ok(hash)
}

/// Hash of an asset's bytes without the eight of the hash itself.
#[must_use]
pub fn content_hash(bytes: &[u8]) -> u64 {
    let mut digest = Digest::default();
    digest.bytes(bytes.get(..HASH_OFFSET).unwrap_or(bytes));
    digest.bytes(bytes.get(HASH_OFFSET.saturating_add(8)..).unwrap_or_default());
    digest.finish()
}

/// The sections' bytes, in the order of [`Section::ALL`].
struct Sections<'a>([&'a [u8]; Section::ALL.len()]);

impl<'a> Sections<'a> {
    /// Checks the table: every section in its place, gaps zero, nothing after the last.
    fn locate(bytes: &'a [u8], meta: &Meta) -> Result<Self, AssetError> {
        let mut sections = [&[][..]; Section::ALL.len()];
        let table = bytes.get(HEADER_LEN..).unwrap_or_default();
        let mut end = TABLE_END as u64;
        let slots = sections.iter_mut().zip(Section::ALL).zip(table.chunks_exact(ENTRY_LEN));
        for ((slot, section), entry) in slots {
            let [t0, t1, t2, t3, o0, o1, o2, o3, l0, l1, l2, l3, zero @ ..] =
                *entry.first_chunk::<ENTRY_LEN>().ok_or(AssetError::WrongSection(section))?;
            let (offset, len) = (u32::from_le_bytes([o0, o1, o2, o3]), u32::from_le_bytes([l0, l1, l2, l3]));
            if [t0, t1, t2, t3] != section.tag() || zero != [0; 4] {
                return Err(AssetError::WrongSection(section));
            }
            let start = end.next_multiple_of(ALIGNMENT as u64);
            let next = start.saturating_add(len.into());
            if u64::from(offset) != start || u64::from(len) != section.byte_len(meta) {
                return Err(AssetError::WrongExtent(section));
            }
            let range = |a: u64, b: u64| bytes.get(usize::try_from(a).ok()?..usize::try_from(b).ok()?);
            let gap = range(end, start).ok_or(AssetError::WrongExtent(section))?;
            if gap.iter().any(|b| *b != 0) {
                return Err(AssetError::NotZero { offset: end });
            }
            *slot = range(start, next).ok_or(AssetError::WrongExtent(section))?;
            end = next;
        }
        let found = bytes.len() as u64;
        if found != end { Err(AssetError::WrongLength { expected: end, found }) } else { Ok(Self(sections)) }
    }

    fn cast<T: bytemuck::AnyBitPattern>(&self, section: Section) -> Result<&'a [T], AssetError> {
        let bytes = Section::ALL.iter().position(|s| *s == section).and_then(|i| self.0.get(i));
        bytemuck::try_cast_slice(bytes.copied().unwrap_or_default()).map_err(|_| AssetError::Misaligned)
    }
}
