//! Elementary functions in `f32`: one body for every target.
//!
//! Only `+ − × ÷ √`, comparisons and integer operations on the bits are used, so the results
//! follow from IEEE 754 alone. `std`'s functions do not: their bits are the platform's.

/// 1.5·2²³: adding and subtracting it rounds `|x| < 2²²` to the nearest integer, ties to even.
const ROUND: f32 = 12_582_912.0;
/// log₂ e.
const LOG2_E: f32 = f32::from_bits(0x3fb8_aa3b);
/// ln 2 in two parts; the first has 9 trailing zero bits, so `k·LN2_HI` is exact for `|k| ≤ 2⁸`.
const LN2_HI: f32 = 0.693_359_4;
const LN2_LO: f32 = -2.121_944_4e-4;
/// π/2 in three parts of at most 12 bits and a rest: `k·part` is exact for `|k| ≤ 2¹²`.
const PI_2: [f32; 4] = [1.570_312_5, 4.837_513e-4, 7.549_532e-8, 2.563_282_5e-12];

/// Square root, correctly rounded.
#[inline(always)]
#[must_use]
pub fn sqrt(x: f32) -> f32 {
    #[cfg(feature = "std")]
    {
        x.sqrt()
    }
    #[cfg(not(feature = "std"))]
    {
        libm::sqrtf(x)
    }
}

/// Absolute value.
#[inline(always)]
#[must_use]
pub const fn abs(x: f32) -> f32 {
    f32::from_bits(x.to_bits() & 0x7fff_ffff)
}

/// Smaller of two numbers by comparison: `b` where they are equal or `a` is NaN.
#[inline(always)]
#[must_use]
pub fn min(a: f32, b: f32) -> f32 {
    if a < b { a } else { b }
}

/// Larger of two numbers by comparison: `b` where they are equal or `a` is NaN.
#[inline(always)]
#[must_use]
pub fn max(a: f32, b: f32) -> f32 {
    if a > b { a } else { b }
}

/// `x` limited to `lo..=hi`.
#[inline(always)]
#[must_use]
pub fn clamp(x: f32, lo: f32, hi: f32) -> f32 {
    min(max(x, lo), hi)
}

/// Evaluates a polynomial, highest power first, by Horner's rule without fused operations.
#[inline(always)]
#[must_use]
pub fn horner<const N: usize>(coefficients: &[f32; N], x: f32) -> f32 {
    let mut sum = 0.0;
    for c in coefficients {
        sum = sum * x + c;
    }
    sum
}

/// `2ᵏ` for `−126 ≤ k ≤ 127`.
#[inline(always)]
fn exp2i(k: i32) -> f32 {
    f32::from_bits(((k + 127) << 23).cast_unsigned())
}

/// `eˣ`. Method: `x = k·ln 2 + r`, `|r| ≤ 0.35`, Taylor polynomial of degree 11 in `r`; error below 1.5 ulp.
///
/// Overflows to infinity above 88.72, underflows through the subnormals to 0 below −103.97.
#[must_use]
pub fn exp(x: f32) -> f32 {
    if x > 88.722_84 {
        return f32::INFINITY;
    }
    if x < -104.0 {
        return 0.0;
    }
    let k = (x * LOG2_E + ROUND) - ROUND;
    let r = (x - k * LN2_HI) - k * LN2_LO;
    let p = r + r * r * horner(&EXP_TAIL, r);
    #[allow(clippy::cast_possible_truncation, reason = "|k| <= 151")]
    let k = k as i32;
    let half = k / 2;
    (1.0 + p) * exp2i(half) * exp2i(k - half)
}

/// `eˣ − 1` without cancellation at 0; error below 3 ulp.
#[must_use]
pub fn expm1(x: f32) -> f32 {
    if abs(x) < 0.7 { x + x * x * horner(&EXP_TAIL, x) } else { exp(x) - 1.0 }
}

/// `(eˣ − 1 − x)/x²`, highest power first: `1/k!` for `k = 11 … 2`. Truncation below 5e-11 for `|x| ≤ 0.7`.
const EXP_TAIL: [f32; 10] = [
    1.0 / 39_916_800.0,
    1.0 / 3_628_800.0,
    1.0 / 362_880.0,
    1.0 / 40_320.0,
    1.0 / 5_040.0,
    1.0 / 720.0,
    1.0 / 120.0,
    1.0 / 24.0,
    1.0 / 6.0,
    1.0 / 2.0,
];

