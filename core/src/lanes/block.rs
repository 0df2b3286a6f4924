//! Blocks of points: vectors turned from one after another to a lane a point, and back.
//!
//! A loop over all lanes of a block, on arrays of its own, is what a compiler turns into vector instructions of any
//! width without a remainder. Lanes past the last point hold numbers that nobody reads.

/// Points of a block.
pub const BLOCK: usize = 32;

/// A vector of each point of a block: three components, a lane a point.
pub type Vectors = [[f32; BLOCK]; 3];

/// Takes the first points of `points`, up to a block, into `lanes`.
#[inline(always)]
pub(crate) fn read(points: &[[f32; 3]], lanes: &mut Vectors) {
    let [x, y, z] = lanes;
    if let Some(points) = points.first_chunk::<BLOCK>() {
        for lane in 0..BLOCK {
            [x[lane], y[lane], z[lane]] = points[lane];
        }
    } else {
        for (lane, point) in (0..BLOCK).zip(points) {
            [x[lane], y[lane], z[lane]] = *point;
        }
    }
}

/// Puts the lanes back.
#[inline(always)]
pub(crate) fn write([x, y, z]: &Vectors, points: &mut [[f32; 3]]) {
    if let Some(points) = points.first_chunk_mut::<BLOCK>() {
        for lane in 0..BLOCK {
            points[lane] = [x[lane], y[lane], z[lane]];
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
