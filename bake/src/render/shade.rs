//! From visible triangles to colors: lamps, sky, ground and background.

#![allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    clippy::cast_precision_loss,
    reason = "pixel coordinates"
)]

use super::camera::Camera;
use super::color;
use super::light::{LampView, Sky};
use super::raster::{Edges, NOTHING, Samples};
use super::scene::Scene;
use super::texture::lerp;
use super::{Paint, Surface};
use glam::Vec3;
use image::{Rgb, RgbImage};

/// Samples across a pixel, in each direction.
const SAMPLES: usize = 3;

/// Draws surfaces as the camera sees them, on a ground with shadows before a plain background.
///
/// Every surface is opaque. Triangles that name vertices which do not exist, or are not finite, are left out. The
/// picture is a function of the arguments alone, and the same on every host.
#[must_use]
pub fn render(surfaces: &[Surface<'_>], camera: &Camera, width: u32, height: u32) -> RgbImage {
    let scene = Scene::new(surfaces);
    let studio = Studio::new(&scene, camera, [width as f32, height as f32]);
    let samples = studio.look(width as usize, height as usize);
    RgbImage::from_fn(width, height, |x, y| Rgb(studio.pixel(&samples, x as usize, y as usize)))
}

/// A scene, lit.
struct Studio<'a> {
    scene: &'a Scene<'a>,
    camera: &'a Camera,
    size: [f32; 2],
    /// The main lamp.
    key: LampView,
    fill: Vec3,
    rim: Vec3,
    /// Share of the sky that vertices see.
    open: Vec<f32>,
    ground: Ground,
    /// Vertices in the picture: pixels and inverse distance.
    projected: Vec<Option<[f32; 3]>>,
}

impl<'a> Studio<'a> {
    fn new(scene: &'a Scene<'a>, camera: &'a Camera, size: [f32; 2]) -> Self {
        let back = Vec3::new(-camera.forward.x, 0.0, -camera.forward.z).normalize_or(Vec3::Z);
        // Lamps stand around the camera, so that every view is lit well.
        let lamp =
            |right: f32, up: f32, near: f32| (camera.right * right + Vec3::Y * up + back * near).normalize();
        let key = LampView::new(scene, lamp(-0.55, 0.95, 0.62), 512, 1);
        let sky = Sky::new(scene);
        Self {
            open: sky.at_vertices(scene),
            ground: Ground::new(scene, camera, &key, &sky),
            fill: lamp(0.9, 0.2, 0.5),
            rim: lamp(0.5, 0.55, -0.9),
            projected: scene.positions.iter().map(|p| camera.project(p.to_array(), size)).collect(),
            scene,
            camera,
            size,
            key,
        }
    }

    /// Finds the triangle of every sample.
    fn look(&self, width: usize, height: usize) -> Samples {
        let mut samples = Samples::new(width * SAMPLES, height * SAMPLES);
        for (number, t) in self.scene.triangles.iter().enumerate() {
            let Some(corners) = self.corners(t) else { continue };
            let hidden = !self.scene.surface(number).double_sided && !self.faces(number);
            if !hidden {
                let scale = SAMPLES as f32;
                let corners = corners.map(|[x, y, near]| [x * scale, y * scale, near]);
                samples.draw(number as u32, corners);
            }
        }
        samples
    }

    fn corners(&self, t: &[u32; 3]) -> Option<[[f32; 3]; 3]> {
        let [a, b, c] = t.map(|i| self.projected[i as usize]);
        Some([a?, b?, c?])
    }

    /// Whether a triangle turns its outer side to the camera.
    fn faces(&self, triangle: usize) -> bool {
        let p = self.scene.positions[self.scene.triangles[triangle][0] as usize];
        self.scene.outward(triangle).dot(self.camera.eye - p) > 0.0
    }

    /// sRGB color of a pixel: each triangle in it is shaded once, at the middle of its samples.
    fn pixel(&self, samples: &Samples, x: usize, y: usize) -> [u8; 3] {
        let rows: [&[u32]; SAMPLES] = core::array::from_fn(|j| {
            let start = (y * SAMPLES + j) * samples.width + x * SAMPLES;
            &samples.triangle[start..start + SAMPLES]
        });
        let first = rows[0][0];
        if rows.iter().all(|r| r.iter().all(|t| *t == first)) {
            return color::to_srgb(self.triangle_or_wall(first, x as f32 + 0.5, y as f32 + 0.5));
        }
        let mut seen = [(NOTHING, 0.0_f32, [0.0_f32; 2]); SAMPLES * SAMPLES];
        let mut kinds = 0;
        for (j, row) in rows.into_iter().enumerate() {
            for (i, &t) in row.iter().enumerate() {
                let known = seen[..kinds].iter().position(|s| s.0 == t);
                let slot = known.unwrap_or(kinds);
                kinds = kinds.max(slot + 1);
                let middle = [i, j].map(|k| (k as f32 + 0.5) / SAMPLES as f32);
                let (_, count, at) = seen[slot];
                seen[slot] = (t, count + 1.0, [at[0] + middle[0], at[1] + middle[1]]);
            }
        }
        let mut sum = [0.0; 3];
        for &(t, count, at) in &seen[..kinds] {
            let [px, py] = [x as f32 + at[0] / count, y as f32 + at[1] / count];
            let light = self.triangle_or_wall(t, px, py);
            sum = core::array::from_fn(|i| sum[i] + light[i] * count);
        }
        color::to_srgb(sum.map(|c| c / (SAMPLES * SAMPLES) as f32))
    }

