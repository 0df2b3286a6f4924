//! Laws of the spring kernel, over random parameters of the whole promised domain and states of any size.

use proptest::prelude::*;
use sinew::kernel::spring::{Knots, Response, Spring, Step, advance, evaluate};
use sinew::kernel::target::Target;

/// Half an ulp of 1: what a rounded weight may be off.
const ROUNDING: f64 = 6e-8;

/// A spring and a step: `ω·h` from 10⁻⁴ to 2π evenly in the logarithm, or 0; any damping, critical and beside it.
fn springs() -> impl Strategy<Value = (Spring, f32)> {
    let beside = (-20.0..-10.0_f64, any::<bool>())
        .prop_map(|(e, above)| 1.0 + libm::exp(e) * if above { 1.0 } else { -1.0 });
    let zeta =
        prop_oneof![1 => Just(0.0), 1 => Just(1.0), 2 => beside, 6 => (-7.0..7.0_f64).prop_map(libm::exp)];
    damped(zeta)
}

/// [`springs`] of the damping ratios `zeta`.
fn damped(zeta: impl Strategy<Value = f64>) -> impl Strategy<Value = (Spring, f32)> {
    let angle = prop_oneof![1 => Just(0.0), 9 => (-9.2..1.837_f64).prop_map(libm::exp)];
    (angle, zeta, prop_oneof![Just(1.0 / 60.0_f64), 1e-3..0.25_f64]).prop_map(|(angle, zeta, h)| {
        let omega = angle / h;
        let kd = (2.0 * zeta * omega).min(1e4 / h);
        #[allow(clippy::cast_possible_truncation, reason = "parameters of the runtime")]
        (Spring { ks: (omega * omega) as f32, kd: kd as f32 }, h as f32)
    })
}

/// Homogeneous part of a step in the norm of energy, `(√ks·y, u)`; free flight keeps `(y/h, u)`.
fn energy(spring: Spring, y: f64, u: f64) -> f64 {
    u * u + f64::from(spring.ks) * y * y
}

/// One step of the array kernel towards a target that stays where it is.
fn still(spring: Spring, h: f32, y: f32, u: f32) -> (f32, f32) {
    let (mut y, mut v, mut slope) = ([y], [u], [0.0]);
    let zeros = [&[0.0][..]; 2];
    let knots = Knots { x: zeros, f: zeros, y: &mut y, v: &mut v, slope: &mut slope };
    advance(&Step::new(spring, h, 0.0), knots);
    (y[0], v[0])
}

/// A step of length `part` without forcing, of states `(y, h·u)`, in `f64`: of the runtime's rounding only that of the
/// weights is left.
fn propagator(spring: Spring, part: f32, h: f32) -> impl Fn([f64; 2]) -> [f64; 2] {
    let Response { y, u, .. } = Response::new(spring, part);
    let h = f64::from(h);
    let [yy, yu, uy, uu] = [y[0], y[1], u[0], u[1]].map(f64::from);
    move |[y, v]| [yy * y + yu / h * v, h * uy * y + uu * v]
}

