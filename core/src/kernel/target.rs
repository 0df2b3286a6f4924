//! The curve that a spring follows between two frames: a cubic, C¹ across frames.
//!
//! On one step of length `dt`, with `s` from 0 to 1,
//!
//! ```text
//! x̂(s) = q·s³ + a·s² + m₀·s + X₀,    d = X₁ − X₀,   a = 3d − 2m₀ − m₁,   q = m₀ + m₁ − 2d
//! ```
//!
//! Source: Jin et al. 2022, equation 6. Differs from the paper: the default slope at the end is the
//! one-sided `m₁ = d`, so that no frame of look-ahead is needed, and `m₀` is the slope with which the
//! step before ended, kept per second so that steps of unequal length stay C¹.

/// A cubic target over one step, one component.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Target {
    /// Position at the start.
    pub start: f32,
    /// Position at the end.
    pub end: f32,
    /// Slope at the start, per step.
    pub m0: f32,
    /// Slope at the end, per step.
    pub m1: f32,
}

impl Target {
    /// The causal target from `x0` to `x1` in `dt` seconds; `slope` is the slope at the start, per second.
    #[must_use]
    pub fn causal(x0: f32, slope: f32, x1: f32, dt: f32) -> Self {
        Self { start: x0, end: x1, m0: slope * dt, m1: x1 - x0 }
    }

    /// The paper's Catmull-Rom target from `x[1]` to `x[2]` with one frame of look-ahead, steps of equal length.
    #[must_use]
    pub fn catmull_rom(x: [f32; 4]) -> Self {
        Self { start: x[1], end: x[2], m0: 0.5 * (x[2] - x[0]), m1: 0.5 * (x[3] - x[1]) }
    }

    /// Coefficients `(q, a)` of `s³` and `s²`.
    #[must_use]
    pub fn coefficients(&self) -> (f32, f32) {
        let d = self.end - self.start;
        (self.m0 + self.m1 - 2.0 * d, 3.0 * d - 2.0 * self.m0 - self.m1)
    }

    /// Position at `s`.
    #[must_use]
    pub fn position(&self, s: f32) -> f32 {
        let (q, a) = self.coefficients();
        ((q * s + a) * s + self.m0) * s + self.start
    }

    /// Slope at `s`, per step.
    #[must_use]
    pub fn slope(&self, s: f32) -> f32 {
        let (q, a) = self.coefficients();
        (3.0 * q * s + 2.0 * a) * s + self.m0
    }

    /// Second derivative at `s`, per step squared; linear in `s`.
    #[must_use]
    pub fn curvature(&self, s: f32) -> f32 {
        let (q, a) = self.coefficients();
        6.0 * q * s + 2.0 * a
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ends_and_slopes_are_met() {
        for t in [Target::causal(1.0, 3.0, 2.0, 0.5), Target::catmull_rom([0.3, 1.0, -0.5, 0.8])] {
            assert!((t.position(0.0) - t.start).abs() < 1e-6 && (t.position(1.0) - t.end).abs() < 1e-6);
            assert!((t.slope(0.0) - t.m0).abs() < 1e-6 && (t.slope(1.0) - t.m1).abs() < 1e-6);
        }
    }

    #[test]
    fn uniform_motion_is_followed_without_curvature() {
        let t = Target::causal(1.0, 4.0, 1.5, 0.125);
        assert_eq!(t.coefficients(), (0.0, 0.0));
    }
}
