//! A zero-rest-length spring on a moving target, exact over a step of any length.
//!
//! With `y = x − x̂` the offset from the target and `u = x′ − x̂′` the relative velocity,
//!
//! ```text
//! y″ + kd·y′ + ks·y = α(t),    α = f − x̂″     linear over the step (f: body acceleration)
//!
//! y₁ = (1 − b·Ψ₂)·y₀ + h·Ψ₁·u₀ + h²·((Ψ₂ − Ψ₃)·α₀ + Ψ₃·α₁)      a = kd·h,  b = ks·h²
//! u₁ =  −ks·h·Ψ₁·y₀  +   Ψ₀·u₀ + h ·((Ψ₁ − Ψ₂)·α₀ + Ψ₂·α₁)
//! ```
//!
//! Source: Jin et al. 2022, equations 3 and 7 to 13, rewritten with the entire functions of
//! [`crate::math::psi`]: no case of the damping is special. Invariant: the determinant of the
//! homogeneous part is `e⁻ᵃ`. Limits: `h → 0` is the identity; `ks = kd = 0` is free flight.
//!
//! Along a causal target ([`crate::kernel::target`]) with slope `σ₀` (per second) and
//! `e = (X₁ − X₀) − σ₀·h` the curvature is `x̂″·h² = 4e` at the start and `−2e` at the end.

use super::target::Target;
use super::tiny::flush_all;
use crate::dispatch;
use crate::lanes::VECTORS;
use crate::math::float::{abs, max, min, sqrt};
use crate::math::psi::{cut, psi_wide};
use crate::math::twin::Twin;
use crate::math::wide::Wide;

/// Parameters of a spring, per unit mass.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spring {
    /// Stiffness `ks = ω²`, 1/s², not negative.
    pub ks: f32,
    /// Damping `kd = 2ζω`, 1/s, not negative.
    pub kd: f32,
}

impl Spring {
    /// A spring of `frequency` Hz and damping ratio `zeta` (1 is critical).
    #[must_use]
    pub fn new(frequency: f32, zeta: f32) -> Self {
        let omega = core::f32::consts::TAU * frequency;
        Self { ks: omega * omega, kd: 2.0 * zeta * omega }
    }
}

/// The linear map of one step from `(y₀, u₀, α₀, α₁)` to `(y₁, u₁)`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Response {
    /// Weights of `y₀, u₀, α₀, α₁` in `y₁`.
    pub y: [f32; 4],
    /// Weights of `y₀, u₀, α₀, α₁` in `u₁`.
    pub u: [f32; 4],
}

impl Response {
    /// The response of `spring` over `h` seconds, `0 ≤ h ≤ 10¹⁵`.
    #[must_use]
    pub fn new(spring: Spring, h: f32) -> Self {
        // Products far beyond any domain are kept finite.
        let (kd, ks) = (min(spring.kd, 1e30 / h), min(spring.ks, 1e30 / (h * h)));
        let stiffness = ks * h * h;
        let [h, ks, kd] = [h, ks, kd].map(Twin::new);
        let (a, b, _) = cut(kd * h, ks * h * h);
        // A spring too stiff for the step counts as the stiffest that is not.
        let ks = if b.hi < stiffness { b / (h * h) } else { ks };
        let [p0, p1, p2, p3, _] = psi_wide(a, b);
        let hh = h * h;
        Self {
            y: [Twin::new(1.0) - b * p2, h * p1, hh * (p2 - p3), hh * p3].map(Wide::head),
            u: [-(ks * h * p1), p0, h * (p1 - p2), h * p2].map(Wide::head),
        }
    }

    /// Applies the map to one component.
    #[must_use]
    pub fn apply(&self, y0: f32, u0: f32, a0: f32, a1: f32) -> (f32, f32) {
        let row = |r: &[f32; 4]| (r[0] * y0 + r[1] * u0) + (r[2] * a0 + r[3] * a1);
        (row(&self.y), row(&self.u))
    }
}