    fn triangle_or_wall(&self, t: u32, x: f32, y: f32) -> [f32; 3] {
        if t == NOTHING { self.behind(x, y) } else { self.surface(t as usize, x, y) }
    }

    /// Light from the background and the ground on it.
    fn behind(&self, x: f32, y: f32) -> [f32; 3] {
        let (x, y) = (x / self.size[0], y / self.size[1]);
        let shade = self.ground.shade(self.camera, x, y);
        let plain = background(x, y);
        let dark = [plain[0] * 0.30, plain[1] * 0.31, plain[2] * 0.36];
        lerp(plain, dark, shade)
    }

    /// Light from a point of a triangle.
    fn surface(&self, triangle: usize, x: f32, y: f32) -> [f32; 3] {
        let t = self.scene.triangles[triangle];
        let Some((corners, edges)) = self.corners(&t).and_then(|c| Some((c, Edges::new(c)?))) else {
            return self.behind(x, y);
        };
        let flat = edges.at(x, y).map(|w| w.clamp(0.0, 1.0));
        let near: [f32; 3] = core::array::from_fn(|i| flat[i] * corners[i][2]);
        let weights = near.map(|w| w / (near[0] + near[1] + near[2]));
        let mix = |of: &[Vec3]| {
            of[t[0] as usize] * weights[0] + of[t[1] as usize] * weights[1] + of[t[2] as usize] * weights[2]
        };
        let point = mix(&self.scene.positions);
        let side = if self.faces(triangle) { 1.0 } else { -1.0 };
        let normal =
            mix(&self.scene.normals).normalize_or(self.scene.outward(triangle).normalize_or_zero()) * side;
        let open: f32 = (0..3).map(|i| self.open[t[i] as usize] * weights[i]).sum();
        let [a, b, c] = corners;
        let pixel_area = ((b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1])).abs();
        let albedo = self.scene.albedo(triangle, weights, pixel_area);
        let plain = matches!(self.scene.surface(triangle).paint, Paint::Heat(_) | Paint::Colors(_));
        self.light(point, normal, open, albedo, plain)
    }

    /// Three lamps and the sky on a point; `plain` evens the light out, so that colors can be read.
    fn light(&self, point: Vec3, normal: Vec3, open: f32, albedo: [f32; 3], plain: bool) -> [f32; 3] {
        let view = (self.camera.eye - point).normalize();
        let wrap = |lamp: Vec3, w: f32| ((normal.dot(lamp) + w) / (1.0 + w)).max(0.0);
        let facing = normal.dot(self.key.toward);
        let offset = normal * (2.0 * self.key.texel()) + self.key.toward * (1.5 * self.key.texel());
        let seen = SHADED + (1.0 - SHADED) * self.key.sees_softly(point + offset);
        // Where the surface turns away the shadow map has no say: the wrapped light fades by itself.
        let trust = (facing * 4.0).clamp(0.0, 1.0);
        let key = wrap(self.key.toward, 0.25) * (seen * trust + 0.35 * (1.0 - trust));
        let fill = wrap(self.fill, 0.5);
        let glance = 1.0 - normal.dot(view).clamp(0.0, 1.0);
        let rim = wrap(self.rim, 0.1) * glance * glance;
        let sky = 0.5 + 0.5 * normal.y;
        let open = open * open * 0.85 + 0.15;
        let shine = normal.dot((self.key.toward + view).normalize()).max(0.0);
        let shine = [2, 4, 8, 16, 32].iter().fold(shine, |s, _| s * s) * seen * trust;
        let (strength, ambient) = if plain { (0.42, 1.25) } else { (1.0, 1.0) };
        core::array::from_fn(|i| {
            let lamps = KEY[i] * key + FILL[i] * fill * open;
            let around = (BOUNCE[i] + (SKY[i] - BOUNCE[i]) * sky) * open * ambient;
            let sheen = if plain { 0.0 } else { RIM[i] * rim * (0.25 + albedo[i]) + 0.05 * shine };
            shoulder(albedo[i] * (lamps * strength + around) + sheen)
        })
    }
}

