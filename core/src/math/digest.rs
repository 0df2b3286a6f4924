//! The digest of a frame's floats and of a file's bytes.
//!
//! Words are little-endian `u32`; NaN counts as `0x7fc00000`, −0 and subnormals as +0, so that what
//! IEEE 754 leaves open does not enter. Eight words make four 64-bit lanes, mixed by
//! `laneⱼ = (laneⱼ ⊕ wordⱼ)·K` and rotated; a tail is padded with zeros, and the length enters at the end.

/// Number of the algorithm; a change of any rule above raises it.
pub const VERSION: u8 = 1;

const K: u64 = 0x9e37_79b9_7f4a_7c15;
const SEEDS: [u64; 4] =
    [0x243f_6a88_85a3_08d3, 0x1319_8a2e_0370_7344, 0xa409_3822_299f_31d0, 0x082e_fa98_ec4e_6c89];

/// A digest in progress.
#[derive(Clone, Copy, Debug)]
pub struct Digest {
    lanes: [u64; 4],
    words: u64,
}

impl Default for Digest {
    fn default() -> Self {
        Self { lanes: SEEDS, words: 0 }
    }
}

/// Canonical bits of a float (see the module).
#[inline(always)]
#[must_use]
pub fn canonical(bits: u32) -> u32 {
    let magnitude = bits & 0x7fff_ffff;
    let nan = if magnitude > 0x7f80_0000 { 0x7fc0_0000 } else { bits };
    if magnitude < 0x0080_0000 { 0 } else { nan }
}

impl Digest {
    #[inline(always)]
    fn block(&mut self, words: [u32; 8]) {
        for j in 0..4 {
            let pair = u64::from(words[2 * j]) | (u64::from(words[2 * j + 1]) << 32);
            self.lanes[j] = (self.lanes[j] ^ pair).wrapping_mul(K).rotate_left(29);
        }
    }

    /// Adds floats by their canonical bits.
    pub fn floats(&mut self, x: &[f32]) {
        let (blocks, tail) = x.as_chunks::<8>();
        for block in blocks {
            self.block(block.map(|x| canonical(x.to_bits())));
        }
        if !tail.is_empty() {
            let mut last = [0; 8];
            for (word, x) in last.iter_mut().zip(tail) {
                *word = canonical(x.to_bits());
            }
            self.block(last);
        }
        self.words = self.words.wrapping_add(x.len() as u64);
    }

    /// Adds vectors.
    pub fn vectors(&mut self, x: &[[f32; 3]]) {
        self.floats(x.as_flattened());
    }

    /// Adds bytes as they are, four to a word.
    pub fn bytes(&mut self, x: &[u8]) {
        let (blocks, tail) = x.as_chunks::<32>();
        let words = |block: &[u8; 32]| {
            let (words, _) = block.as_chunks::<4>();
            core::array::from_fn(|i| u32::from_le_bytes(words[i]))
        };
        for block in blocks {
            self.block(words(block));
        }
        if !tail.is_empty() {
            let mut last = [0; 32];
            last[..tail.len()].copy_from_slice(tail);
            self.block(words(&last));
        }
        self.words = self.words.wrapping_add(x.len() as u64);
    }

    /// The 64 bits.
    #[must_use]
    pub fn finish(self) -> u64 {
        let [a, b, c, d] = self.lanes;
        let mut x = (a ^ c.rotate_left(17)).wrapping_mul(K) ^ (b ^ d.rotate_left(43)).wrapping_mul(K);
        x ^= self.words;
        x = (x ^ (x >> 32)).wrapping_mul(K);
        x ^ (x >> 29)
    }
}

/// Digest of bytes alone.
#[must_use]
pub fn of_bytes(x: &[u8]) -> u64 {
    let mut digest = Digest::default();
    digest.bytes(x);
    digest.finish()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(x: &[f32]) -> u64 {
        let mut digest = Digest::default();
        digest.floats(x);
        digest.finish()
    }

    #[test]
    fn what_ieee_leaves_open_does_not_enter() {
        assert_eq!(of(&[f32::NAN, 0.0]), of(&[f32::from_bits(0xffc1_2345), -0.0]));
        assert_eq!(of(&[1.0, 0.0]), of(&[1.0, f32::from_bits(0x8000_0007)]));
        assert_ne!(of(&[1.0]), of(&[-1.0]));
        assert_ne!(of(&[0.0; 3]), of(&[0.0; 4]));
    }

    #[test]
    fn every_bit_of_every_word_counts() {
        let x: [f32; 19] =
            core::array::from_fn(|i| f32::from_bits(0x3f80_0000 + 77 * u32::try_from(i).unwrap()));
        for i in 0..19 {
            for bit in 0..32 {
                let mut y = x;
                y[i] = f32::from_bits(y[i].to_bits() ^ (1 << bit));
                assert_ne!(of(&x), of(&y), "word {i} bit {bit}");
            }
        }
    }

    #[test]
    fn the_algorithm_is_pinned() {
        let got = of_bytes(b"sinew digest version 1, do not change silently");
        assert_eq!(got, 0x927d_1984_b2a5_0c80, "{got:#018x}");
    }

    /// Goal: 5 GB/s, so that a character's state and outputs cost microseconds a frame.
    #[test]
    #[ignore = "a measurement: run it alone, with --release --nocapture"]
    fn speed() {
        extern crate std;
        use std::time::Instant;
        let floats: std::vec::Vec<f32> = (0..=u16::MAX).map(|i| f32::from(i) * 0.001 - 30.0).collect();
        for len in [3_000, 65_536] {
            let mut best = f64::INFINITY;
            for _ in 0..20 {
                let start = Instant::now();
                for _ in 0..100 {
                    core::hint::black_box(of(core::hint::black_box(&floats[..len])));
                }
                best = best.min(start.elapsed().as_secs_f64() / 100.0);
            }
            let bytes = f64::from(u32::try_from(4 * len).unwrap());
            std::println!("{len} floats: {:.2} us, {:.2} GB/s", best * 1e6, bytes / best * 1e-9);
        }
    }
}
