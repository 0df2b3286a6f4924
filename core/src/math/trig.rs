//! `sin x`, `cos x` for `|x| ≤ 512`, and `arccos`, correctly rounded.
//!
//! ```text
//! x = n·π/2 + r,  |r| ≤ π/4 + 2⁻¹⁵        sin r, cos r by Taylor of degree 17 and 16, truncation below 2⁻⁵⁶
//! ```

use super::exp::TO_INTEGER;
use super::float::{abs, clamp, horner, sqrt};
use super::hard;
use super::rounding::{Elementary, correctly_rounded};
use super::wide::{Scaled, Wide, series};

/// Beyond, an argument counts as 512 with its sign, so that the result is bounded.
const LARGEST: f32 = 512.0;
/// π/2 in three parts; the first two have 15 bits, so their products with `|n| ≤ 326` are exact.
const HALF_PI: [f32; 2] = [f32::from_bits(0x3fc9_1000), f32::from_bits(0xb695_7800)];
const HALF_PI_REST: f64 = f64::from_bits(0x3dd0_b461_1a62_6331);

/// `(sin x, cos x)` of `|x| ≤ 512`.
#[inline]
pub(crate) fn sin_cos_wide<W: Wide>(x: W) -> (W, W) {
    let n = (x.head() * core::f32::consts::FRAC_2_PI + TO_INTEGER) - TO_INTEGER;
    let r = ((x - W::new(n * HALF_PI[0])) - W::new(n * HALF_PI[1])) - W::new(n) * W::constant(HALF_PI_REST);
    let (s, c) = octant(r);
    #[allow(clippy::cast_possible_truncation, reason = "|n| <= 326")]
    match (n as i32) & 3 {
        0 => (s, c),
        1 => (c, -s),
        2 => (-s, -c),
        _ => (-c, s),
    }
}

/// `(sin r, cos r)` for `|r| ≤ π/4`, a little beyond is harmless.
#[inline]
fn octant<W: Wide>(r: W) -> (W, W) {
    const SIN_TAIL: [f64; 5] = [
        1.0 / 355_687_428_096_000.0,
        -1.0 / 1_307_674_368_000.0,
        1.0 / 6_227_020_800.0,
        -1.0 / 39_916_800.0,
        1.0 / 362_880.0,
    ];
    const SIN: [f64; 3] = [-1.0 / 5_040.0, 1.0 / 120.0, -1.0 / 6.0];
    const COS_TAIL: [f64; 4] =
        [1.0 / 20_922_789_888_000.0, -1.0 / 87_178_291_200.0, 1.0 / 479_001_600.0, -1.0 / 3_628_800.0];
    const COS: [f64; 4] = [1.0 / 40_320.0, -1.0 / 720.0, 1.0 / 24.0, -0.5];
    let z = r * r;
    (r + r * z * series(&SIN_TAIL, &SIN, z), W::new(1.0) + z * series(&COS_TAIL, &COS, z))
}

/// [`sin`].
#[derive(Debug)]
pub enum Sin {}

impl Elementary for Sin {
    const HARD: &'static [(u32, u32)] = &hard::SIN;

    fn special(x: f32) -> Option<f32> {
        match abs(x) {
            a if a.is_nan() => Some(f32::NAN),
            a if a < 2e-4 => Some(x), // nearest to x − x³/6
            _ => None,
        }
    }

    fn evaluate<W: Wide>(x: f32) -> Scaled<W> {
        sin_cos_wide(W::new(clamp(x, -LARGEST, LARGEST))).0.into()
    }
}

/// [`cos`].
#[derive(Debug)]
pub enum Cos {}

impl Elementary for Cos {
    const HARD: &'static [(u32, u32)] = &hard::COS;

    fn special(x: f32) -> Option<f32> {
        match abs(x) {
            a if a.is_nan() => Some(f32::NAN),
            a if a < 2e-4 => Some(1.0),
            _ => None,
        }
    }

    fn evaluate<W: Wide>(x: f32) -> Scaled<W> {
        sin_cos_wide(W::new(clamp(x, -LARGEST, LARGEST))).1.into()
    }
}

/// `sin x`, x in radians; `|x|` above 512 counts as 512 with its sign. NaN for NaN.
#[must_use]
pub fn sin(x: f32) -> f32 {
    correctly_rounded::<Sin>(x)
}

/// `cos x`, x in radians; `|x|` above 512 counts as 512. NaN for NaN.
#[must_use]
pub fn cos(x: f32) -> f32 {
    correctly_rounded::<Cos>(x)
}

/// `(sin x, cos x)`, see [`sin`] and [`cos`].
#[must_use]
pub fn sin_cos(x: f32) -> (f32, f32) {
    (sin(x), cos(x))
}

/// [`acos`].
#[derive(Debug)]
pub enum Acos {}

impl Elementary for Acos {
    const HARD: &'static [(u32, u32)] = &hard::ACOS;

    fn special(x: f32) -> Option<f32> {
        match x {
            1.0 => Some(0.0),
            -1.0..1.0 => None,
            _ => Some(f32::NAN),
        }
    }

    /// `θ = θ₀ + arcsin(sin(θ − θ₀))` from an estimate `θ₀`; the second term is below 4e-7.
    fn evaluate<W: Wide>(x: f32) -> Scaled<W> {
        /// Abramowitz and Stegun 4.4.46: `arccos x ≈ √(1 − x)·Σ aₖ·xᵏ` for `0 ≤ x ≤ 1`.
        const A: [f32; 8] = [
            -0.001_262_491_1,
            0.006_670_09,
            -0.017_088_126,
            0.030_891_88,
            -0.050_174_305,
            0.088_978_99,
            -0.214_598_8,
            core::f32::consts::FRAC_PI_2,
        ];
        let a = abs(x);
        let one = W::new(1.0);
        let cosine = W::new(a);
        let estimate = W::new(sqrt(1.0 - a) * horner(&A, a));
        let (s, c) = sin_cos_wide(estimate);
        let sine = ((one - cosine) * (one + cosine)).sqrt();
        let angle = estimate + (sine * c - cosine * s);
        let angle = if x < 0.0 { W::constant(core::f64::consts::PI) - angle } else { angle };
        angle.into()
    }
}

/// `arccos x`, radians, for `−1 ≤ x ≤ 1`; NaN elsewhere.
#[must_use]
pub fn acos(x: f32) -> f32 {
    correctly_rounded::<Acos>(x)
}