/// `(sin x, cos x)`, x in radians; `|x|` above 512 counts as 512 with its sign, so that the result is bounded.
#[must_use]
pub fn sin_cos(x: f32) -> (f32, f32) {
    let x = clamp(x, -512.0, 512.0);
    let k = (x * core::f32::consts::FRAC_2_PI + ROUND) - ROUND;
    let r = (((x - k * PI_2[0]) - k * PI_2[1]) - k * PI_2[2]) - k * PI_2[3];
    let (s, c) = sin_cos_octant(r);
    #[allow(clippy::cast_possible_truncation, reason = "|k| <= 326")]
    match (k as i32).rem_euclid(4) {
        0 => (s, c),
        1 => (c, -s),
        2 => (-s, -c),
        _ => (-c, s),
    }
}

/// `(sin r, cos r)` for `|r| ≤ π/4` (a little beyond is harmless): Taylor, truncation below 4e-10.
fn sin_cos_octant(r: f32) -> (f32, f32) {
    const SIN: [f32; 4] = [1.0 / 362_880.0, -1.0 / 5_040.0, 1.0 / 120.0, -1.0 / 6.0];
    const COS: [f32; 4] = [-1.0 / 3_628_800.0, 1.0 / 40_320.0, -1.0 / 720.0, 1.0 / 24.0];
    let z = r * r;
    (r + r * z * horner(&SIN, z), (1.0 - 0.5 * z) + z * z * horner(&COS, z))
}

/// `arccos x`, radians, for `0 ≤ x ≤ 1`; absolute error below 3e-7.
///
/// Source: Abramowitz and Stegun, Handbook of Mathematical Functions, 4.4.46.
#[must_use]
pub fn acos(x: f32) -> f32 {
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
    sqrt(max(1.0 - x, 0.0)) * horner(&A, x)
}

#[cfg(test)]
#[allow(clippy::disallowed_methods, reason = "std in f64 is the oracle")]
mod tests {
    use super::*;

    /// Distance from the f64 truth in units of the last place of the result.
    fn ulps(got: f32, want: f64) -> f64 {
        let grain = f64::from(f32::from_bits((got.to_bits() & 0x7f80_0000).max(1 << 23))) * 2_f64.powi(-23);
        ((f64::from(got) - want) / grain).abs()
    }

    #[test]
    fn exp_and_expm1_are_within_their_documented_error() {
        for i in -103_000..88_700 {
            #[allow(clippy::cast_precision_loss, reason = "a grid")]
            let x = i as f32 * 1e-3;
            let want = f64::from(x);
            assert!(ulps(exp(x), want.exp()) <= 1.5, "exp({x})");
            assert!(ulps(expm1(x), want.exp_m1()) <= 3.0, "expm1({x}) {}", ulps(expm1(x), want.exp_m1()));
        }
        assert_eq!((exp(0.0).to_bits(), exp(-1e30), exp(1e30)), (1.0_f32.to_bits(), 0.0, f32::INFINITY));
    }

    #[test]
    fn sin_cos_is_within_an_absolute_grain() {
        for i in -512_000..512_000 {
            #[allow(clippy::cast_precision_loss, reason = "a grid")]
            let x = i as f32 * 1e-3;
            let (s, c) = sin_cos(x);
            let (es, ec) = (f64::from(s) - f64::from(x).sin(), f64::from(c) - f64::from(x).cos());
            assert!(es.abs() < 1e-7 && ec.abs() < 1e-7, "sin_cos({x}): {es:e} {ec:e}");
        }
        assert!(sin_cos(1e30).0.abs() <= 1.0, "bounded beyond the domain");
    }

    #[test]
    fn acos_is_within_its_documented_error() {
        for i in 0..=10_000 {
            #[allow(clippy::cast_precision_loss, reason = "a grid")]
            let x = i as f32 * 1e-4;
            let error = f64::from(acos(x)) - f64::from(x).acos();
            assert!(error.abs() < 3e-7, "acos({x}): {error:e}");
        }
    }
}
