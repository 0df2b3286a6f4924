//! Shadows: what the lamps and the sky see of a scene.

#![allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    clippy::cast_precision_loss,
    reason = "sample coordinates, clamped to the buffer"
)]

use super::raster::{NOTHING, Samples};
use super::scene::Scene;
use glam::Vec3;

/// A parallel view of a scene from the direction of a lamp.
#[derive(Clone, Debug)]
pub(super) struct LampView {
    right: Vec3,
    up: Vec3,
    /// Direction to the lamp.
    pub(super) toward: Vec3,
    /// Lower left corner in the coordinates of `right` and `up`.
    corner: [f32; 2],
    /// Samples a unit of length.
    scale: f32,
    samples: Samples,
    coverage: Coverage,
}

/// Which share of the surroundings of a sample is covered: soft shadows on the ground.
#[derive(Clone, Debug, Default)]
struct Coverage {
    /// Points across, one for each block of samples.
    side: usize,
    /// Points a sample.
    scale: f32,
    shares: Vec<f32>,
}

impl LampView {
    /// The scene seen from `toward` (unit length) with `side` samples across. Shadows on the
    /// ground are as soft as `blur` blocks of samples.
    pub(super) fn new(scene: &Scene<'_>, toward: Vec3, side: usize, blur: usize) -> Self {
        let helper = if toward.y.abs() < 0.9 { Vec3::Y } else { Vec3::X };
        let right = helper.cross(toward).normalize();
        let up = toward.cross(right);
        let flat = |p: Vec3| [p.dot(right), p.dot(up)];
        let (mut low, mut high) = ([f32::INFINITY; 2], [f32::NEG_INFINITY; 2]);
        for p in scene.positions.iter().filter(|p| p.is_finite()) {
            let q = flat(*p);
            (low, high) = ([0, 1].map(|i| low[i].min(q[i])), [0, 1].map(|i| high[i].max(q[i])));
        }
        let extent = (high[0] - low[0]).max(high[1] - low[1]).max(f32::MIN_POSITIVE);
        // Room for the blur, which must not be cut off.
        let margin = ((blur * 3 + 1) * Coverage::BLOCK) as f32;
        let scale = (side as f32 - 2.0 * margin) / extent;
        let corner = [low[0] - margin / scale, low[1] - margin / scale];
        let samples = Samples::new(side, side);
        let mut view = Self { right, up, toward, corner, scale, samples, coverage: Coverage::default() };
        for (number, corners) in (0..).zip(&scene.triangles) {
            let corners = corners.map(|i| view.place(scene.positions[i as usize]));
            view.samples.draw(number, corners);
        }
        view.coverage = Coverage::new(&view.samples, blur);
        view
    }

    /// Place of a point, samples, and its nearness to the lamp.
    fn place(&self, p: Vec3) -> [f32; 3] {
        let [x, y] = [p.dot(self.right) - self.corner[0], p.dot(self.up) - self.corner[1]];
        [x * self.scale, y * self.scale, p.dot(self.toward)]
    }

    /// Width of a sample.
    pub(super) fn texel(&self) -> f32 {
        1.0 / self.scale
    }

    /// Whether the lamp sees a point at the nearest sample, 0 or 1.
    pub(super) fn sees(&self, p: Vec3) -> f32 {
        let [x, y, near] = self.place(p);
        self.visible(x, y, near)
    }

    fn visible(&self, x: f32, y: f32, near: f32) -> f32 {
        let inside = x >= 0.0 && y >= 0.0 && x < self.samples.width as f32 && y < self.samples.height as f32;
        let blocked = inside && self.samples.nearness[y as usize * self.samples.width + x as usize] > near;
        if blocked { 0.0 } else { 1.0 }
    }

    /// Share of the lamp that a point sees: the mean over 4 × 4 samples around it, without steps.
    pub(super) fn sees_softly(&self, p: Vec3) -> f32 {
        let [x, y, near] = self.place(p);
        let (fx, fy) = (x - 0.5 - libm::floorf(x - 0.5), y - 0.5 - libm::floorf(y - 0.5));
        // A box as wide as three samples: the outer ones count by the share that it covers.
        let (wx, wy) = ([1.0 - fx, 1.0, 1.0, fx], [1.0 - fy, 1.0, 1.0, fy]);
        let mut sum = 0.0;
        for (j, v) in wy.iter().enumerate() {
            for (i, u) in wx.iter().enumerate() {
                sum += u * v * self.visible(x - fx - 1.0 + i as f32, y - fy - 1.0 + j as f32, near);
            }
        }
        sum / 9.0
    }

