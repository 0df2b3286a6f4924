//! Floats to int8 and back: `q = round(x/s)`, ties to even, saturated at ±127; NaN is 0.

/// Largest magnitude of a quantised number. −128 is left out, so that scales are symmetric.
pub const LARGEST: f32 = 127.0;

/// 1.5·2²³: added to `|v| ≤ 127` it leaves the nearest integer, ties to even, in the lowest bits.
const TO_INTEGER: f32 = 12_582_912.0;

/// Nearest integer to `v`, within ±127; 0 for NaN.
#[inline(always)]
#[must_use]
pub fn nearest(v: f32) -> i8 {
    let v = if v < LARGEST { v } else { LARGEST };
    // A NaN failed the comparison above and must not count as the largest: it differs from itself.
    #[allow(clippy::cast_possible_truncation, reason = "the lowest byte")]
    let byte = |v: f32| (v + TO_INTEGER).to_bits() as i8;
    byte(if v > -LARGEST { v } else { -LARGEST })
}

/// Quantises `x` with the scale `1/inverse_scale`, dimensionless; the shorter of the two slices decides.
#[inline(always)]
pub fn quantize(x: &[f32], inverse_scale: f32, q: &mut [i8]) {
    for (q, x) in q.iter_mut().zip(x) {
        *q = if x.is_nan() { 0 } else { nearest(x * inverse_scale) };
    }
}

/// The scale under which the largest of `x` becomes 127; 1 where all are 0. Infinities and NaN do not count.
#[inline(always)]
#[must_use]
pub fn scale_of(x: &[f32]) -> f32 {
    let mut largest = 0.0;
    for x in x {
        let a = crate::math::float::abs(*x);
        if a > largest && a < f32::INFINITY {
            largest = a;
        }
    }
    // Below, the inverse would overflow.
    if largest > 1e-30 { largest / LARGEST } else { 1.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// All 2³² inputs in an optimized build, else every 4,099th, by the definition in `f64`.
    #[test]
    fn exhaustive_rounding_is_to_nearest_even_and_saturates() {
        let step = if cfg!(debug_assertions) { 4099 } else { 1 };
        for bits in (0..=u32::MAX).step_by(step) {
            let x = f32::from_bits(bits);
            let mut q = [0];
            quantize(&[x], 1.0, &mut q);
            let limited = f64::from(x).clamp(-127.0, 127.0);
            let want = if x.is_nan() { 0.0 } else { libm::rint(limited) };
            assert_eq!(f64::from(q[0]), want, "{x:e} {bits:#x}");
        }
    }

    #[test]
    fn halves_and_their_neighbors_round_as_they_should() {
        for n in -127_i8..127 {
            let half = f32::from(n) + 0.5;
            let even = if n % 2 == 0 { n } else { n + 1 };
            let [below, at, above] = [half.next_down(), half, half.next_up()].map(nearest);
            assert_eq!((below, at, above), (n, even, n + 1), "{half}");
        }
    }

    #[test]
    fn the_scale_takes_the_largest_finite() {
        assert_eq!(scale_of(&[-12.7, 3.0, f32::NAN, f32::INFINITY]), 12.7 / 127.0);
        assert_eq!(scale_of(&[0.0, -1e-38]), 1.0);
        assert_eq!(scale_of(&[]), 1.0);
    }
}
