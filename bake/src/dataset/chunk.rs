//! A sample as bytes: a head with lengths, the floats, a checksum over both.

use super::header::Header;
use super::store::read_at;
use sinew::math::digest::Digest;
use std::io::{self, Read, Seek};

/// The first bytes of every chunk.
const MARK: [u8; 4] = *b"smpl";
/// Bytes before the lengths: mark, number of arrays, index.
const FIXED: usize = 16;
/// Bytes read at a time: a multiple of the digest's block, so that pieces give the digest of the whole.
const PIECE: usize = 1 << 16;

/// Marks that a search looks behind: floats are hardly ever like one, and a file of nothing else should not take long.
const MOST_TRIED: u32 = 64;

/// Where a sample is in a file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Place {
    /// Index of the sample.
    pub(super) index: u64,
    /// Its first byte.
    pub(super) start: u64,
    /// Its first byte after the lengths.
    pub(super) floats: u64,
    /// Floats of each array.
    pub(super) lengths: Vec<u32>,
}

impl Place {
    /// The first byte after its checksum.
    pub(super) fn end(&self) -> u64 {
        let floats: u64 = self.lengths.iter().copied().map(u64::from).sum();
        self.floats + (4 * floats).next_multiple_of(8) + 8
    }
}

/// Bytes of the head of a chunk with as many arrays.
fn head_len(arrays: usize) -> usize {
    FIXED + (4 * arrays).next_multiple_of(8)
}

/// Writes a sample into `out`, which is cleared before.
pub(super) fn encode(index: u64, arrays: &[&[f32]], out: &mut Vec<u8>) {
    let count = |n: usize| u32::try_from(n).unwrap_or(u32::MAX).to_le_bytes();
    out.clear();
    out.extend(MARK);
    out.extend(count(arrays.len()));
    out.extend(index.to_le_bytes());
    arrays.iter().for_each(|a| out.extend(count(a.len())));
    out.resize(out.len().next_multiple_of(8), 0);
    for array in arrays {
        out.extend(array.iter().flat_map(|x| x.to_le_bytes()));
    }
    out.resize(out.len().next_multiple_of(8), 0);
    let digest = sinew::math::digest::of_bytes(out);
    out.extend(digest.to_le_bytes());
}

/// The chunk that starts at `start` of a store of `length` bytes, by its head alone; `None` where there is none that
/// `header` allows, or where it is not all there.
pub(super) fn at(
    store: &mut (impl Read + Seek),
    header: &Header,
    start: u64,
    length: u64,
) -> io::Result<Option<Place>> {
    let mut head = vec![0; head_len(header.arrays.len())];
    if read_at(store, start, &mut head)? < head.len() {
        return Ok(None);
    }
    let (words, _) = head.as_chunks::<4>();
    let count = u32::try_from(header.arrays.len()).unwrap_or(u32::MAX);
    let mut bytes = [0; 8];
    bytes.copy_from_slice(&head[8..16]);
    let index = u64::from_le_bytes(bytes);
    let lengths: Vec<u32> =
        words[4..].iter().take(header.arrays.len()).map(|w| u32::from_le_bytes(*w)).collect();
    let fits = header.arrays.iter().zip(&lengths).all(|(a, n)| a.allows(u64::from(*n)));
    let expected = words[0] == MARK && words[1] == count.to_le_bytes();
    let place = Place { index, start, floats: start + head.len() as u64, lengths };
    let belongs = header.shard.contains(index) && index < header.samples;
    Ok((expected && fits && belongs && place.end() <= length).then_some(place))
}

/// Whether the checksum of a chunk fits.
pub(super) fn is_whole(store: &mut (impl Read + Seek), place: &Place) -> io::Result<bool> {
    let mut digest = Digest::default();
    let (mut at, end) = (place.start, place.end() - 8);
    let mut piece = vec![0; PIECE];
    while at < end {
        let size = usize::try_from(end - at).unwrap_or(PIECE).min(PIECE);
        if read_at(store, at, &mut piece[..size])? < size {
            return Ok(false);
        }
        digest.bytes(&piece[..size]);
        at += size as u64;
    }
    let mut stored = [0; 8];
    Ok(read_at(store, end, &mut stored)? == 8 && stored == digest.finish().to_le_bytes())
}

/// The first whole chunk that starts at `from` (a multiple of 8, as all do) or later.
pub(super) fn search(
    store: &mut (impl Read + Seek),
    header: &Header,
    from: u64,
    length: u64,
) -> io::Result<Option<Place>> {
    let mut piece = vec![0; PIECE];
    let (mut at, mut tried) = (from, 0);
    while at < length && tried < MOST_TRIED {
        let size = read_at(store, at, &mut piece)?;
        for start in (0..size.saturating_sub(3)).step_by(8).filter(|s| piece[*s..].starts_with(&MARK)) {
            tried += 1;
            if let Some(place) = self::at(store, header, at + start as u64, length)?
                && is_whole(store, &place)?
            {
                return Ok(Some(place));
            }
        }
        at += PIECE as u64;
    }
    Ok(None)
}

/// The arrays of a chunk, or `None` where its checksum does not fit.
pub(super) fn decode(store: &mut (impl Read + Seek), place: &Place) -> io::Result<Option<Vec<Vec<f32>>>> {
    let Ok(size) = usize::try_from(place.end() - place.start) else { return Ok(None) };
    let mut bytes = vec![0; size];
    if read_at(store, place.start, &mut bytes)? < size {
        return Ok(None);
    }
    let (content, stored) = bytes.split_at(size - 8);
    if stored != sinew::math::digest::of_bytes(content).to_le_bytes() {
        return Ok(None);
    }
    let (words, _) = content[head_len(place.lengths.len())..].as_chunks::<4>();
    let mut rest = words;
    let mut arrays = Vec::with_capacity(place.lengths.len());
    for n in &place.lengths {
        let (array, after) = rest.split_at(*n as usize);
        arrays.push(array.iter().map(|w| f32::from_le_bytes(*w)).collect());
        rest = after;
    }
    Ok(Some(arrays))
}
