//! Blocks of points: vectors turned from one after another to a lane a point, and back.
//!
//! A loop over all lanes of a block, on arrays of its own, is what a compiler turns into vector instructions of any
//! width without a remainder. Lanes past the last point hold numbers that nobody reads.

use super::three;
use wide::f32x4;

/// Points of a block.
pub const BLOCK: usize = if cfg!(target_arch = "wasm32") { 4 } else { 32 };

/// A vector of each point of a block: three components, a lane a point.
pub type Vectors = [[f32; BLOCK]; 3];

/// Registers of four lanes in a block.
pub(crate) const GROUPS: usize = BLOCK / 4;

/// Vectors of four points.
#[inline(always)]
pub(crate) fn four(v: &Vectors, group: usize) -> [f32x4; 3] {
    three(|r| f32x4::from(v[r].as_chunks().0[group]))
}

/// Puts the vectors of four points in their lanes.
#[inline(always)]
pub(crate) fn put([x, y, z]: &mut Vectors, group: usize, v: [f32x4; 3]) {
    x.as_chunks_mut().0[group] = v[0].to_array();
    y.as_chunks_mut().0[group] = v[1].to_array();
    z.as_chunks_mut().0[group] = v[2].to_array();
}

/// Takes the points of a block into lanes.
#[inline(always)]
pub(crate) fn read(points: &[[f32; 3]; BLOCK]) -> Vectors {
    let mut lanes = [[0.0; BLOCK]; 3];
    let [x, y, z] = &mut lanes;
    for lane in 0..BLOCK {
        [x[lane], y[lane], z[lane]] = points[lane];
    }
    lanes
}

/// The first elements of `v`, filled up to a block.
#[inline(always)]
pub(crate) fn filled<T: Copy + Default>(v: &[T]) -> [T; BLOCK] {
    let mut block = [T::default(); BLOCK];
    let n = v.len().min(BLOCK);
    block[..n].copy_from_slice(&v[..n]);
    block
}

/// What of `v` follows its first `n`.
#[inline(always)]
pub(crate) fn after<T>(v: &[T], n: usize) -> &[T] {
    v.get(n..).unwrap_or_default()
}

/// Puts the lanes back.
#[inline(always)]
pub(crate) fn write([x, y, z]: &Vectors, points: &mut [[f32; 3]; BLOCK]) {
    for lane in 0..BLOCK {
        points[lane] = [x[lane], y[lane], z[lane]];
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_read_is_written_again() {
        let mut points = [[0.0; 3]; BLOCK];
        (0_u8..).zip(&mut points).for_each(|(i, p)| *p = [0.0, 100.0, 200.0].map(|k| k + f32::from(i)));
        let lanes = read(&points);
        for (lane, point) in points.iter().enumerate() {
            assert_eq!(&[lanes[0][lane], lanes[1][lane], lanes[2][lane]], point);
        }
        let mut out = [[9.0; 3]; BLOCK];
        write(&lanes, &mut out);
        assert_eq!(out, points);
        assert_eq!(filled(&points[..3])[..4], [points[0], points[1], points[2], [0.0; 3]]);
    }
}
