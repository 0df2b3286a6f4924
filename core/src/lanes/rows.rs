//! Products of rows of int8 with int8: blocks of four rows for every way of doing it.

use super::{VECTORS, each};
use wide::{i16x8, i32x4};

/// Four rows, each as long as the inputs; they share one pass over these.
pub(crate) type Block<'a> = [&'a [i8]; 4];

/// Sums of the rows of `weights` times `q`, on the registers that every processor of the target has.
#[inline(always)]
pub(crate) fn rows_plain(weights: &[i8], q: &[i8], each: impl FnMut(usize, i32)) {
    if VECTORS {
        rows_by(weights, q, four_wide, each);
    } else {
        rows_by(weights, q, |[a, b, c, d], q| [dot(a, q), dot(b, q), dot(c, q), dot(d, q)], each);
    }
}

/// Sixteen products at a time, in lanes of 16 bits; two of them make a lane of the sum.
#[inline(always)]
fn four_wide([a, b, c, d]: Block<'_>, q: &[i8]) -> [i32; 4] {
    let (blocks, rest) = q.as_chunks();
    let ab = a.as_chunks().0.iter().zip(b.as_chunks().0);
    let cd = c.as_chunks().0.iter().zip(d.as_chunks().0);
    let mut sums = [i32x4::ZERO; 4];
    for (q, ((a, b), (c, d))) in blocks.iter().zip(ab.zip(cd)) {
        let q = halves(q);
        let sum = |w| halves(w).0.dot(q.0) + halves(w).1.dot(q.1);
        sums = [sums[0] + sum(a), sums[1] + sum(b), sums[2] + sum(c), sums[3] + sum(d)];
    }
    let (rows, done) = ([a, b, c, d], q.len() - rest.len());
    each(|k| sums[k].reduce_add() + dot(rows[k].get(done..).unwrap_or_default(), rest))
}

/// Every other number, and those between: a sum does not mind the order.
#[inline(always)]
fn halves(x: &[i8; 16]) -> (i16x8, i16x8) {
    let x: i16x8 = bytemuck::cast(*x);
    ((x << 8) >> 8, x >> 8)
}

/// The same, where `four` sums up a block.
#[inline(always)]
pub(crate) fn rows_by(
    weights: &[i8],
    q: &[i8],
    four: impl Fn(Block<'_>, &[i8]) -> [i32; 4],
    mut each: impl FnMut(usize, i32),
) {
    let n = q.len();
    if n == 0 {
        return;
    }
    let mut blocks = weights.chunks_exact(4 * n);
    let mut row = 0;
    for block in &mut blocks {
        let (ab, cd) = block.split_at(2 * n);
        let ((a, b), (c, d)) = (ab.split_at(n), cd.split_at(n));
        for sum in four([a, b, c, d], q) {
            each(row, sum);
            row += 1;
        }
    }
    for weights in blocks.remainder().chunks_exact(n) {
        each(row, dot(weights, q));
        row += 1;
    }
}

/// `Σ wᵢ·qᵢ` over the shorter of the two.
#[inline(always)]
#[must_use]
pub fn dot(w: &[i8], q: &[i8]) -> i32 {
    w.iter().zip(q).fold(0, |sum, (w, q)| sum + i32::from(*w) * i32::from(*q))
}