/// Share of the main lamp that reaches its shadows: walls of a room throw that much back.
const SHADED: f32 = 0.15;

/// Linear light of the wall.
const WALL_MIDDLE: [f32; 3] = [0.87, 0.88, 0.90];
const WALL_EDGE: [f32; 3] = [0.48, 0.53, 0.60];

/// Linear light of the lamps and the sky.
const KEY: [f32; 3] = [0.95, 0.90, 0.82];
const FILL: [f32; 3] = [0.13, 0.15, 0.19];
const RIM: [f32; 3] = [0.75, 0.80, 0.95];
const SKY: [f32; 3] = [0.36, 0.40, 0.46];
const BOUNCE: [f32; 3] = [0.24, 0.22, 0.20];

/// Bends what is too bright gently below 1.
fn shoulder(light: f32) -> f32 {
    const KNEE: f32 = 0.7;
    if light < KNEE {
        return light;
    }
    let over = light - KNEE;
    KNEE + over / (1.0 + over / (1.0 - KNEE))
}

/// The wall behind everything, linear: light in the middle, darker towards the edges.
fn background(x: f32, y: f32) -> [f32; 3] {
    let (dx, dy) = (x - 0.5, y - 0.45);
    let away = (dx * dx * 1.4 + dy * dy * 1.6).clamp(0.0, 1.0);
    lerp(WALL_MIDDLE, WALL_EDGE, (away * 1.5).min(1.0))
}

/// Shadow on the ground, computed on a grid around the scene.
struct Ground {
    height: f32,
    corner: [f32; 2],
    step: f32,
    shade: Vec<f32>,
}

/// Points of the grid across.
const GRID: usize = 128;

impl Ground {
    fn new(scene: &Scene<'_>, camera: &Camera, key: &LampView, sky: &Sky) -> Self {
        let finite = || scene.positions.iter().filter(|p| p.is_finite());
        let low = finite().fold(Vec3::splat(f32::INFINITY), |l, p| l.min(*p));
        let high = finite().fold(Vec3::splat(f32::NEG_INFINITY), |h, p| h.max(*p));
        let mut ground = Self { height: camera.ground, corner: [0.0; 2], step: 0.0, shade: Vec::new() };
        if low.x > high.x {
            return ground;
        }
        // The shadow of the highest point falls this far.
        let reach = (high.y - camera.ground).max(0.0) * 1.2 + 0.1 * camera.size;
        let side = (high.x - low.x).max(high.z - low.z) + 2.0 * reach;
        ground.step = side / (GRID - 1) as f32;
        ground.corner = [0.5 * (low.x + high.x - side), 0.5 * (low.z + high.z - side)];
        let at = |i: usize| {
            let [x, z] = [(i % GRID) as f32, (i / GRID) as f32];
            let p = Vec3::new(
                ground.corner[0] + x * ground.step,
                camera.ground,
                ground.corner[1] + z * ground.step,
            );
            let border = [x, z].map(|v| (v.min((GRID - 1) as f32 - v) / 12.0).min(1.0));
            let light = (1.0 - 0.55 * key.covers(p)) * (1.0 - sky.covers(p)).max(0.0);
            (1.0 - light) * border[0] * border[1]
        };
        ground.shade = (0..GRID * GRID).map(at).collect();
        ground
    }

    /// Darkness `0..=1` of the ground at a place of the picture.
    fn shade(&self, camera: &Camera, x: f32, y: f32) -> f32 {
        let ray = camera.ray(x, y);
        let distance = (self.height - camera.eye.y) / ray.y;
        if self.shade.is_empty() || !(distance > 0.0 && distance.is_finite()) {
            return 0.0;
        }
        let p = camera.eye + ray * distance;
        let u = (p.x - self.corner[0]) / self.step;
        let v = (p.z - self.corner[1]) / self.step;
        let last = (GRID - 1) as f32;
        if !(u >= 0.0 && v >= 0.0 && u < last && v < last) {
            return 0.0;
        }
        let (i, j) = (u as usize, v as usize);
        let (fu, fv) = (u - i as f32, v - j as f32);
        let at = |i: usize, j: usize| self.shade[j * GRID + i];
        let near = at(i, j) * (1.0 - fu) + at(i + 1, j) * fu;
        let far = at(i, j + 1) * (1.0 - fu) + at(i + 1, j + 1) * fu;
        near * (1.0 - fv) + far * fv
    }
}
