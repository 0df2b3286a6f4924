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
use crate::lanes::{F32x4, Lanes};
use crate::math::float::{max, min, sqrt};
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

/// State of springs at a frame, one float a component of a point.
#[derive(Debug)]
pub struct Knots<'a> {
    /// Target `X`, root space.
    pub x: &'a mut [f32],
    /// Offset `y` from the target.
    pub y: &'a mut [f32],
    /// Velocity `v`, not relative to the target, per second.
    pub v: &'a mut [f32],
    /// Slope `σ` of the target, per second.
    pub slope: &'a mut [f32],
    /// Body acceleration `f`, per second squared.
    pub f: &'a mut [f32],
}

/// Advances springs of equal parameters by one step to the target `x1` under the acceleration `f1`.
///
/// # Panics
///
/// If the lengths differ.
pub fn advance(step: &Step, x1: &[f32], f1: &[f32], knots: Knots<'_>) {
    advance_with::<F32x4>(step, x1, f1, knots);
}

/// [`advance`] on a given lane type, so that a test can run the scalar one beside it.
pub(crate) fn advance_with<L: Lanes>(step: &Step, x1: &[f32], f1: &[f32], knots: Knots<'_>) {
    let Knots { x, y, v, slope, f } = knots;
    let n = x1.len();
    let lengths = [f1.len(), x.len(), y.len(), v.len(), slope.len(), f.len()];
    assert!(lengths == [n; 6], "spring: lengths differ");
    let (x1, x1_tail) = x1.as_chunks();
    let (f1, f1_tail) = f1.as_chunks();
    let (x, x_tail) = x.as_chunks_mut();
    let (y, y_tail) = y.as_chunks_mut();
    let (v, v_tail) = v.as_chunks_mut();
    let (slope, slope_tail) = slope.as_chunks_mut();
    let (f, f_tail) = f.as_chunks_mut();
    for i in 0..x1.len() {
        advance_four::<L>(step, &x1[i], &f1[i], [&mut x[i], &mut y[i], &mut v[i], &mut slope[i], &mut f[i]]);
    }
    let tail = x1_tail.len();
    if tail > 0 {
        let pad = |x: &[f32]| core::array::from_fn(|i| x.get(i).copied().unwrap_or(0.0));
        let mut block = [pad(x_tail), pad(y_tail), pad(v_tail), pad(slope_tail), pad(f_tail)];
        let [a, b, c, d, e] = &mut block;
        advance_four::<L>(step, &pad(x1_tail), &pad(f1_tail), [a, b, c, d, e]);
        for (to, from) in [x_tail, y_tail, v_tail, slope_tail, f_tail].into_iter().zip(&block) {
            to.copy_from_slice(&from[..tail]);
        }
    }
}

/// Four components.
#[inline(always)]
fn advance_four<L: Lanes>(step: &Step, x1: &[f32; 4], f1: &[f32; 4], state: [&mut [f32; 4]; 5]) {
    let [x, y, v, slope, f] = state;
    let [dt, inverse] = step.dt.map(L::splat);
    let load = |a: &[f32; 4]| L::from_array(*a);
    let (x1, f1, y0, f0, sigma) = (load(x1), load(f1), load(y), load(f), load(slope));
    let d = x1 - load(x);
    let e = d - sigma * dt;
    let u0 = load(v) - sigma;
    let row = |w: &[f32; 5]| {
        let w = w.map(L::splat);
        ((w[0] * y0 + w[1] * u0) + w[2] * e) + (w[3] * f0 + w[4] * f1)
    };
    let (y1, u1) = (row(&step.y), row(&step.u));
    // A component at rest is set to rest, so that nothing trembles and no subnormal lingers.
    let (zero, [y_rest, u_rest]) = (L::splat(0.0), step.rest.map(L::splat));
    let resting = y1.abs().lt(y_rest) & u1.abs().lt(u_rest);
    let settle = |a: L| L::select(resting, zero, a);
    let sigma = d * inverse;
    *y = settle(y1).to_array();
    *v = (settle(u1) + sigma).to_array();
    *x = x1.to_array();
    *slope = sigma.to_array();
    *f = f1.to_array();
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
            let mut s = [[0.2_f32; 1], [0.05], [1.5], [0.7], [0.3]];
            let [x, y, v, slope, f] = &mut s;
            let target = Target::causal(0.2, 0.7, 0.23, dt);
            let want = evaluate(spring, &target, 0.05, 1.5, [0.3, -0.2], dt, 1.0);
            advance(&Step::new(spring, dt, 0.0), &[0.23], &[-0.2], Knots { x, y, v, slope, f });
            assert!((s[1][0] - want.0).abs() < 1e-6, "ks {ks} kd {kd}: {} {}", s[1][0], want.0);
            assert!((s[2][0] - want.1).abs() < 2e-5, "ks {ks} kd {kd}: {} {}", s[2][0], want.1);
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
        let mut s = [[0.0_f32], [0.0], [0.0], [0.0], [-9.0]];
        for _ in 0..600 {
            let [x, y, v, slope, f] = &mut s;
            advance(&step, &[0.0], &[-9.0], Knots { x, y, v, slope, f });
        }
        assert!((s[1][0] + 9.0 / spring.ks).abs() < 1e-6, "{}", s[1][0]);
    }

    #[test]
    fn lanes_agree_with_scalar_bit_for_bit() {
        use crate::lanes::Scalar;
        let step = Step::new(Spring::new(2.5, 0.3), 1.0 / 90.0, 1e-3);
        for n in 0..67_u16 {
            let wave = |k: u16| -> Vec<f32> { (0..n).map(|i| f32::from(i * k % 17) * 0.01 - 0.08).collect() };
            let (x1, f1) = (wave(3), wave(5));
            let start = || [wave(7), wave(11), wave(13), wave(2), wave(4)];
            let (mut a, mut b) = (start(), start());
            let knots = |s: &mut [Vec<f32>; 5], run: fn(&Step, &[f32], &[f32], Knots<'_>)| {
                let [x, y, v, slope, f] = s;
                run(&step, &x1, &f1, Knots { x, y, v, slope, f });
            };
            knots(&mut a, advance_with::<F32x4>);
            knots(&mut b, advance_with::<Scalar>);
            let bits = |s: &[Vec<f32>; 5]| s.concat().iter().map(|x| x.to_bits()).collect::<Vec<_>>();
            assert_eq!(bits(&a), bits(&b), "{n} components");
        }
    }
}
