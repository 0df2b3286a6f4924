//! Plots as SVG that takes its colors from the page.

use super::COLORS;
use super::page::escape;
use std::io::{self, Write};

/// Size of a plot and of the frame within it, user units.
const WIDTH: f64 = 640.0;
const HEIGHT: f64 = 260.0;
const LEFT: f64 = 52.0;
const RIGHT: f64 = 12.0;
const TOP: f64 = 10.0;
const BOTTOM: f64 = 42.0;

/// Lines over an axis.
#[derive(Clone, Debug, Default)]
pub struct Plot {
    /// Heading.
    pub title: String,
    /// Quantity and unit along the horizontal axis.
    pub x_label: String,
    /// Quantity and unit along the vertical axis.
    pub y_label: String,
    /// Lines.
    pub series: Vec<Series>,
}

/// A line.
#[derive(Clone, Debug, Default)]
pub struct Series {
    /// Name in the legend.
    pub name: String,
    /// Number of its color; there are [`COLORS`](super::COLORS), then they repeat.
    pub color: usize,
    /// Points, x ascending; points that are not finite interrupt the line.
    pub points: Vec<[f64; 2]>,
}

/// Counts of values.
#[derive(Clone, Debug, Default)]
pub struct Histogram {
    /// Heading.
    pub title: String,
    /// Quantity and unit.
    pub x_label: String,
    /// Where the first bar begins and the last ends.
    pub range: [f64; 2],
    /// Bars of equal width.
    pub counts: Vec<u64>,
}

impl Histogram {
    /// Counts values in `bars` bars from the least to the greatest; values that are not finite do not count.
    #[must_use]
    pub fn of(title: &str, x_label: &str, values: impl IntoIterator<Item = f64>, bars: usize) -> Self {
        let values: Vec<f64> = values.into_iter().filter(|v| v.is_finite()).collect();
        let range = bounds(values.iter().copied());
        let mut counts = vec![0; bars.max(1)];
        let last = counts.len() - 1;
        for v in values {
            #[allow(
                clippy::cast_precision_loss,
                clippy::cast_possible_truncation,
                reason = "number of a bar"
            )]
            #[allow(clippy::cast_sign_loss, reason = "number of a bar")]
            let bar = ((v - range[0]) / (range[1] - range[0]) * counts.len() as f64) as usize;
            counts[bar.min(last)] += 1;
        }
        Self { title: title.to_owned(), x_label: x_label.to_owned(), range, counts }
    }

    pub(super) fn write_to(&self, out: &mut impl Write) -> io::Result<()> {
        #[allow(clippy::cast_precision_loss, reason = "the height of a bar")]
        let counts: Vec<f64> = self.counts.iter().map(|c| *c as f64).collect();
        let highest = counts.iter().copied().fold(1.0, f64::max);
        let axes = Axes { x: Axis::new(self.range), y: Axis::new([0.0, highest]) };
        axes.begin(out, &self.title, &self.x_label, "count")?;
        #[allow(clippy::cast_precision_loss, reason = "number of a bar")]
        let edge =
            |i: usize| self.range[0] + (self.range[1] - self.range[0]) * i as f64 / counts.len() as f64;
        for (i, count) in counts.iter().enumerate().filter(|(_, c)| **c > 0.0) {
            let ([x0, y0], [x1, y1]) = (axes.place([edge(i), *count]), axes.place([edge(i + 1), 0.0]));
            let (width, height) = ((x1 - x0 - 1.0).max(0.5), y1 - y0);
            writeln!(
                out,
                "<rect class=\"bar\" x=\"{x0:.1}\" y=\"{y0:.1}\" width=\"{width:.1}\" height=\"{height:.1}\"/>"
            )?;
        }
        writeln!(out, "</svg></figure>")
    }
}

impl Plot {
    pub(super) fn write_to(&self, out: &mut impl Write) -> io::Result<()> {
        let points = || self.series.iter().flat_map(|s| &s.points).filter(|p| is_finite(p));
        let [x, y] = [0, 1].map(|i: usize| Axis::new(bounds(points().map(|p| p[i]))));
        let axes = Axes { x, y };
        axes.begin(out, &self.title, &self.x_label, &self.y_label)?;
        for series in &self.series {
            for part in series.points.split(|p| !is_finite(p)).filter(|p| p.len() > 1) {
                write!(out, "<polyline class=\"series s{}\" points=\"", series.color % COLORS)?;
                for p in part {
                    let [x, y] = axes.place(*p);
                    write!(out, "{x:.1},{y:.1} ")?;
                }
                writeln!(out, "\"/>")?;
            }
        }
        writeln!(out, "</svg>\n<div class=\"legend\">")?;
        for Series { name, color, .. } in &self.series {
            writeln!(out, "<span><i class=\"c{}\"></i>{}</span>", color % COLORS, escape(name))?;
        }
        writeln!(out, "</div></figure>")
    }
}

fn is_finite(p: &[f64; 2]) -> bool {
    p.iter().all(|v| v.is_finite())
}

