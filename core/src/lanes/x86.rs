//! The products of [`super::rows`] by instructions that not every x86 has; [`crate::dispatch`] asks for them.

#[cfg(target_arch = "x86")]
use core::arch::x86::*;
#[cfg(target_arch = "x86_64")]
use core::arch::x86_64::*;

use super::rows::{Block, dot, rows_by};

/// By AVX2: numbers widened to 16 bits, pairs of products added at once.
#[target_feature(enable = "avx2")]
pub(crate) fn rows_avx2(weights: &[i8], q: &[i8], each: impl FnMut(usize, i32)) {
    rows_by(weights, q, |rows, q| four_avx2(rows, q), each);
}

/// By AVX-512's VNNI: four products added at once, of unsigned and signed numbers.
#[target_feature(enable = "avx2,avx512vl,avx512vnni")]
pub(crate) fn rows_vnni(weights: &[i8], q: &[i8], each: impl FnMut(usize, i32)) {
    rows_by(weights, q, |rows, q| four_vnni(rows, q), each);
}

#[inline]
#[target_feature(enable = "avx2")]
fn four_avx2(rows: Block<'_>, q: &[i8]) -> [i32; 4] {
    let mut sums = [_mm256_setzero_si256(); 4];
    let ([a, b, c, d], (q, tail)) = (blocks::<16>(rows), q.as_chunks::<16>());
    for ((((q, a), b), c), d) in q.iter().zip(a).zip(b).zip(c).zip(d) {
        let q = widen(q);
        sums[0] = _mm256_add_epi32(sums[0], _mm256_madd_epi16(widen(a), q));
        sums[1] = _mm256_add_epi32(sums[1], _mm256_madd_epi16(widen(b), q));
        sums[2] = _mm256_add_epi32(sums[2], _mm256_madd_epi16(widen(c), q));
        sums[3] = _mm256_add_epi32(sums[3], _mm256_madd_epi16(widen(d), q));
    }
    with_tail(across(sums), rows, tail)
}

#[inline]
#[target_feature(enable = "avx2")]
fn widen(x: &[i8; 16]) -> __m256i {
    _mm256_cvtepi8_epi16(bytemuck::cast(*x))
}

/// `(W + 128)·q − 128·q`: the first factor of the instruction is unsigned, and the correction is that of every row.
#[inline]
#[target_feature(enable = "avx2,avx512vl,avx512vnni")]
fn four_vnni(rows: Block<'_>, q: &[i8]) -> [i32; 4] {
    let (mut sums, mut correction) = ([_mm256_setzero_si256(); 4], _mm256_setzero_si256());
    let ([a, b, c, d], (q, tail)) = (blocks::<32>(rows), q.as_chunks::<32>());
    let shift = _mm256_set1_epi8(-128);
    for ((((q, a), b), c), d) in q.iter().zip(a).zip(b).zip(c).zip(d) {
        let q = bytemuck::cast(*q);
        let rows: [__m256i; 4] =
            [bytemuck::cast(*a), bytemuck::cast(*b), bytemuck::cast(*c), bytemuck::cast(*d)];
        correction = _mm256_dpbusd_epi32(correction, shift, q);
        for i in 0..4 {
            sums[i] = _mm256_dpbusd_epi32(sums[i], _mm256_xor_si256(rows[i], shift), q);
        }
    }
    for sum in &mut sums {
        *sum = _mm256_sub_epi32(*sum, correction);
    }
    with_tail(across(sums), rows, tail)
}

/// Whole blocks of each row. Written out: maps of arrays are not always inlined, and run without the instructions then.
#[inline(always)]
fn blocks<const N: usize>([a, b, c, d]: Block<'_>) -> [&[[i8; N]]; 4] {
    [a.as_chunks().0, b.as_chunks().0, c.as_chunks().0, d.as_chunks().0]
}

/// Sum of the lanes of each vector.
#[inline]
#[target_feature(enable = "avx2")]
fn across([a, b, c, d]: [__m256i; 4]) -> [i32; 4] {
    let pairs = _mm256_hadd_epi32(_mm256_hadd_epi32(a, b), _mm256_hadd_epi32(c, d));
    let halves = [_mm256_castsi256_si128(pairs), _mm256_extracti128_si256::<1>(pairs)];
    bytemuck::cast(_mm_add_epi32(halves[0], halves[1]))
}

/// What the last whole block left.
#[inline(always)]
fn with_tail(mut sums: [i32; 4], rows: Block<'_>, tail: &[i8]) -> [i32; 4] {
    if !tail.is_empty() {
        for (sum, row) in sums.iter_mut().zip(rows) {
            *sum += dot(&row[row.len() - tail.len()..], tail);
        }
    }
    sums
}
