//! The colors of a GIF: those that a neural network proposes, moved to the means of the pixels they stand for.
//!
//! ```text
//! k(p) = argmin over k of |p − cₖ|²,   cₖ := mean of the pixels p with k(p) = k        (Lloyd)
//! ```

use color_quant::NeuQuant;

/// Bits a channel of the cells in which pixels are counted.
const BITS: u32 = 6;
/// Bits a channel of the table of nearest colors.
const TABLE_BITS: u32 = 7;
/// Pixels that the network sees, about.
const LESSONS: usize = 50_000;
/// How often colors are moved.
const ROUNDS: usize = 6;
/// Not yet looked up.
const UNKNOWN: u16 = u16::MAX;

/// A palette with fast look-up.
#[derive(Debug)]
pub(super) struct Palette {
    colors: Vec<[u8; 3]>,
    nearest: Vec<u16>,
}

/// Pixels of one cell: their sum and number.
type Cell = ([u64; 3], u64);

impl Palette {
    /// At most `count` (2 to 256) colors that suit `pixels`.
    pub(super) fn new(pixels: &[[u8; 3]], count: usize) -> Self {
        let step = (pixels.len() / LESSONS).max(1);
        let mut lessons: Vec<u8> =
            pixels.iter().step_by(step).flat_map(|[r, g, b]| [*r, *g, *b, 255]).collect();
        // A small picture is shown several times: the network learns little from a few pixels.
        lessons = lessons.repeat((4 * LESSONS).div_ceil(lessons.len().max(1)).max(1));
        let proposed = NeuQuant::new(1, count, &lessons).color_map_rgb();
        let mut colors: Vec<[u8; 3]> = proposed.chunks_exact(3).map(|c| [c[0], c[1], c[2]]).collect();
        let cells = count_cells(pixels);
        for _ in 0..ROUNDS {
            let mut sums = vec![Cell::default(); colors.len()];
            for (sum, number) in &cells {
                let mean = sum.map(|s| u8::try_from(s / number).unwrap_or(u8::MAX));
                let (total, count) = &mut sums[nearest(&colors, mean)];
                (0..3).for_each(|i| total[i] += sum[i]);
                *count += number;
            }
            for (color, (sum, number)) in colors.iter_mut().zip(sums).filter(|(_, s)| s.1 > 0) {
                *color = sum.map(|s| u8::try_from((s + number / 2) / number).unwrap_or(u8::MAX));
            }
        }
        Self { colors, nearest: vec![UNKNOWN; 1 << (3 * TABLE_BITS)] }
    }

    /// The colors, one after the other.
    pub(super) fn rgb(&self) -> Vec<u8> {
        self.colors.concat()
    }

    /// Number of the color nearest to `color`.
    pub(super) fn index(&mut self, color: [u8; 3]) -> u8 {
        let key = color.iter().fold(0, |key, c| key << TABLE_BITS | usize::from(*c) >> (8 - TABLE_BITS));
        if self.nearest[key] == UNKNOWN {
            self.nearest[key] = u16::try_from(nearest(&self.colors, color)).unwrap_or(0);
        }
        u8::try_from(self.nearest[key]).unwrap_or(0)
    }
}

/// Occupied cells, in order.
fn count_cells(pixels: &[[u8; 3]]) -> Vec<Cell> {
    let mut cells = vec![Cell::default(); 1 << (3 * BITS)];
    for p in pixels {
        let key = p.iter().fold(0, |key, c| key << BITS | usize::from(*c) >> (8 - BITS));
        let (sum, number) = &mut cells[key];
        (0..3).for_each(|i| sum[i] += u64::from(p[i]));
        *number += 1;
    }
    cells.retain(|c| c.1 > 0);
    cells
}

/// The nearest color, the first among equals.
fn nearest(colors: &[[u8; 3]], [r, g, b]: [u8; 3]) -> usize {
    let square = |a: u8, b: u8| u32::from(a.abs_diff(b)).pow(2);
    let distances = colors.iter().map(|c| square(c[0], r) + square(c[1], g) + square(c[2], b));
    distances.enumerate().min_by_key(|(_, d)| *d).map_or(0, |(i, _)| i)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn few_colors_are_kept_as_they_are() {
        let colors = [[220, 60, 30], [10, 20, 30], [250, 250, 250], [0, 200, 0]];
        let pixels: Vec<[u8; 3]> =
            (0..4000).map(|i| colors[if i % 100 == 0 { 0 } else { 1 + i % 3 }]).collect();
        let mut palette = Palette::new(&pixels, 16);
        let rgb = palette.rgb();
        for color in colors {
            let index = usize::from(palette.index(color));
            assert_eq!(rgb[3 * index..3 * index + 3], color, "rare or not");
        }
    }
}
