//! Colors: sRGB and linear, and the color map of heat maps.

use std::sync::LazyLock;

/// Linear light of an sRGB byte.
static LINEAR: LazyLock<[f32; 256]> = LazyLock::new(|| {
    core::array::from_fn(|i| {
        #[allow(clippy::cast_precision_loss, reason = "below 256")]
        let s = i as f64 / 255.0;
        let linear = if s <= 0.040_45 { s / 12.92 } else { libm::pow((s + 0.055) / 1.055, 2.4) };
        #[allow(clippy::cast_possible_truncation, reason = "single precision is meant")]
        let linear = linear as f32;
        linear
    })
});

/// Steps of [`ENCODED`]: fine enough that no byte is skipped in the dark.
const STEPS: usize = 1 << 13;

/// sRGB byte of `i / STEPS` of linear light.
static ENCODED: LazyLock<Vec<u8>> = LazyLock::new(|| {
    let encode = |i: usize| {
        #[allow(clippy::cast_precision_loss, reason = "below 2^24")]
        let l = i as f64 / STEPS as f64;
        let s = if l <= 0.003_130_8 { 12.92 * l } else { 1.055 * libm::pow(l, 1.0 / 2.4) - 0.055 };
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 to 255")]
        let byte = libm::round(s * 255.0) as u8;
        byte
    };
    (0..=STEPS).map(encode).collect()
});

/// Linear light of an sRGB byte.
#[must_use]
pub fn linear(byte: u8) -> f32 {
    LINEAR[usize::from(byte)]
}

/// Linear light of an sRGB color.
#[must_use]
pub(super) fn to_linear(srgb: [u8; 3]) -> [f32; 3] {
    srgb.map(|byte| LINEAR[usize::from(byte)])
}

/// sRGB color of linear light, clamped to `0..=1`.
#[must_use]
pub(super) fn to_srgb(linear: [f32; 3]) -> [u8; 3] {
    linear.map(|l| {
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 to STEPS")]
        #[allow(clippy::cast_precision_loss, reason = "STEPS is small")]
        let i = (l.clamp(0.0, 1.0) * STEPS as f32 + 0.5) as usize;
        ENCODED[i.min(STEPS)]
    })
}

/// sRGB color of a heat `0..=1`: pale clay where nothing moved, then yellow, orange and crimson to dark purple;
/// ever darker, so that it reads without color too.
#[must_use]
pub fn heat(value: f32) -> [u8; 3] {
    const STILL: [f32; 3] = [222.0, 219.0, 214.0];
    let v = if value.is_nan() { 0.0 } else { value.clamp(0.0, 1.0) };
    let c = colorous::INFERNO.eval_continuous(f64::from(0.93 - 0.75 * v));
    let warm = [c.r, c.g, c.b].map(f32::from);
    let share = (v / 0.12).min(1.0);
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 to 255")]
    core::array::from_fn(|i| (STILL[i] + (warm[i] - STILL[i]) * share + 0.5) as u8)
}
