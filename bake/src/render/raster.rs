//! Pixels: a depth buffer, triangles, and the way down to eight bits.

use glam::{DVec3, Vec3};

/// Samples a side of a pixel.
pub(super) const SAMPLES: usize = 2;

/// Linear colours with depth, `SAMPLES` times as large as the picture each way.
#[derive(Clone, Debug)]
pub struct Canvas {
    /// Pixels of the picture.
    pub width: usize,
    /// Pixels of the picture.
    pub height: usize,
    color: Vec<Vec3>,
    depth: Vec<f32>,
}

/// A corner of a triangle on the canvas: position in samples, inverse depth, and what is interpolated.
#[derive(Clone, Copy, Debug)]
pub(super) struct Corner {
    pub(super) at: DVec3,
    pub(super) normal: Vec3,
    pub(super) uv: [f32; 2],
    pub(super) value: f32,
}

impl Canvas {
    /// A picture of `width × height` pixels in one linear colour.
    #[must_use]
    pub fn new(width: usize, height: usize, color: [f32; 3]) -> Self {
        let n = width * height * SAMPLES * SAMPLES;
        Self { width, height, color: vec![Vec3::from_array(color); n], depth: vec![0.0; n] }
    }

    /// Height in samples.
    pub(super) fn rows(&self) -> usize {
        self.height * SAMPLES
    }

    fn columns(&self) -> usize {
        self.width * SAMPLES
    }

    /// Draws a triangle; `shade` gives the colour at interpolated normal, uv and value.
    pub(super) fn triangle(&mut self, corners: [Corner; 3], shade: impl Fn(Vec3, [f32; 2], f32) -> Vec3) {
        let columns = self.columns();
        self.cover(corners, |canvas, i, weights| {
            let w: [f32; 3] = core::array::from_fn(|k| crate::pack::narrow(weights[k] * corners[k].at.z));
            let inverse_depth = w[0] + w[1] + w[2];
            if inverse_depth > canvas.depth[i] {
                let w = w.map(|x| x / inverse_depth);
                let normal = corners[0].normal * w[0] + corners[1].normal * w[1] + corners[2].normal * w[2];
                let mix = |f: fn(&Corner) -> f32| {
                    f(&corners[0]) * w[0] + f(&corners[1]) * w[1] + f(&corners[2]) * w[2]
                };
                canvas.depth[i] = inverse_depth;
                canvas.color[i] = shade(normal, [mix(|c| c.uv[0]), mix(|c| c.uv[1])], mix(|c| c.value));
            }
        });
        debug_assert!(columns > 0, "an empty canvas");
    }

    /// Calls `at` with index and barycentric weights of every sample that a triangle covers.
    fn cover(&mut self, corners: [Corner; 3], mut at: impl FnMut(&mut Self, usize, [f64; 3])) {
        let [a, b, c] = corners.map(|c| c.at);
        let area = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
        if area == 0.0 || !area.is_finite() {
            return;
        }
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped to the canvas")]
        let range = |values: [f64; 3], most: usize| {
            let low = values.iter().copied().fold(f64::INFINITY, f64::min).floor().max(0.0) as usize;
            let high = values.iter().copied().fold(f64::NEG_INFINITY, f64::max).ceil().max(0.0) as usize;
            low.min(most)..high.min(most)
        };
        let columns = self.columns();
        for y in range([a.y, b.y, c.y], self.rows()) {
            for x in range([a.x, b.x, c.x], columns) {
                #[allow(clippy::cast_precision_loss, reason = "pixels")]
                let (px, py) = (x as f64 + 0.5, y as f64 + 0.5);
                let edge = |p: DVec3, q: DVec3| ((q.x - p.x) * (py - p.y) - (q.y - p.y) * (px - p.x)) / area;
                let weights = [edge(b, c), edge(c, a), edge(a, b)];
                if weights.iter().all(|w| *w >= 0.0) {
                    at(self, y * columns + x, weights);
                }
            }
        }
    }

    /// Marks the samples that a triangle covers in `mask`.
    pub(super) fn mark(&mut self, corners: [Corner; 3], mask: &mut [f32]) {
        self.cover(corners, |_, i, _| mask[i] = 1.0);
    }

    /// Darkens every sample by `strength` times the blurred mask.
    pub(super) fn shadow(&mut self, mask: &[f32], strength: f32, radius: usize) {
        let (columns, rows) = (self.columns(), self.rows());
        let mut soft = mask.to_vec();
        for _ in 0..2 {
            soft = blur(&soft, columns, rows, radius);
        }
        for (color, m) in self.color.iter_mut().zip(soft) {
            *color *= 1.0 - strength * m;
        }
    }

    /// Averages the samples of each pixel and encodes: sRGB, 8 bits, row by row.
    #[must_use]
    pub fn to_rgb(&self) -> Vec<u8> {
        let columns = self.columns();
        let mut out = Vec::with_capacity(self.width * self.height * 3);
        for y in 0..self.height {
            for x in 0..self.width {
                let mut sum = Vec3::ZERO;
                for k in 0..SAMPLES * SAMPLES {
                    sum += self.color[(y * SAMPLES + k / SAMPLES) * columns + x * SAMPLES + k % SAMPLES];
                }
                #[allow(clippy::cast_precision_loss, reason = "4")]
                let mean = sum / (SAMPLES * SAMPLES) as f32;
                out.extend(mean.to_array().map(encode));
            }
        }
        out
    }
}

/// Moving average over rows, then columns.
fn blur(mask: &[f32], columns: usize, rows: usize, radius: usize) -> Vec<f32> {
    let pass = |from: &[f32], lines: usize, length: usize, index: &dyn Fn(usize, usize) -> usize| {
        let mut out = vec![0.0; from.len()];
        #[allow(clippy::cast_precision_loss, reason = "pixels")]
        let width = (2 * radius + 1) as f32;
        for line in 0..lines {
            let mut sum = 0.0;
            for i in 0..length + radius {
                sum += if i < length { from[index(line, i)] } else { 0.0 };
                sum -= if i > 2 * radius { from[index(line, i - 2 * radius - 1)] } else { 0.0 };
                if i >= radius {
                    out[index(line, i - radius)] = sum / width;
                }
            }
        }
        out
    };
    let across = pass(mask, rows, columns, &|line, i| line * columns + i);
    pass(&across, columns, rows, &|line, i| i * columns + line)
}

/// Linear light to sRGB code.
pub(super) fn encode(x: f32) -> u8 {
    let x = x.clamp(0.0, 1.0);
    let s = if x <= 0.003_130_8 { 12.92 * x } else { 1.055 * libm::powf(x, 1.0 / 2.4) - 0.055 };
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 to 255")]
    {
        (s * 255.0 + 0.5) as u8
    }
}

/// sRGB code to linear light.
pub(super) fn decode(x: u8) -> f32 {
    let s = f32::from(x) / 255.0;
    if s <= 0.040_45 { s / 12.92 } else { libm::powf((s + 0.055) / 1.055, 2.4) }
}
