//! How a spring's motion depends on its stiffness and damping: exact, without a tape.
//!
//! A step is linear in the state, `s₁ = M·s₀ + N·α`, with weights that are functions of `a = kd·h` and
//! `b = ks·h²` ([`sinew::kernel::spring`]). Along with the state its derivatives are carried forward,
//!
//! ```text
//! ∂s₁/∂p = M·∂s₀/∂p + (∂M/∂p)·s₀ + (∂N/∂p)·α,     p = ks, kd;    ∂/∂ks = h²·∂/∂b,  ∂/∂kd = h·∂/∂a
//! ```
//!
//! where `∂Ψₖ/∂b = −Θₖ` and `∂Ψₖ/∂a = −Θₖ₋₁` ([`sinew::math::theta`]): no case of the damping is
//! singular. Source: Jin et al. 2022, equations 15 to 20, in another form. In `f64`.

use sinew::math::theta::psi_theta_wide;

/// Weights of `y₀, u₀, α₀, α₁` in `y₁` and in `u₁`.
type Weights = [[f64; 4]; 2];

/// Offset from the target and velocity relative to it, with their derivatives.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Sensitive {
    /// `[y, u]`.
    pub state: [f64; 2],
    /// `∂[y, u]/∂ks`.
    pub by_ks: [f64; 2],
    /// `∂[y, u]/∂kd`.
    pub by_kd: [f64; 2],
}

/// A step of one spring with its derivatives.
#[derive(Clone, Copy, Debug)]
pub struct SensitiveStep {
    weights: Weights,
    by_ks: Weights,
    by_kd: Weights,
}

impl SensitiveStep {
    /// The step of a spring of stiffness `ks ≥ 0`, 1/s², and damping `kd ≥ 0`, 1/s, over `h > 0` seconds.
    ///
    /// # Examples
    ///
    /// From a displacement of 1 a stiffer spring pulls harder:
    ///
    /// ```
    /// use sinew_bake::fit::sensitivity::{Sensitive, SensitiveStep};
    /// let start = Sensitive { state: [1.0, 0.0], ..Sensitive::default() };
    /// let end = SensitiveStep::new(400.0, 4.0, 1.0 / 60.0).advance(&start, [0.0; 2]);
    /// assert!(end.by_ks[0] < 0.0 && end.by_ks[1] < 0.0);
    /// ```
    #[must_use]
    pub fn new(ks: f64, kd: f64, h: f64) -> Self {
        let (a, b) = (kd * h, ks * h * h);
        let ([p0, p1, p2, p3, _], [t, t0, t1, t2, t3]) = psi_theta_wide(a, b);
        let (c, hh) = (b / h, h * h);
        let weights = [[1.0 - b * p2, h * p1, hh * (p2 - p3), hh * p3], [-c * p1, p0, h * (p1 - p2), h * p2]];
        let by_b = [
            [b * t2 - p2, -h * t1, hh * (t3 - t2), -hh * t3],
            [c * t1 - p1 / h, -t0, h * (t2 - t1), -h * t2],
        ];
        let by_a = [[b * t1, -h * t0, hh * (t2 - t1), -hh * t2], [c * t0, -t, h * (t1 - t0), -h * t1]];
        let scaled = |w: Weights, s: f64| w.map(|row| row.map(|x| x * s));
        Self { weights, by_ks: scaled(by_b, hh), by_kd: scaled(by_a, h) }
    }

    /// One step under the accelerations `alpha` at its start and end, of body and target together, per second².
    #[must_use]
    pub fn advance(&self, from: &Sensitive, alpha: [f64; 2]) -> Sensitive {
        let at = [from.state[0], from.state[1], alpha[0], alpha[1]];
        let apply =
            |w: &Weights, v: [f64; 4]| w.map(|row| row.iter().zip(v).map(|(w, v)| w * v).sum::<f64>());
        let carried = |d: [f64; 2], w: &Weights| {
            let (through, own) = (apply(&self.weights, [d[0], d[1], 0.0, 0.0]), apply(w, at));
            [through[0] + own[0], through[1] + own[1]]
        };
        Sensitive {
            state: apply(&self.weights, at),
            by_ks: carried(from.by_ks, &self.by_ks),
            by_kd: carried(from.by_kd, &self.by_kd),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// All regimes: under- and overdamped, soft, stiff, at critical and beside it, without either, and zero.
    const REGIMES: [(f64, f64); 14] = [
        (0.5, 0.2),
        (400.0, 4.0),
        (3000.0, 5.0),
        (400.0, 40.0),
        (400.0, 40.000_001),
        (400.0, 39.999_999),
        (400.0, 40.1),
        (1.0, 100.0),
        (1e4, 1e3),
        (100.0, 0.0),
        (0.0, 7.0),
        (1e-9, 7.0),
        (1e-9, 0.0),
        (0.0, 0.0),
    ];

    /// Forty steps of uneven length along a driven motion.
    fn run(ks: f64, kd: f64) -> Sensitive {
        let mut at = Sensitive { state: [0.03, -0.4], ..Sensitive::default() };
        for i in 0..40_u16 {
            let h = [1.0 / 60.0, 1.0 / 24.0, 1.0 / 144.0][usize::from(i % 3)];
            let alpha = |i: u16| f64::from(i * 7 % 13) - 6.0;
            at = SensitiveStep::new(ks, kd, h).advance(&at, [alpha(i), alpha(i + 1)]);
        }
        at
    }

    #[test]
    fn derivatives_are_the_limits_of_differences() {
        for (ks, kd) in REGIMES {
            let found = run(ks, kd);
            // One-sided at 0, of fourth order: the parameters are not negative.
            let slope = |f: &dyn Fn(f64) -> [f64; 2], at: f64| {
                let d = 1e-3 * at.max(0.05);
                let points = [0.0, 1.0, 2.0, 3.0, 4.0].map(|k: f64| f(at + k * d));
                const W: [f64; 5] = [-25.0 / 12.0, 4.0, -3.0, 4.0 / 3.0, -0.25];
                [0, 1].map(|c| points.iter().zip(W).map(|(p, w)| p[c] * w).sum::<f64>() / d)
            };
            let by_ks = slope(&|ks| run(ks, kd).state, ks);
            let by_kd = slope(&|kd| run(ks, kd).state, kd);
            for c in 0..2 {
                for (found, want) in [(found.by_ks[c], by_ks[c]), (found.by_kd[c], by_kd[c])] {
                    let error = (found - want).abs() / (want.abs() + 1e-4);
                    assert!(error < 1e-6, "ks {ks} kd {kd} component {c}: {found} {want}");
                }
            }
        }
    }

    /// The weights are those of the runtime.
    #[test]
    fn the_step_is_that_of_the_runtime() {
        for (ks, kd) in REGIMES {
            let h = 1.0 / 64.0;
            let ours = SensitiveStep::new(ks, kd, h).weights;
            #[allow(clippy::cast_possible_truncation, reason = "the runtime computes in f32")]
            let spring = sinew::kernel::spring::Spring { ks: ks as f32, kd: kd as f32 };
            #[allow(clippy::cast_possible_truncation, reason = "exact")]
            let theirs = sinew::kernel::spring::Response::new(spring, h as f32);
            for (ours, theirs) in ours.iter().flatten().zip([theirs.y, theirs.u].iter().flatten()) {
                let error = (ours - f64::from(*theirs)).abs();
                assert!(error <= 3e-7 * ours.abs() + 1e-9, "ks {ks} kd {kd}: {ours} {theirs}");
            }
        }
    }
}
