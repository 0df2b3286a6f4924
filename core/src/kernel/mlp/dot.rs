//! `zᵣ = Σᵢ Wᵣᵢ·qᵢ`: int8 times int8, int32 sums. Exact, so any order of the sum gives the same bits.

use crate::dispatch;
pub use crate::lanes::rows::dot;

/// Inputs for which no sum can overflow: `128·127·INPUTS ≤ 2³¹ − 1`.
pub const MAX_INPUTS: usize = 132_104;
const _: () = assert!(128 * 127 * MAX_INPUTS as u64 <= i32::MAX as u64, "the largest sum fits in an i32");

/// Sums of the rows of `weights` (row by row, `q.len()` each) times `q`; each goes to `each(row, sum)`.
///
/// A row that is not whole is left out. At most [`MAX_INPUTS`] inputs, none −128: beyond that sums wrap, or panic in
/// a debug build.
pub fn rows(weights: &[i8], q: &[i8], each: impl FnMut(usize, i32)) {
    dispatch::rows(weights, q, each);
}

#[cfg(test)]
mod tests {
    extern crate std;
    use super::*;
    use std::vec::Vec;

    /// Numbers of a fixed sequence, the extremes among them.
    fn numbers(n: usize, seed: u32) -> Vec<i8> {
        let mut s = seed;
        let next = || {
            s = s.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            let byte = (s >> 24).to_le_bytes()[0];
            if byte < 16 { [-127, 127][usize::from(byte & 1)] } else { byte.cast_signed().max(-127) }
        };
        core::iter::repeat_with(next).take(n).collect()
    }

    /// Each copy that this machine can run gives `(row, sum)` of all rows as wanted.
    fn sums_agree(w: &[i8], q: &[i8], want: &[(usize, i64)]) {
        for level in dispatch::levels() {
            let mut found = Vec::new();
            dispatch::rows_at(level, w, q, |row, z| found.push((row, i64::from(z))));
            let (inputs, at) = (q.len(), [w.as_ptr() as usize % 16, q.as_ptr() as usize % 16]);
            assert_eq!(found, want, "{level:?}: {} weights, {inputs} inputs at {at:?}", w.len());
        }
    }

    #[test]
    fn exhaustive_products() {
        for w in i8::MIN..=i8::MAX {
            let all: Vec<i8> = (i8::MIN..=i8::MAX).collect();
            let expected: Vec<i32> = all.iter().map(|q| i32::from(i16::from(w) * i16::from(*q))).collect();
            for (q, product) in all.iter().zip(&expected) {
                assert_eq!(dot(&[w], &[*q]), *product, "{w} * {q}");
            }
            // And in the lanes, where 256 of them are summed.
            let want = std::vec![(0, expected.iter().map(|z| i64::from(*z)).sum())];
            sums_agree(&[w; 256], &all, &want);
        }
    }

    /// Every length and alignment: each copy that this machine can run, the plain one and sums in `i64` agree.
    #[test]
    fn every_length_and_alignment() {
        for n in 0..67 {
            for offset in 0..16 {
                for count in [1, 3, 4, 9] {
                    let (w, q) = (numbers(n * count + offset, 7), numbers(n + offset, 9));
                    let (w, q) = (&w[offset..], &q[offset..]);
                    let exact =
                        |row: &[i8]| row.iter().zip(q).map(|(w, q)| i64::from(*w) * i64::from(*q)).sum();
                    let want: Vec<(usize, i64)> =
                        if n == 0 { Vec::new() } else { w.chunks_exact(n).map(exact).enumerate().collect() };
                    sums_agree(w, q, &want);
                }
            }
        }
    }

    #[test]
    fn the_largest_sum_fits() {
        let (w, q) = (std::vec![-128; MAX_INPUTS], std::vec![127; MAX_INPUTS]);
        let want = std::vec![(0, -2_147_482_624)];
        sums_agree(&w, &q, &want);
    }
}
