//! What IEEE 754 leaves open or `core` does not have: square root, magnitude, smaller and larger.

/// Square root, correctly rounded.
#[inline(always)]
#[must_use]
pub fn sqrt(x: f32) -> f32 {
    #[cfg(feature = "std")]
    {
        x.sqrt()
    }
    // Without `std` Rust has no name for the instruction, and `libm` computes the root in software.
    #[cfg(all(not(feature = "std"), target_arch = "arm", target_abi = "eabihf"))]
    {
        crate::dispatch::sqrt(x)
    }
    #[cfg(all(not(feature = "std"), not(all(target_arch = "arm", target_abi = "eabihf"))))]
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_second_is_taken_when_in_doubt() {
        for f in [min, max] {
            assert_eq!(f(0.0, -0.0).to_bits(), (-0.0_f32).to_bits(), "equal");
            assert_eq!(f(f32::NAN, 1.0), 1.0, "NaN");
        }
        assert_eq!([clamp(-2.0, -1.0, 1.0), clamp(0.5, -1.0, 1.0), clamp(2.0, -1.0, 1.0)], [-1.0, 0.5, 1.0]);
    }

    #[test]
    fn horner_takes_the_highest_power_first() {
        assert_eq!(horner(&[2.0, 3.0, 4.0], 10.0), 234.0);
    }
}
