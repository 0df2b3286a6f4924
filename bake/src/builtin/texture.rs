//! The texture: the wheel of paints on the left, the picture of an eye on the right.

use png::{BitDepth, ColorType, Compression, Encoder, Filter};

/// Height of the texture, and width of each half, pixels.
const SIZE: usize = 256;
/// Radius of the wheel and of the eye for half of [`SIZE`]: the rim keeps smaller mip levels apart.
const REACH: f64 = 0.92;
/// Up to this depth all directions have the body's colour.
const BARE: f64 = 0.3;
/// Samples along each edge of a pixel.
const SUPERSAMPLES: usize = 2;

/// A direction of the wheel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Paint {
    Belly,
    Ear,
    Blush,
    Tip,
    Stripe,
    Toe,
    Ink,
}

/// All paints, in the order of the wheel.
const WHEEL: [Paint; 7] =
    [Paint::Belly, Paint::Ear, Paint::Blush, Paint::Tip, Paint::Stripe, Paint::Toe, Paint::Ink];

/// A colour, sRGB `0..=1`.
type Color = [f64; 3];

const fn rgb(hex: u32) -> Color {
    let [_, r, g, b] = hex.to_be_bytes();
    [r as f64 / 255.0, g as f64 / 255.0, b as f64 / 255.0]
}

const BODY: Color = rgb(0x8E_70C4);
const CREAM: Color = rgb(0xFF_F0D8);
const CORAL: Color = rgb(0xFF_A6B0);
const DEEP: Color = rgb(0x60_4696);
const BLUSH: Color = rgb(0xF4_88A8);
const INK: Color = rgb(0x2A_2140);

/// Direction of a paint on the wheel.
fn direction(paint: Paint) -> [f64; 2] {
    let turn = f64::from(paint as u8) / f64::from(Paint::Ink as u8 + 1);
    let (sine, cosine) = libm::sincos(core::f64::consts::TAU * turn);
    [cosine, sine]
}

/// Texture coordinates of a paint at a depth `0..=1`.
pub(super) fn wheel_uv(paint: Paint, depth: f64) -> [f64; 2] {
    let [x, y] = direction(paint).map(|d| 0.5 + 0.5 * REACH * depth * d);
    [0.5 * x, y]
}

/// Texture coordinates of a point of the eye's picture, `-1..=1` from left to right and bottom to top.
pub(super) fn eye_uv(x: f64, y: f64) -> [f64; 2] {
    [0.75 + 0.25 * REACH * x, 0.5 - 0.5 * REACH * y]
}

/// The texture as PNG.
pub(super) fn png() -> Vec<u8> {
    let mut pixels = Vec::with_capacity(2 * SIZE * SIZE * 3);
    let directions = WHEEL.map(|paint| (paint, direction(paint)));
    let wheel = |x: f64, y: f64| wheel_color(&directions, x, y);
    for row in 0..SIZE {
        for column in 0..2 * SIZE {
            let color = if column < SIZE { pixel(column, row, wheel) } else { pixel(column, row, eye_color) };
            pixels.extend(color.map(byte));
        }
    }
    let mut out = Vec::new();
    let side = u32::try_from(SIZE).unwrap_or(u32::MAX);
    let mut encoder = Encoder::new(&mut out, 2 * side, side);
    encoder.set_color(ColorType::Rgb);
    encoder.set_depth(BitDepth::Eight);
    // The one compressor of the crate whose bytes do not depend on the features of its dependencies.
    encoder.set_compression(Compression::Fast);
    encoder.set_filter(Filter::Up);
    let written = encoder.write_header().and_then(|mut writer| writer.write_image_data(&pixels));
    debug_assert!(written.is_ok(), "a vector takes any number of bytes");
    out
}

/// Average colour of a pixel.
fn pixel(column: usize, row: usize, half: impl Fn(f64, f64) -> Color) -> Color {
    let mut sum = [0.0; 3];
    for sample in 0..SUPERSAMPLES * SUPERSAMPLES {
        let at = |pixel: usize, k: usize| {
            let offset = (real(k) + 0.5) / real(SUPERSAMPLES);
            (2.0 * (real(pixel) + offset) / real(SIZE) - 1.0) / REACH
        };
        let color = half(at(column % SIZE, sample % SUPERSAMPLES), at(row, sample / SUPERSAMPLES));
        for (s, c) in sum.iter_mut().zip(color) {
            *s += c / real(SUPERSAMPLES * SUPERSAMPLES);
        }
    }
    sum
}

/// The wheel at a point of the unit disc; a sector has the colours of its middle line.
fn wheel_color(directions: &[(Paint, [f64; 2]); WHEEL.len()], x: f64, y: f64) -> Color {
    let along = directions.map(|(paint, [dx, dy])| (paint, x * dx + y * dy));
    let (paint, depth) = along.into_iter().fold(along[0], |a, b| if b.1 > a.1 { b } else { a });
    let depth = depth.clamp(0.0, 1.0);
    let edge = |width: f64| smooth((depth - 0.5) / width + 0.5);
    let soft = smooth((depth - BARE) / (1.0 - BARE));
    match paint {
        Paint::Belly => mix(BODY, CREAM, edge(0.10)),
        Paint::Ear => mix(BODY, CORAL, edge(0.12)),
        Paint::Blush => mix(BODY, BLUSH, 0.95 * soft),
        Paint::Tip => mix(BODY, DEEP, soft),
        Paint::Stripe => mix(BODY, DEEP, edge(0.16)),
        Paint::Toe => mix(BODY, CREAM, edge(0.2)),
        Paint::Ink => mix(BODY, INK, edge(0.3)),
    }
}

/// The eye at a point of the unit disc (`y` downwards): a dark pupil in an iris that is lighter below,
/// and two lights.
fn eye_color(x: f64, y: f64) -> Color {
    let y = -y;
    let disc = |cx: f64, cy: f64, rx: f64, ry: f64| {
        let (dx, dy) = ((x - cx) / rx, (y - cy) / ry);
        smooth((1.0 - (dx * dx + dy * dy).sqrt()) * 8.0 + 0.5)
    };
    let glow = smooth((-y - 0.05) * 0.9) * disc(0.0, 0.0, 0.86, 0.86);
    let iris = mix(INK, rgb(0x3F_B5AC), glow);
    let pupil = mix(iris, rgb(0x19_1226), disc(0.0, 0.02, 0.52, 0.56));
    let light = mix(pupil, [1.0; 3], disc(-0.26, 0.40, 0.27, 0.25));
    mix(light, [1.0; 3], 0.9 * disc(0.30, -0.38, 0.13, 0.12))
}

/// 0 below 0, 1 above 1, C¹ between.
fn smooth(t: f64) -> f64 {
    let t = t.clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

fn mix(a: Color, b: Color, t: f64) -> Color {
    core::array::from_fn(|k| a[k] + (b[k] - a[k]) * t)
}

fn real(n: usize) -> f64 {
    f64::from(u32::try_from(n).unwrap_or(u32::MAX))
}

#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "rounded and within a byte")]
fn byte(x: f64) -> u8 {
    libm::round(x.clamp(0.0, 1.0) * 255.0) as u8
}
