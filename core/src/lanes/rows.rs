//! Products of rows of int8 with int8: blocks of four rows for every way of doing it.

/// Four rows, each as long as the inputs; they share one pass over these.
pub(crate) type Block<'a> = [&'a [i8]; 4];

/// Sums of the rows of `weights` times `q`, on the lanes that the compiler finds.
#[inline(always)]
pub(crate) fn rows_plain(weights: &[i8], q: &[i8], each: impl FnMut(usize, i32)) {
    rows_by(weights, q, |[a, b, c, d], q| [dot(a, q), dot(b, q), dot(c, q), dot(d, q)], each);
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
