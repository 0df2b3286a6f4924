//! Correct rounding: an elementary function returns the `f32` nearest to the real value.
//!
//! Then its bits follow from mathematics, whatever the code. A function is evaluated in a wider
//! number type; the result decides the rounding unless it lies within its own error of the middle
//! between two neighbors. Sweeps over all 2³² inputs (`cargo xtask exhaustive`) prove, per function:
//!
//! * by `f64`, the rounding goes wrong for few inputs, and these are listed with their results ([`Elementary::HARD`]);
//! * by [`Twin`], it is in doubt for about one input in two thousand, which then goes to `f64`
//!   (in software where the machine has none), and never wrong when not in doubt.

use super::float::abs;
use super::twin::Twin;
use super::wide::{Scaled, Wide, f64_power_of_two, power_of_two};

/// A function of one argument, written once for every number type.
pub trait Elementary {
    /// Inputs whose value in `f64` lies on the wrong side of a middle: `(bits of x, bits of f(x))`.
    const HARD: &'static [(u32, u32)];

    /// Absolute error of the evaluation in pairs of `f32`, where it is not small beside the value.
    const UNCERTAINTY: f32 = 0.0;

    /// Results that need no arithmetic: special values, overflow, underflow, tiny arguments.
    fn special(x: f32) -> Option<f32>;

    /// The function where it is not special.
    fn evaluate<W: Wide>(x: f32) -> Scaled<W>;
}

/// The value of `F`, correctly rounded, by the number type that suits the machine.
#[inline]
#[must_use]
pub fn correctly_rounded<F: Elementary>(x: f32) -> f32 {
    // Processors for which `f64` is a library of integer operations.
    let software_f64 = cfg!(any(all(target_arch = "arm", target_os = "none"), target_arch = "riscv32"));
    if software_f64 { by_twins::<F>(x) } else { by_doubles::<F>(x) }
}

/// The value of `F`, correctly rounded, evaluated in `f64`.
#[inline]
#[must_use]
pub fn by_doubles<F: Elementary>(x: f32) -> f32 {
    match F::special(x) {
        Some(y) => y,
        None => round_doubles::<F>(x, F::evaluate(x)),
    }
}

/// The value of `F`, correctly rounded, evaluated in pairs of `f32` unless that leaves a doubt.
#[inline]
#[must_use]
pub fn by_twins<F: Elementary>(x: f32) -> f32 {
    match F::special(x) {
        Some(y) => y,
        None => round_twins(F::evaluate(x), F::UNCERTAINTY).unwrap_or_else(|| in_doubt::<F>(x)),
    }
}

/// Kept apart: rare.
#[cold]
#[inline(never)]
fn in_doubt<F: Elementary>(x: f32) -> f32 {
    round_doubles::<F>(x, F::evaluate(x))
}

/// Rounds a value of `F(x)` in `f64` once; near a middle between two `f32` the list of `F` has a say.
#[inline]
#[must_use]
pub fn round_doubles<F: Elementary>(x: f32, value: Scaled<f64>) -> f32 {
    /// Bits of an `f64` below those of an `f32`, and how near the middle is near: 2⁻⁴¹ of the value.
    const BELOW: u64 = (1 << 29) - 1;
    const NEAR: u64 = 1 << 11;
    let y = value.m * f64_power_of_two(value.k);
    let from_middle = y.to_bits().wrapping_sub((BELOW >> 1) + 1 - NEAR) & BELOW;
    // A value much smaller than what it is the difference of is not that good.
    let small = SMALLEST_NORMAL.max(f64::from(F::UNCERTAINTY) * f64_power_of_two(33));
    if from_middle <= 2 * NEAR || (y < small && y > -small) {
        let hard = F::HARD.iter().find(|(hard, _)| *hard == x.to_bits());
        if let Some((_, y)) = hard {
            return f32::from_bits(*y);
        }
    }
    y.head()
}

/// 2⁻¹²⁶: below, `f32` has fewer digits and its middles lie elsewhere.
const SMALLEST_NORMAL: f64 = f64_power_of_two(-126);

/// Rounds once, unless the value is within 2⁻³⁸ of itself, and `uncertainty`, of a middle, or subnormal.
#[inline]
#[must_use]
pub fn round_twins(value: Scaled<Twin>, uncertainty: f32) -> Option<f32> {
    let Scaled { m: Twin { hi, lo }, k } = value;
    let doubt = abs(hi) * power_of_two(-38) + uncertainty;
    let y = hi + (lo + doubt);
    if y.to_bits() != (hi + (lo - doubt)).to_bits() {
        return None;
    }
    // In two factors: 2ᵏ itself may be out of range.
    let half = k / 2;
    let y = y * power_of_two(half) * power_of_two(k - half);
    (y.to_bits() & 0x7f80_0000 != 0).then_some(y)
}
