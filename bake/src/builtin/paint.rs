//! Colours: a small texture of ramps, and where on it each point lies.

use glam::DVec3;

/// Colours of the ramps, sRGB: fur, and what it turns into: cream, pink, dusk.
const FUR: [u8; 3] = [142, 112, 196];
const RAMPS: [[u8; 3]; 4] = [[255, 238, 214], [255, 166, 176], [96, 70, 150], [142, 112, 196]];
/// Pixels of a ramp, and rows that each takes.
const WIDTH: u32 = 64;
const ROWS: u32 = 8;

/// The texture as PNG: ramp `k` in band `k`, fur at the left.
pub(super) fn texture() -> Vec<u8> {
    let mut pixels = Vec::new();
    for y in 0..4 * ROWS {
        let end = RAMPS[(y / ROWS) as usize];
        for x in 0..WIDTH {
            let mix = |a: u8, b: u8| {
                let (a, b) = (u32::from(a), u32::from(b));
                u8::try_from((a * (WIDTH - 1 - x) + b * x) / (WIDTH - 1)).unwrap_or(255)
            };
            pixels.extend([0, 1, 2].map(|c| mix(FUR[c], end[c])));
        }
    }
    let mut out = Vec::new();
    let mut encoder = png::Encoder::new(&mut out, WIDTH, 4 * ROWS);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    let written = encoder.write_header().and_then(|mut w| w.write_image_data(&pixels));
    if written.is_err() {
        out.clear(); // a vector takes everything; without a texture the material's colour stands
    }
    out
}

/// Texture coordinates of a point with the normal `n`.
pub(super) fn uv(p: DVec3, n: DVec3) -> [f32; 2] {
    let bump = |low: f64, high: f64, x: f64| {
        let t = ((x - low) / (high - low)).clamp(0.0, 1.0);
        t * t * (3.0 - 2.0 * t)
    };
    let belly = {
        let q = DVec3::new(p.x / 0.26, (p.y - 0.58) / 0.31, 0.0).length();
        bump(1.0, 0.78, q) * bump(0.10, 0.35, n.z)
    };
    let muzzle = {
        let q = DVec3::new(p.x / 0.155, (p.y - 1.075) / 0.085, 0.0).length();
        bump(1.0, 0.7, q) * bump(0.2, 0.5, n.z)
    };
    let ear = {
        let x = p.x.abs() - (0.12 + 0.16 * (p.y - 1.36) / 0.5);
        bump(1.42, 1.50, p.y) * bump(1.82, 1.74, p.y) * bump(0.05, 0.025, x.abs()) * bump(0.3, 0.7, n.z)
    };
    let tips = bump(0.52, 0.60, p.y) * bump(-0.70, -0.74, p.z);
    let toes = bump(0.20, 0.235, p.z) * bump(0.10, 0.07, p.y);
    let blush = {
        let q = DVec3::new((p.x.abs() - 0.20) / 0.06, (p.y - 1.115) / 0.045, 0.0).length();
        0.55 * bump(1.0, 0.3, q) * bump(0.3, 0.6, n.z)
    };
    let back = 0.7 * bump(0.3, 0.9, -n.z) * bump(0.25, 0.5, p.y);
    let cream = belly.max(muzzle).max(tips);
    let pink = ear.max(toes).max(blush);
    let (band, u) = if cream >= pink && cream > 0.0 {
        (0.0, cream)
    } else if pink > 0.0 {
        (1.0, pink)
    } else {
        (2.0, back)
    };
    [crate::pack::narrow(0.01 + 0.98 * u), crate::pack::narrow((band + 0.5) / 4.0)]
}
