//! A seeded mutator: the same inputs from the same seed, on any compiler.

use crate::random::Random;
use crate::special;

/// Numbers that break length and index arithmetic.
const AWKWARD: [u32; 12] =
    [0, 1, 2, 3, 4, 255, 256, 65_535, 0x7fff_ffff, 0x8000_0000, 0xffff_fffe, 0xffff_ffff];
/// Pieces of text that parsers treat apart.
const TEXT: [&[u8]; 16] = [
    b"null",
    b"true",
    b"-1",
    b"1e999",
    b"-0.0",
    b"4294967296",
    b"NaN",
    b"{}",
    b"[]",
    b"\"\"",
    b"[[",
    b"\\u0000",
    b"inf",
    b"0.5",
    b"\xef\xbb\xbf",
    b",",
];
/// Longest input made.
const LONGEST: usize = 1 << 16;

/// One of `seeds`, changed in one to eight places.
#[must_use]
pub fn mutated(seeds: &[Vec<u8>], random: &mut Random) -> Vec<u8> {
    let pick = |random: &mut Random| &seeds[random.below(u32::try_from(seeds.len()).unwrap_or(1)) as usize];
    let mut bytes = pick(random).clone();
    for _ in 0..=random.below(8) {
        let other = pick(random);
        change(&mut bytes, other, random);
    }
    bytes.truncate(LONGEST);
    bytes
}

/// A place in `0..=len`.
fn place(len: usize, random: &mut Random) -> usize {
    random.below(u32::try_from(len).unwrap_or(u32::MAX - 1) + 1) as usize
}

/// A piece of `bytes`, mostly short.
fn piece(bytes: &[u8], random: &mut Random) -> (usize, usize) {
    let start = place(bytes.len(), random);
    let most = [4, 16, 64, 4096][random.below(4) as usize];
    (start, (start + place(most, random)).min(bytes.len()))
}

fn overwrite(bytes: &mut [u8], at: usize, with: &[u8]) {
    for (to, from) in bytes.iter_mut().skip(at).zip(with) {
        *to = *from;
    }
}

fn change(bytes: &mut Vec<u8>, other: &[u8], random: &mut Random) {
    let at = place(bytes.len(), random);
    let aligned = at & !3;
    match random.below(12) {
        0 | 1 => {
            if let Some(byte) = bytes.get_mut(at) {
                *byte ^= 1 << random.below(8);
            }
        }
        2 => overwrite(bytes, at, &random.word().to_le_bytes()[..1]),
        3 => overwrite(bytes, aligned, &AWKWARD[random.below(12) as usize].to_le_bytes()),
        4 => {
            let values = special::all();
            let value = values[random.below(u32::try_from(values.len()).unwrap_or(1)) as usize];
            overwrite(bytes, aligned, &value.to_le_bytes());
        }
        5 => {
            let Some(word) = bytes.get(aligned..).and_then(|b| b.first_chunk()) else { return };
            let near = u32::from_le_bytes(*word).wrapping_add(random.below(9)).wrapping_sub(4);
            overwrite(bytes, aligned, &near.to_le_bytes());
        }
        6 => {
            let (start, end) = piece(bytes, random);
            bytes.drain(start..end);
        }
        7 => {
            let (start, end) = piece(bytes, random);
            let copy = bytes[start..end].to_vec();
            bytes.splice(at..at, copy);
        }
        8 => {
            let (start, end) = piece(other, random);
            overwrite(bytes, at, &other[start..end]);
        }
        9 => {
            let (start, end) = piece(other, random);
            bytes.splice(at..at, other[start..end].iter().copied());
        }
        10 => {
            let text = TEXT[random.below(16) as usize];
            let end = (at + place(6, random)).min(bytes.len());
            bytes.splice(at..end, text.iter().copied());
        }
        _ => bytes.truncate(at),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_same_seed_gives_the_same_inputs() {
        let seeds = [b"{\"a\": [1, 2.5]}".to_vec(), vec![0; 64]];
        let run = |seed| -> Vec<Vec<u8>> {
            let mut random = Random::new(seed);
            (0..2_000).map(|_| mutated(&seeds, &mut random)).collect()
        };
        assert!(run(1) == run(1) && run(1) != run(2), "they follow from the seed alone");
        let changed = run(1).iter().filter(|bytes| !seeds.contains(bytes)).count();
        assert!(changed > 1_900, "{changed} of 2000 are new");
    }
}
