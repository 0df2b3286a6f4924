//! Colours: a small texture, and where on it each point lies.
//!
//! Across, the texture runs from dusk over fur to cream; down, it turns pink. Both coordinates are
//! continuous on the body, so nothing shows between the vertices that was not meant.

use glam::DVec3;

/// Colours, sRGB.
const DUSK: [u8; 3] = [96, 70, 150];
const FUR: [u8; 3] = [142, 112, 196];
const CREAM: [u8; 3] = [255, 238, 214];
const PINK: [u8; 3] = [255, 166, 176];
/// Pixels across and down.
const SIZE: (u32, u32) = (96, 32);
/// Share of the width from dusk to fur.
const DARK: u32 = SIZE.0 / 3;

fn mix(a: [u8; 3], b: [u8; 3], share: u32, of: u32) -> [u8; 3] {
    [0, 1, 2].map(|c| {
        let (a, b) = (u32::from(a[c]), u32::from(b[c]));
        u8::try_from((a * (of - share) + b * share) / of).unwrap_or(255)
    })
}

/// The texture as PNG.
pub(super) fn texture() -> Vec<u8> {
    let (width, height) = SIZE;
    let mut pixels = Vec::new();
    for y in 0..height {
        for x in 0..width {
            let fur =
                if x < DARK { mix(DUSK, FUR, x, DARK) } else { mix(FUR, CREAM, x - DARK, width - 1 - DARK) };
            pixels.extend(mix(fur, PINK, y, height - 1));
        }
    }
    let mut out = Vec::new();
    let mut encoder = png::Encoder::new(&mut out, width, height);
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
    // A third of the way is fur; the ends stay clear of the texture's wrapping edge.
    let across = (1.0 - back) / 3.0 * (1.0 - cream) + cream;
    [crate::pack::narrow(0.02 + 0.96 * across), crate::pack::narrow(0.03 + 0.94 * pink.min(1.0))]
}