    /// Share of the lamp's light that the scene keeps from a point below it.
    pub(super) fn covers(&self, p: Vec3) -> f32 {
        let [x, y, _] = self.place(p);
        self.coverage.at(x, y)
    }
}

impl Coverage {
    /// Samples across a block.
    const BLOCK: usize = 4;

    /// Means over blocks of samples, then three boxes of `2 · radius + 1` blocks: nearly a bell.
    fn new(samples: &Samples, radius: usize) -> Self {
        let side = samples.width / Self::BLOCK;
        let mut shares = vec![0.0; side * side];
        for (y, row) in samples.triangle.chunks_exact(samples.width).enumerate() {
            for (x, t) in row.iter().enumerate() {
                if *t != NOTHING {
                    shares[y / Self::BLOCK * side + x / Self::BLOCK] +=
                        1.0 / (Self::BLOCK * Self::BLOCK) as f32;
                }
            }
        }
        for _ in 0..2 {
            for _ in 0..3 {
                blur_rows(&mut shares, side, radius);
            }
            shares = (0..side * side).map(|i| shares[(i % side) * side + i / side]).collect();
        }
        Self { side, scale: 1.0 / Self::BLOCK as f32, shares }
    }

    /// Share at a place in samples, between the points; 0 outside.
    fn at(&self, x: f32, y: f32) -> f32 {
        let (x, y) = (x * self.scale - 0.5, y * self.scale - 0.5);
        let last = self.side.saturating_sub(1) as f32;
        if !(x >= 0.0 && y >= 0.0 && x < last && y < last) {
            return 0.0;
        }
        let (i, j) = (x as usize, y as usize);
        let (fx, fy) = (x - i as f32, y - j as f32);
        let row = |j: usize| {
            let i = j * self.side + i;
            self.shares[i] * (1.0 - fx) + self.shares[i + 1] * fx
        };
        row(j) * (1.0 - fy) + row(j + 1) * fy
    }
}

/// Means over `2 · radius + 1` neighbors in each row.
fn blur_rows(values: &mut [f32], side: usize, radius: usize) {
    let share = 1.0 / (2 * radius + 1) as f32;
    let mut sums = vec![0.0; side + 1];
    for row in values.chunks_exact_mut(side) {
        for (i, v) in row.iter().enumerate() {
            sums[i + 1] = sums[i] + v;
        }
        for (i, v) in row.iter_mut().enumerate() {
            *v = (sums[(i + radius + 1).min(side)] - sums[i.saturating_sub(radius)]) * share;
        }
    }
}

/// Ambient light: how much of the sky points of the scene and of the ground see.
#[derive(Debug)]
pub(super) struct Sky {
    views: Vec<LampView>,
}

impl Sky {
    /// Looks at the scene from directions spread over the upper hemisphere.
    pub(super) fn new(scene: &Scene<'_>) -> Self {
        Self { views: directions().map(|d| LampView::new(scene, d, 128, 1)).collect() }
    }

    /// Share of the sky that each vertex of the scene sees, weighted by how much it faces the parts.
    pub(super) fn at_vertices(&self, scene: &Scene<'_>) -> Vec<f32> {
        let see = |(p, n): (&Vec3, &Vec3)| {
            let (mut seen, mut whole) = (0.0, 0.0);
            for view in &self.views {
                let weight = n.dot(view.toward) + 0.35;
                if weight > 0.0 {
                    // Clear of the triangles next to the vertex.
                    let start = *p + *n * (1.6 * view.texel()) + view.toward * (1.2 * view.texel());
                    seen += weight * view.sees(start);
                    whole += weight;
                }
            }
            if whole > 0.0 { seen / whole } else { 1.0 }
        };
        scene.positions.iter().zip(&scene.normals).map(see).collect()
    }

    /// Share of the sky that the scene keeps from a point of the ground.
    pub(super) fn covers(&self, p: Vec3) -> f32 {
        let (mut hidden, mut whole) = (0.0, 0.0);
        for view in &self.views {
            hidden += view.toward.y * view.covers(p);
            whole += view.toward.y;
        }
        hidden / whole
    }
}

/// Directions over the upper hemisphere, steep and shallow ones in turn.
fn directions() -> impl Iterator<Item = Vec3> {
    const COUNT: u8 = 14;
    (0..COUNT).map(|i| {
        let y = 0.12 + 0.86 * (f64::from(i) + 0.5) / f64::from(COUNT);
        let (sin, cos) = libm::sincos(f64::from(i) * 2.399_963);
        let r = libm::sqrt(1.0 - y * y);
        Vec3::new((r * cos) as f32, y as f32, (r * sin) as f32).normalize()
    })
}
