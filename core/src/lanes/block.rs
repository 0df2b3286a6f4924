//! Blocks of points: vectors turned from one after another to a lane a point, and back.
//!
//! A loop over all lanes of a block, on arrays of its own, is what a compiler turns into vector instructions of any
//! width without a remainder. Lanes past the last point hold numbers that nobody reads.

use super::each;
use wide::f32x4;

/// Points of a block.
pub const BLOCK: usize = 32;

/// A vector of each point of a block: three components, a lane a point.
pub type Vectors = [[f32; BLOCK]; 3];

/// Puts the vectors of four points in their lanes.
#[inline(always)]
pub(crate) fn put([x, y, z]: &mut Vectors, group: usize, v: [f32x4; 3]) {
    x.as_chunks_mut().0[group] = v[0].to_array();
    y.as_chunks_mut().0[group] = v[1].to_array();
    z.as_chunks_mut().0[group] = v[2].to_array();
}

/// Takes the first points of `points`, up to a block, into `lanes`.
#[inline(always)]
pub(crate) fn read(points: &[[f32; 3]], lanes: &mut Vectors) {
    if let Some(points) = points.first_chunk::<BLOCK>() {
        for (group, points) in (0..BLOCK / 4).zip(points.as_chunks::<4>().0) {
            let rows = each(|k| f32x4::from([points[k][0], points[k][1], points[k][2], 0.0]));
            let [x, y, z, _] = f32x4::transpose(rows);
            put(lanes, group, [x, y, z]);
        }
    } else {
        let [x, y, z] = lanes;
        for (lane, point) in (0..BLOCK).zip(points) {
            [x[lane], y[lane], z[lane]] = *point;
        }
    }
}

/// Puts the lanes back.
#[inline(always)]
pub(crate) fn write([x, y, z]: &Vectors, points: &mut [[f32; 3]]) {
    if let Some(points) = points.first_chunk_mut::<BLOCK>() {
        for (group, points) in (0..BLOCK / 4).zip(points.as_chunks_mut::<4>().0) {
            let of = |v: &[f32; BLOCK]| f32x4::from(v.as_chunks::<4>().0[group]);
            let rows = f32x4::transpose([of(x), of(y), of(z), f32x4::ZERO]);
            let [a, b, c, d] = each(|k| rows[k].to_array());
            *points = [[a[0], a[1], a[2]], [b[0], b[1], b[2]], [c[0], c[1], c[2]], [d[0], d[1], d[2]]];
        }
    } else {
        for (lane, point) in (0..BLOCK).zip(points) {
            *point = [x[lane], y[lane], z[lane]];
        }
    }
}

#[cfg(test)]
mod tests {
    extern crate std;
    use super::*;
    use std::vec::Vec;

    #[test]
    fn what_is_read_is_written_again() {
        for n in 0..33_u8 {
            let points: Vec<[f32; 3]> =
                (0..n).map(|i| [0.0, 100.0, 200.0].map(|k| k + f32::from(i))).collect();
            let (mut lanes, mut out) = ([[9.0; BLOCK]; 3], points.clone());
            read(&points, &mut lanes);
            assert!(lanes[2][usize::from(n)..].iter().all(|x| *x == 9.0), "{n}");
            out.fill([0.0; 3]);
            write(&lanes, &mut out);
            assert_eq!(out, points);
        }
    }
}