/// Least and greatest value, never equal.
fn bounds(values: impl Iterator<Item = f64>) -> [f64; 2] {
    let [low, high] = values.fold([f64::INFINITY, f64::NEG_INFINITY], |[l, h], v| [l.min(v), h.max(v)]);
    match (low <= high, high > low) {
        (false, _) => [0.0, 1.0],
        (true, true) => [low, high],
        // Nothing but zeros: an axis in thousandths would promise too much.
        (true, false) if low.abs() < 1e-12 => [0.0, 1.0],
        (true, false) => [low - 0.5 * low.abs().max(1e-9), high + 0.5 * high.abs().max(1e-9)],
    }
}

/// A range with round marks.
struct Axis {
    range: [f64; 2],
    step: f64,
    decimals: usize,
}

impl Axis {
    fn new(range: [f64; 2]) -> Self {
        let rough = (range[1] - range[0]) / 5.0;
        let power = libm::floor(libm::log10(rough));
        let unit = libm::pow(10.0, power);
        let step = [1.0, 2.0, 5.0].map(|m| m * unit).into_iter().find(|s| *s >= rough).unwrap_or(10.0 * unit);
        let digits = libm::ceil(-libm::log10(step) - 1e-9).clamp(0.0, 12.0);
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 to 12")]
        let decimals = digits as usize;
        let outer = [libm::floor(range[0] / step + 1e-9) * step, libm::ceil(range[1] / step - 1e-9) * step];
        Self { range: outer, step, decimals }
    }

    /// Marks and their labels.
    fn marks(&self) -> Vec<(f64, String)> {
        let count = libm::round((self.range[1] - self.range[0]) / self.step).clamp(1.0, 12.0);
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "1 to 12")]
        let count = count as u32;
        let mark = |i: u32| {
            // Adding 0 makes -0 plain.
            let v = self.range[0] + f64::from(i) * self.step;
            let v = if v.abs() < 1e-9 * self.step { 0.0 } else { v };
            (v, format!("{v:.*}", self.decimals))
        };
        (0..=count).map(mark).collect()
    }

    fn share(&self, v: f64) -> f64 {
        (v - self.range[0]) / (self.range[1] - self.range[0])
    }
}

struct Axes {
    x: Axis,
    y: Axis,
}

impl Axes {
    fn place(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        [
            LEFT + self.x.share(x) * (WIDTH - LEFT - RIGHT),
            HEIGHT - BOTTOM - self.y.share(y) * (HEIGHT - TOP - BOTTOM),
        ]
    }

    /// Opens the figure and draws grid and labels.
    fn begin(&self, out: &mut impl Write, title: &str, x_label: &str, y_label: &str) -> io::Result<()> {
        let (title, x_label, y_label) = (escape(title), escape(x_label), escape(y_label));
        writeln!(out, "<figure class=\"plot\"><figcaption>{title}</figcaption>")?;
        write!(
            out,
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {WIDTH} {HEIGHT}\" role=\"img\" "
        )?;
        writeln!(out, "aria-label=\"{title}\">")?;
        let (bottom, right) = (HEIGHT - BOTTOM, WIDTH - RIGHT);
        for (v, label) in self.y.marks() {
            let [_, y] = self.place([self.x.range[0], v]);
            writeln!(out, "<path class=\"grid\" d=\"M{LEFT} {y:.1}H{right}\"/>")?;
            writeln!(
                out,
                "<text x=\"{}\" y=\"{:.1}\" text-anchor=\"end\">{label}</text>",
                LEFT - 6.0,
                y + 4.0
            )?;
        }
        for (v, label) in self.x.marks() {
            let [x, _] = self.place([v, self.y.range[0]]);
            writeln!(out, "<path class=\"grid\" d=\"M{x:.1} {bottom}v5\"/>")?;
            let y = bottom + 18.0;
            writeln!(out, "<text x=\"{x:.1}\" y=\"{y}\" text-anchor=\"middle\">{label}</text>")?;
        }
        let (middle, low) = (0.5 * (LEFT + right), HEIGHT - 6.0);
        writeln!(out, "<text x=\"{middle}\" y=\"{low}\" text-anchor=\"middle\">{x_label}</text>")?;
        let half = 0.5 * (TOP + bottom);
        writeln!(
            out,
            "<text transform=\"translate(12 {half}) rotate(-90)\" text-anchor=\"middle\">{y_label}</text>"
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn marks_are_round_and_enclose_the_range() {
        for (range, labels) in [
            ([0.0, 1.0], vec!["0.0", "0.2", "0.4", "0.6", "0.8", "1.0"]),
            ([-3.0, 41.0], vec!["-10", "0", "10", "20", "30", "40", "50"]),
            ([0.0012, 0.0031], vec!["0.0010", "0.0015", "0.0020", "0.0025", "0.0030", "0.0035"]),
        ] {
            let axis = Axis::new(range);
            let found: Vec<String> = axis.marks().into_iter().map(|m| m.1).collect();
            assert_eq!(found, labels);
        }
    }

    #[test]
    fn every_finite_value_is_counted_once() {
        let h = Histogram::of("", "", [0.0, 0.1, 0.95, 1.0, 0.5, f64::NAN, f64::INFINITY], 4);
        assert_eq!(
            (h.counts, h.range.map(f64::to_bits)),
            (vec![2, 0, 1, 2], [0.0, 1.0_f64].map(f64::to_bits))
        );
        assert_eq!(Histogram::of("", "", [7.0; 3], 2).counts, [0, 3], "equal values have a bar too");
    }
}
