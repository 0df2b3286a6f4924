//! Vectors and maps of four points at once: a lane a point.
//!
//! Arrays are walked in blocks of four; in the last block the last element fills the lanes that are
//! left. Lanes do not mix, so a point has the same bits wherever it stands.

use super::Lanes;

/// A vector of each of four points.
pub(crate) type Vectors<L> = [L; 3];

/// Columns of a linear map of each of four points.
pub(crate) type Linear<L> = [Vectors<L>; 3];

/// `[f(0), f(1), f(2)]`. Unlike the standard library's maps of arrays it is always inlined, and these
/// run some hundred times a point.
#[inline(always)]
pub(crate) fn three<T>(f: impl Fn(usize) -> T) -> [T; 3] {
    [f(0), f(1), f(2)]
}

/// `[f(0), f(1), f(2), f(3)]`, as [`three`].
#[inline(always)]
pub(crate) fn each<T>(f: impl Fn(usize) -> T) -> [T; 4] {
    [f(0), f(1), f(2), f(3)]
}

/// The block of `v` at `i`.
#[inline(always)]
pub(crate) fn read<T: Copy>(v: &[T], i: usize) -> [T; 4] {
    let rest = &v[i..];
    match rest.first_chunk() {
        Some(block) => *block,
        None => each(|k| rest[k.min(rest.len() - 1)]),
    }
}

/// The block of vectors of `v` at `i`.
#[inline(always)]
pub(crate) fn load<L: Lanes>(v: &[[f32; 3]], i: usize) -> Vectors<L> {
    let v = read(v, i);
    three(|k| L::from_array(each(|lane| v[lane][k])))
}

/// Writes the block of vectors of `out` at `i`.
#[inline(always)]
pub(crate) fn store<L: Lanes>(v: Vectors<L>, out: &mut [[f32; 3]], i: usize) {
    let (x, y, z) = (v[0].to_array(), v[1].to_array(), v[2].to_array());
    let out = &mut out[i..];
    if let Some([a, b, c, d]) = out.first_chunk_mut() {
        (*a, *b) = ([x[0], y[0], z[0]], [x[1], y[1], z[1]]);
        (*c, *d) = ([x[2], y[2], z[2]], [x[3], y[3], z[3]]);
    } else {
        out.iter_mut().zip(0..3).for_each(|(out, lane)| *out = [x[lane], y[lane], z[lane]]);
    }
}

/// `a·b`.
#[inline(always)]
pub(crate) fn dot<L: Lanes>(a: &Vectors<L>, b: &Vectors<L>) -> L {
    (a[0] * b[0] + a[1] * b[1]) + a[2] * b[2]
}

/// `a × b`.
#[inline(always)]
pub(crate) fn cross<L: Lanes>(a: &Vectors<L>, b: &Vectors<L>) -> Vectors<L> {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// `M·v`.
#[inline(always)]
pub(crate) fn mul<L: Lanes>(m: &Linear<L>, v: &Vectors<L>) -> Vectors<L> {
    three(|r| (m[0][r] * v[0] + m[1][r] * v[1]) + m[2][r] * v[2])
}

/// `cof(M) = det(M)·M⁻ᵀ` of each map.
#[derive(Clone, Copy)]
pub(crate) struct Cofactors<L: Lanes> {
    /// Its columns.
    pub(crate) columns: Linear<L>,
    /// `det(M)`.
    pub(crate) determinant: L,
    /// Where `M` has an inverse: `|det(M)|` is finite and above 1e-6 of the longest column's cube.
    pub(crate) regular: L::Mask,
}

impl<L: Lanes> Cofactors<L> {
    /// Of the maps `m`.
    #[inline(always)]
    pub(crate) fn new(m: &Linear<L>) -> Self {
        let [a, b, c] = m;
        let columns = [cross(b, c), cross(c, a), cross(a, b)];
        let determinant = dot(a, &columns[0]);
        let max = |a: L, b: L| L::select(b.lt(a), a, b);
        let longest = max(max(dot(a, a), dot(b, b)), dot(c, c));
        let threshold = L::splat(1e-12) * longest * longest * longest;
        Self { columns, determinant, regular: threshold.lt(determinant * determinant) }
    }

    /// Of the maps `m`; where one has no inverse, of `other` of its lane.
    #[inline(always)]
    pub(crate) fn or_else(m: &Linear<L>, other: impl Fn(usize) -> [[f32; 3]; 3]) -> Self {
        let cofactors = Self::new(m);
        if L::all(cofactors.regular) { cofactors } else { Self::replaced(m, cofactors.regular, &other) }
    }

    /// Of the maps `m` where `keep`, else of `other`. Rare, and kept out of the way.
    #[cold]
    #[inline(never)]
    pub(crate) fn replaced(m: &Linear<L>, keep: L::Mask, other: &dyn Fn(usize) -> [[f32; 3]; 3]) -> Self {
        let other = each(other);
        let lane = |c: usize, r: usize| L::from_array(each(|lane| other[lane][c][r]));
        Self::new(&three(|c| three(|r| L::select(keep, m[c][r], lane(c, r)))))
    }
}
