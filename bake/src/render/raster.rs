//! Which triangle a sample sees: a depth buffer of triangle numbers.
//!
//! Colors come later, once a visible sample (see `shade`). The crate `euc` was tried and left: it shades every
//! covered sample anew and asserts on triangles that are seen edge-on.

#![allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    clippy::cast_precision_loss,
    reason = "sample coordinates, clamped to the buffer"
)]

use core::ops::Range;

/// No triangle.
pub(super) const NOTHING: u32 = u32::MAX;

/// A buffer of samples; the greatest nearness wins, the first triangle among equals.
#[derive(Clone, Debug)]
pub(super) struct Samples {
    pub(super) width: usize,
    pub(super) height: usize,
    /// Linear in the picture: the inverse distance of a perspective, the negative distance of a parallel view.
    pub(super) nearness: Vec<f32>,
    /// Number of the triangle, or [`NOTHING`].
    pub(super) triangle: Vec<u32>,
}

/// Barycentric coordinates over the picture: affine functions of x and y.
#[derive(Clone, Copy, Debug)]
pub(super) struct Edges {
    /// `(value, slope in x, slope in y)` of the weights of the first two corners, at the origin.
    weights: [[f32; 3]; 2],
}

impl Edges {
    /// Weights of a triangle, corners `(x, y, …)` in samples; `None` where it has no area.
    pub(super) fn new([a, b, c]: [[f32; 3]; 3]) -> Option<Self> {
        let area = (b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1]);
        let inverse = 1.0 / area;
        if !inverse.is_finite() {
            return None;
        }
        let edge = |p: [f32; 3], q: [f32; 3]| {
            let (dx, dy) = ((p[1] - q[1]) * inverse, (q[0] - p[0]) * inverse);
            [-(dx * p[0] + dy * p[1]), dx, dy]
        };
        Some(Self { weights: [edge(b, c), edge(c, a)] })
    }

    /// Slopes of the three weights in x.
    fn slopes(&self) -> [f32; 3] {
        let [u, v] = self.weights.map(|w| w[1]);
        [u, v, -u - v]
    }

    /// Weights of the three corners at `(x, y)`.
    pub(super) fn at(&self, x: f32, y: f32) -> [f32; 3] {
        let [u, v] = self.weights.map(|[base, dx, dy]| base + dx * x + dy * y);
        [u, v, 1.0 - u - v]
    }
}

impl Samples {
    /// An empty buffer.
    pub(super) fn new(width: usize, height: usize) -> Self {
        let n = width * height;
        Self { width, height, nearness: vec![f32::NEG_INFINITY; n], triangle: vec![NOTHING; n] }
    }

    /// Draws triangle `number` with corners `(x, y, nearness)`, samples and any unit.
    pub(super) fn draw(&mut self, number: u32, corners: [[f32; 3]; 3]) {
        let Some(edges) = Edges::new(corners) else { return };
        let [xs, ys, zs] = [0, 1, 2].map(|axis: usize| corners.map(|c| c[axis]));
        let columns = span(xs, self.width);
        let slopes = edges.slopes();
        let slope = (0..3).map(|i| slopes[i] * zs[i]).sum::<f32>();
        for y in span(ys, self.height) {
            let weights = edges.at(0.0, y as f32 + 0.5);
            let inside = row_inside(weights, slopes, columns.clone());
            if inside.is_empty() {
                continue;
            }
            let near = (0..3).map(|i| weights[i] * zs[i]).sum::<f32>();
            let row = y * self.width;
            let depths = &mut self.nearness[row + inside.start..row + inside.end];
            let numbers = &mut self.triangle[row + inside.start..row + inside.end];
            for ((x, depth), owner) in inside.zip(depths).zip(numbers) {
                let near = near + slope * (x as f32 + 0.5);
                if near > *depth {
                    (*depth, *owner) = (near, number);
                }
            }
        }
    }
}

/// The samples of a row whose weights are not negative, given the weights at its left end and their slopes.
///
/// A sample on a common edge belongs to both triangles: no gap for rounding to open.
fn row_inside(weights: [f32; 3], slopes: [f32; 3], columns: Range<usize>) -> Range<usize> {
    const TOLERANCE: f32 = 1e-5;
    let (mut low, mut high) = (columns.start as f32, columns.end as f32);
    for (w, slope) in weights.into_iter().zip(slopes) {
        let zero = -(w + TOLERANCE) / slope;
        if slope > 0.0 {
            low = low.max(zero);
        } else if slope < 0.0 {
            high = high.min(zero);
        } else if w < -TOLERANCE {
            return 0..0;
        }
    }
    // Centers lie at halves: the first is not before `low`, the last not beyond `high`.
    let first = libm::ceilf(low - 0.5).max(0.0) as usize;
    let last = (libm::floorf(high - 0.5) + 1.0).max(0.0) as usize;
    first..last.min(columns.end).max(first)
}

/// Samples whose centers lie between the least and the greatest of `v`, within `0..size`.
fn span(v: [f32; 3], size: usize) -> Range<usize> {
    let low = v[0].min(v[1]).min(v[2]) - 0.5;
    let high = v[0].max(v[1]).max(v[2]) + 0.5;
    let last = (high.max(0.0) as usize).min(size);
    // `as` rounds towards zero, which is down here.
    let first = if low > 0.0 { low as usize } else { 0 };
    first.min(last)..last
}

#[cfg(test)]
mod tests {
    use super::*;

    fn count(samples: &Samples, number: u32) -> usize {
        samples.triangle.iter().filter(|&&t| t == number).count()
    }

    #[test]
    fn two_triangles_cover_a_square_without_a_gap() {
        let mut samples = Samples::new(64, 64);
        let [a, b, c, d] = [[3.3, 4.7, 1.0], [60.1, 5.2, 1.0], [58.9, 61.4, 1.0], [2.8, 59.6, 1.0]];
        samples.draw(0, [a, b, c]);
        samples.draw(1, [a, c, d]);
        for y in 7..58 {
            for x in 5..57 {
                assert_ne!(samples.triangle[y * 64 + x], NOTHING, "gap at {x}, {y}");
            }
        }
    }

    #[test]
    fn the_nearer_triangle_wins_in_either_order_and_winding() {
        let near = [[0.0, 0.0, 2.0], [20.0, 0.0, 2.0], [0.0, 20.0, 2.0]];
        let far = [[0.0, 20.0, 1.0], [20.0, 0.0, 1.0], [0.0, 0.0, 1.0]];
        for order in [[(0, near), (1, far)], [(1, far), (0, near)]] {
            let mut samples = Samples::new(32, 32);
            order.into_iter().for_each(|(number, corners)| samples.draw(number, corners));
            assert_eq!((count(&samples, 0) > 150, count(&samples, 1)), (true, 0));
        }
    }

    #[test]
    fn degenerate_and_absurd_triangles_are_left_out() {
        let mut samples = Samples::new(8, 8);
        samples.draw(0, [[1.0, 1.0, 1.0], [4.0, 4.0, 1.0], [6.0, 6.0, 1.0]]);
        samples.draw(1, [[f32::NAN; 3], [4.0, 0.0, 1.0], [6.0, 6.0, 1.0]]);
        samples.draw(2, [[1e30, 0.0, 1.0], [-1e30, 1.0, 1.0], [0.0, 1e30, 1.0]]);
        samples.draw(3, [[-9.0, -9.0, 1.0], [-5.0, -9.0, 1.0], [-9.0, -5.0, 1.0]]);
        assert_eq!((count(&samples, 0), count(&samples, 1), count(&samples, 3)), (0, 0, 0));
    }
}
