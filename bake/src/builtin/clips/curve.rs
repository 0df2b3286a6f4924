//! Curves of time.

use core::f64::consts::TAU;

/// A sine of `turns` periods.
pub(super) fn wave(turns: f64) -> f64 {
    libm::sin(TAU * turns)
}

/// A cosine of `turns` periods.
pub(super) fn cowave(turns: f64) -> f64 {
    libm::cos(TAU * turns)
}

/// 0 before `low`, 1 after `high`, C² between.
pub(super) fn ramp(low: f64, high: f64, t: f64) -> f64 {
    let t = ((t - low) / (high - low)).clamp(0.0, 1.0);
    t * t * t * (t * (6.0 * t - 15.0) + 10.0)
}

/// 1 at `center`, 0 from `width` on, C² between.
pub(super) fn bump(center: f64, width: f64, t: f64) -> f64 {
    1.0 - ramp(0.0, width, (t - center).abs())
}

/// A periodic curve through `(time, value)`, by Catmull-Rom slopes over uneven times.
pub(super) fn through(keys: &[(f64, f64)], period: f64, t: f64) -> f64 {
    let n = keys.len();
    let key = |k: usize| {
        // `k` counts from one period before the first key.
        let (time, value) = keys[k % n];
        (time + period * (whole(k / n) - 1.0), value)
    };
    let slope = |k: usize| {
        let ((t0, x0), (t1, x1)) = (key(k - 1), key(k + 1));
        (x1 - x0) / (t1 - t0)
    };
    let mut k = 1;
    while k < 2 * n && key(k + 1).0 <= t {
        k += 1;
    }
    hermite((key(k), slope(k)), (key(k + 1), slope(k + 1)), t)
}

/// A point with its slope.
type Knot = ((f64, f64), f64);

/// The cubic between two knots.
pub(super) fn hermite(((t0, x0), m0): Knot, ((t1, x1), m1): Knot, t: f64) -> f64 {
    let h = t1 - t0;
    let s = (t - t0) / h;
    let (s2, s3) = (s * s, s * s * s);
    x0 * (2.0 * s3 - 3.0 * s2 + 1.0)
        + m0 * h * (s3 - 2.0 * s2 + s)
        + x1 * (3.0 * s2 - 2.0 * s3)
        + m1 * h * (s3 - s2)
}

fn whole(k: usize) -> f64 {
    f64::from(u32::try_from(k).unwrap_or(u32::MAX))
}