/// Size of a state `(y, h·u)`.
fn size(state: [f64; 2]) -> f64 {
    state[0].abs() + state[1].abs()
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 4000, failure_persistence: None, max_global_rejects: 1_000_000, ..ProptestConfig::default() })]

    /// Two parts of a step are the step: `Φ(h₁ + h₂) = Φ(h₂)·Φ(h₁)`, to the rounding of the weights of all three.
    #[test]
    fn parts_of_a_step_compose((spring, h) in springs(), part in 0.01..0.99_f32, y in -1.0..1.0_f64, v in -1.0..1.0_f64) {
        // On the grain of h, so that the two lengths add up exactly: else the law is not about them.
        let begin = (h + part * h) - h;
        let [whole, first, second] = [h, begin, h - begin].map(|part| propagator(spring, part, h));
        let (once, twice) = (whole([y, v]), second(first([y, v])));
        let norm = |map: &dyn Fn([f64; 2]) -> [f64; 2]| size(map([1.0, 0.0])).max(size(map([0.0, 1.0])));
        let bound = ROUNDING * size([y, v]) * (norm(&whole) + 2.0 * norm(&first) * norm(&second));
        prop_assert!(size([once[0] - twice[0], once[1] - twice[1]]) <= bound, "{once:?} {twice:?}");
    }

    /// Without forcing the energy never grows by more than rounding.
    #[test]
    fn energy_never_grows((spring, h) in springs(), y in -1.0..1.0_f32, u in -100.0..100.0_f32) {
        let (y1, u1) = still(spring, h, y, u);
        let (before, after) = (energy(spring, y.into(), u.into()), energy(spring, y1.into(), u1.into()));
        prop_assert!(after <= before * (1.0 + 16.0 * ROUNDING), "{before} {after}");
    }

    /// An undamped spring keeps its energy, to 1e-6 of it a step.
    #[test]
    fn undamped_energy_is_conserved((spring, h) in springs(), y in -1.0..1.0_f32, u in -100.0..100.0_f32) {
        let spring = Spring { kd: 0.0, ..spring };
        let (y1, u1) = still(spring, h, y, u);
        let (before, after) = (energy(spring, y.into(), u.into()), energy(spring, y1.into(), u1.into()));
        prop_assert!((after - before).abs() <= before * 1e-6, "{before} {after}");
    }

    /// Overdamped and released at rest, the offset falls monotonically to 0 and never crosses it.
    #[test]
    fn overdamped_settles_monotonically((spring, h) in damped((0.02..7.0_f64).prop_map(libm::exp)), y in 0.001..1.0_f32) {
        prop_assume!(spring.kd * spring.kd > 4.04 * spring.ks);
        let (mut y, mut u) = (y, 0.0);
        for _ in 0..50 {
            let (y1, u1) = still(spring, h, y, u);
            prop_assert!(y1 <= y && y1 >= -1e-30 && u1 <= 1e-30, "{y} {u} {y1} {u1}");
            (y, u) = (y1, u1);
        }
    }

    /// Twice the state, twice the result, bit for bit; sums to rounding.
    #[test]
    fn the_step_is_linear((spring, h) in springs(), a in prop::array::uniform4(-1.0..1.0_f32), b in prop::array::uniform4(-1.0..1.0_f32)) {
        let r = Response::new(spring, h);
        let apply = |s: [f32; 4]| r.apply(s[0], s[1], s[2], s[3]);
        let (ya, ua) = apply(a);
        let (y2, u2) = apply(a.map(|x| 2.0 * x));
        prop_assert_eq!((2.0 * ya, 2.0 * ua), (y2, u2));
        let (yb, ub) = apply(b);
        let (ys, us) = apply(core::array::from_fn(|i| a[i] + b[i]));
        let size = |w: [f32; 4]| w.iter().map(|x| f64::from(x.abs())).sum::<f64>();
        prop_assert!(f64::from(ya + yb - ys).abs() <= 12.0 * ROUNDING * size(r.y));
        prop_assert!(f64::from(ua + ub - us).abs() <= 12.0 * ROUNDING * size(r.u));
    }

    /// Mirrored, permuted: bit for bit; turned: to rounding. Components know nothing of each other.
    #[test]
    fn the_step_turns_with_its_input((spring, h) in springs(), p in prop::array::uniform5(prop::array::uniform3(-1.0..1.0_f32)), angle in 0.0..core::f64::consts::TAU) {
        let step = Step::new(spring, h, 0.0);
        let run = |[x0, mut y, mut v, x1, f1]: [[f32; 3]; 5]| {
            let (mut slope, x, f) = ([0.0; 3], [&x0[..], &x1], [&[0.0; 3][..], &f1]);
            advance(&step, Knots { x, f, y: &mut y, v: &mut v, slope: &mut slope });
            [y, v]
        };
        let of_each = |map: &dyn Fn([f32; 3]) -> [f32; 3]| (run(p.map(map)), run(p).map(map));
        let (a, b) = of_each(&|q| [-q[0], q[2], q[1]]);
        prop_assert_eq!(a, b);
        let (s, c) = (libm::sin(angle), libm::cos(angle));
        #[allow(clippy::cast_possible_truncation, reason = "a rotation")]
        let turn = |q: [f32; 3]| {
            let [x, y, z] = q.map(f64::from);
            [(c * x - s * y) as f32, (s * x + c * y) as f32, z as f32]
        };
        let (a, b) = of_each(&turn);
        let size = p.as_flattened().iter().fold(0.0_f32, |m, x| m.max(x.abs()));
        let largest = a.as_flattened().iter().chain(b.as_flattened()).fold(size, |m, x| m.max(x.abs()));
        for (a, b) in a.as_flattened().iter().zip(b.as_flattened()) {
            prop_assert!((a - b).abs() <= 2e-6 * largest * (1.0 + 1.0 / h), "{a} {b}");
        }
    }

    /// On its target, moving with it at constant velocity, a spring stays on it: no lag, bit for bit at rest.
    #[test]
    fn constant_motion_has_no_lag((spring, h) in springs(), start in -1.0..1.0_f32, speed in -4.0..4.0_f32) {
        let x1 = start + speed * h;
        let slope = (x1 - start) / h;
        let target = Target::causal(start, slope, x1, h);
        let (y, v) = evaluate(spring, &target, 0.0, slope, [0.0; 2], h, 1.0);
        let omega_h = spring.ks.sqrt() * h;
        prop_assert!(y.abs() <= 4e-7 && ((v - slope) * h).abs() <= 1e-6 * (1.0 + omega_h), "{y} {v} {slope}");
        prop_assert_eq!(still(spring, h, 0.0, 0.0), (0.0, 0.0));
    }
}