/// Offset and velocity `(x − x̂(s), x′)` at the fraction `s` of a step of `dt` seconds along any cubic target.
///
/// `y0` is the offset at the start, `v0` the velocity (not relative to the target), `f` the body
/// acceleration at both ends. The readable form of [`advance`], and the one for sub-frames.
///
/// # Examples
///
/// A spring without stiffness and damping flies freely, whatever the target does:
///
/// ```
/// use sinew::kernel::{spring::{evaluate, Spring}, target::Target};
/// let target = Target::catmull_rom([0.1, 0.2, -0.05, 0.03]);
/// let (y, v) = evaluate(Spring { ks: 0.0, kd: 0.0 }, &target, 0.25 - 0.2, 1.5, [0.0; 2], 1.0 / 60.0, 1.0);
/// assert!((target.position(1.0) + y - 0.275).abs() < 1e-7 && (v - 1.5).abs() < 1e-6);
/// ```
#[must_use]
pub fn evaluate(
    spring: Spring,
    target: &Target,
    y0: f32,
    v0: f32,
    f: [f32; 2],
    dt: f32,
    s: f32,
) -> (f32, f32) {
    let per_step = 1.0 / (dt * dt);
    let alpha = |s: f32| (f[0] + (f[1] - f[0]) * s) - target.curvature(s) * per_step;
    let response = Response::new(spring, s * dt);
    let (y, u) = response.apply(y0, v0 - target.m0 / dt, alpha(0.0), alpha(s));
    (y, u + target.slope(s) / dt)
}

/// Weights of a step along a causal target: of `y₀, u₀, e, f₀, f₁`, with what decides rest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Step {
    /// Step, s, and its inverse.
    dt: [f32; 2],
    /// Weights in `y₁`.
    y: [f32; 5],
    /// Weights in `u₁`.
    u: [f32; 5],
    /// Offset and relative velocity below which a component is at rest.
    rest: [f32; 2],
}

impl Step {
    /// Weights of `spring` over `dt` seconds, `dt > 0`; `rest` is the offset that counts as none.
    #[must_use]
    pub fn new(spring: Spring, dt: f32, rest: f32) -> Self {
        let Response { y, u } = Response::new(spring, dt);
        let inverse = 1.0 / dt;
        // α₀ = f₀ − 4e/dt², α₁ = f₁ + 2e/dt²
        let bend = |w: [f32; 4]| (2.0 * w[3] - 4.0 * w[2]) * inverse * inverse;
        Self {
            dt: [dt, inverse],
            y: flush_all([y[0], y[1], bend(y), y[2], y[3]]),
            u: flush_all([u[0], u[1], bend(u), u[2], u[3]]),
            rest: [rest, rest * max(sqrt(spring.ks), 1.0)],
        }
    }
}

/// Springs between two frames, one float a component of a point. The shortest slice decides how many there are.
#[derive(Debug)]
pub struct Knots<'a> {
    /// Targets `X₀` and `X₁`, root space.
    pub x: [&'a [f32]; 2],
    /// Body accelerations `f₀` and `f₁`, per second squared.
    pub f: [&'a [f32]; 2],
    /// Offset `y` from the target: `y₀` goes in, `y₁` comes out.
    pub y: &'a mut [f32],
    /// Velocity `v`, not relative to the target, per second.
    pub v: &'a mut [f32],
    /// Slope `σ` of the target, per second.
    pub slope: &'a mut [f32],
}

/// Advances springs of equal parameters by one step.
pub fn advance(step: &Step, knots: Knots<'_>) {
    let Knots { x: [x0, x1], f: [f0, f1], y, v, slope } = knots;
    advance_at(dispatch::widest(), step, x0, x1, f0, f1, y, v, slope);
}

dispatch::copies!(advance_at, advance_any, (
    step: &Step, x0: &[f32], x1: &[f32], f0: &[f32], f1: &[f32], y: &mut [f32], v: &mut [f32], slope: &mut [f32],
));

/// The body of each copy of [`advance`]: `x₀, x₁, f₀, f₁` go in, `y, v, σ` through.
///
/// Components know nothing of each other, so the compiler takes as many at a time as a register holds.
#[inline(always)]
#[allow(clippy::too_many_arguments, reason = "only as arguments they are known not to overlap")]
fn advance_any(
    step: &Step,
    x0: &[f32],
    x1: &[f32],
    f0: &[f32],
    f1: &[f32],
    y: &mut [f32],
    v: &mut [f32],
    slope: &mut [f32],
) {
    let Step { dt: [dt, inverse], y: wy, u: wu, rest: [y_rest, u_rest] } = *step;
    let row = |w: [f32; 5], y0, u0, e, f0, f1| ((w[0] * y0 + w[1] * u0) + w[2] * e) + (w[3] * f0 + w[4] * f1);
    let given = x0.iter().zip(x1).zip(f0.iter().zip(f1));
    for (((x0, x1), (f0, f1)), ((y, v), slope)) in given.zip(y.iter_mut().zip(v).zip(slope)) {
        let d = x1 - x0;
        let e = d - *slope * dt;
        let (y0, u0) = (*y, *v - *slope);
        let (y1, u1) = (row(wy, y0, u0, e, f0, f1), row(wu, y0, u0, e, f0, f1));
        // A component at rest is set to rest, so that nothing trembles and no subnormal lingers.
        let (slow, near) = (abs(u1) < u_rest, abs(y1) < y_rest);
        // A branch keeps a loop from vectors; without them it is shorter.
        let resting = if VECTORS { near & slow } else { near && slow };
        *slope = d * inverse;
        *y = if resting { 0.0 } else { y1 };
        *v = if resting { 0.0 } else { u1 } + *slope;
    }
}

#[cfg(test)]
mod tests {
    extern crate std;
    use super::*;
    use std::vec::Vec;

    /// Step vectors of the derivation, 9 digits by a matrix exponential: `(dt, ks, kd) -> (x, v)`.
    #[test]
    fn published_steps_hold() {
        let target = Target::catmull_rom([0.1, 0.2, -0.05, 0.03]);
        for (dt, ks, kd, x, v) in [
            (1.0 / 60.0, 100.0, 5.0, 0.262_090_543_673_987_4, -0.114_940_433_595_424_72),
            (1.0 / 24.0, 400.0, 40.0, 0.122_978_603_355_088_83, -5.748_537_763_124_74),
            (1.0 / 60.0, 0.0, 0.0, 0.275, 1.5),
        ] {
            let (y1, v1) = evaluate(Spring { ks, kd }, &target, 0.25 - 0.2, 1.5, [0.0; 2], dt, 1.0);
            let x1: f64 = f64::from(target.end + y1);
            assert!((x1 - x).abs() < 1e-7 && (f64::from(v1) - v).abs() < 4e-6, "{ks} {kd}: {x1} {v1}");
        }
    }

    /// The array kernel is the readable form, to rounding, in every regime.
    #[test]
    fn advance_agrees_with_evaluate() {
        for (ks, kd) in [(0.0, 0.0), (400.0, 4.0), (400.0, 40.0), (1.0, 100.0), (1e6, 1e4), (1e-6, 0.0)] {
            let (spring, dt) = (Spring { ks, kd }, 1.0 / 60.0);
            let (mut y, mut v, mut slope) = ([0.05], [1.5], [0.7]);
            let target = Target::causal(0.2, 0.7, 0.23, dt);
            let want = evaluate(spring, &target, 0.05, 1.5, [0.3, -0.2], dt, 1.0);
            let (x, f): ([&[f32]; 2], [&[f32]; 2]) = ([&[0.2], &[0.23]], [&[0.3], &[-0.2]]);
            advance(&Step::new(spring, dt, 0.0), Knots { x, f, y: &mut y, v: &mut v, slope: &mut slope });
            assert!((y[0] - want.0).abs() < 1e-6, "ks {ks} kd {kd}: {} {}", y[0], want.0);
            assert!((v[0] - want.1).abs() < 2e-5, "ks {ks} kd {kd}: {} {}", v[0], want.1);
        }
    }

    /// Semigroup law: two parts of a step are the step, at any split.
    #[test]
    fn parts_compose() {
        let target = Target::causal(0.2, -3.0, 0.26, 0.04);
        for (ks, kd) in [(355.0, 11.0), (400.0, 40.0), (9.0, 60.0), (0.0, 3.0), (0.0, 0.0)] {
            let spring = Spring { ks, kd };
            for s in [0.1_f32, 0.5, 0.9] {
                let (y, v) = evaluate(spring, &target, 0.1, -1.0, [0.0; 2], 0.04, s);
                let dt = 0.04 * (1.0 - s);
                let rest = Target {
                    start: target.position(s),
                    end: target.end,
                    m0: target.slope(s) * (1.0 - s),
                    m1: target.m1 * (1.0 - s),
                };
                let (y1, v1) = evaluate(spring, &rest, y, v, [0.0; 2], dt, 1.0);
                let (y2, v2) = evaluate(spring, &target, 0.1, -1.0, [0.0; 2], 0.04, 1.0);
                assert!(
                    (y1 - y2).abs() < 1e-6 && (v1 - v2).abs() < 5e-5,
                    "{ks} {kd} {s}: {y1} {y2} {v1} {v2}"
                );
            }
        }
    }

    /// Constant acceleration `g` on a still target settles at `g/ks`.
    #[test]
    fn gravity_sags_by_g_over_ks() {
        let spring = Spring::new(2.0, 0.4);
        let step = Step::new(spring, 1.0 / 60.0, 0.0);
        let (mut y, mut v, mut slope) = ([0.0], [0.0], [0.0]);
        for _ in 0..600 {
            let (x, f) = ([&[0.0][..]; 2], [&[-9.0][..]; 2]);
            advance(&step, Knots { x, f, y: &mut y, v: &mut v, slope: &mut slope });
        }
        assert!((y[0] + 9.0 / spring.ks).abs() < 1e-6, "{}", y[0]);
    }

    /// Every length and alignment: each copy that this machine can run gives the bits of one component at a time.
    #[test]
    fn copies_agree_with_one_at_a_time() {
        let step = Step::new(Spring::new(2.5, 0.3), 1.0 / 90.0, 1e-3);
        // An interpreter takes its time.
        let stride = if cfg!(miri) { 7 } else { 1 };
        for n in (0..67).step_by(stride) {
            for offset in (0..16).step_by(stride) {
                let wave = |k: u16| -> Vec<f32> {
                    (0..n + offset).map(|i| f32::from(i * k % 17) * 0.01 - 0.08).collect()
                };
                let given = [3, 5, 6, 12].map(wave);
                let given = [0, 1, 2, 3].map(|k| &given[k][usize::from(offset)..]);
                let [x0, x1, f0, f1] = given;
                let start = [7, 11, 13].map(wave);
                let mut want = start.clone();
                for i in 0..usize::from(n) {
                    let [y, v, slope] = &mut want;
                    let at = i + usize::from(offset);
                    let one = |v: &mut Vec<f32>| core::array::from_fn::<_, 1, _>(|_| v[at]);
                    let [x0, x1, f0, f1] = given.map(|g| &g[i..=i]);
                    let (mut y1, mut v1, mut slope1) = (one(y), one(v), one(slope));
                    advance_any(&step, x0, x1, f0, f1, &mut y1, &mut v1, &mut slope1);
                    [y[at], v[at], slope[at]] = [y1[0], v1[0], slope1[0]];
                }
                let bits = |s: &[Vec<f32>; 3]| s.concat().iter().map(|x| x.to_bits()).collect::<Vec<_>>();
                for level in dispatch::levels() {
                    let mut found = start.clone();
                    let [y, v, slope] = found.each_mut().map(|s| &mut s[usize::from(offset)..]);
                    advance_at(level, &step, x0, x1, f0, f1, y, v, slope);
                    assert_eq!(bits(&found), bits(&want), "{level:?}: {n} components, {offset} off");
                }
            }
        }
    }
}
