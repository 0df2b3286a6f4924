//! The spring kernel against a 4×4 matrix exponential, in every regime.

use sinew::kernel::spring::{Response, Spring, evaluate};
use sinew::kernel::target::Target;
use sinew_tests::oracle;

/// Stiffness and damping of all regimes: none, soft, stiff, under-, over- and critically damped, beside critical.
const REGIMES: [(f32, f32); 15] = [
    (0.0, 0.0),
    (1e-6, 0.0),
    (0.0, 5.0),
    (0.01, 0.1),
    (1.0, 100.0),
    (1.0, 1.0),
    (100.0, 5.0),
    (100.0, 20.0),
    (400.0, 40.0),
    (400.0, 40.000_1),
    (400.0, 39.999_9),
    (355.0, 11.3),
    (1e4, 10.0),
    (1e6, 1e4),
    (1e4, 1e6),
];

#[test]
fn response_is_the_matrix_exponential() {
    for (ks, kd) in REGIMES {
        for dt in [1e-4_f32, 1.0 / 240.0, 1.0 / 60.0, 1.0 / 24.0, 0.25] {
            if f64::from(ks).sqrt() * f64::from(dt) > core::f64::consts::TAU {
                continue; // beyond the promised domain
            }
            let r = Response::new(Spring { ks, kd }, dt);
            let [wide, h] = [f64::from(ks), f64::from(dt)];
            for start in
                [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0], [0.0, 0.0, 0.0, 1.0]]
            {
                let [y0, u0, a0, a1] = start;
                let want =
                    oracle::spring(wide, f64::from(kd), h, [y0.into(), u0.into()], [a0.into(), a1.into()]);
                let got = r.apply(y0, u0, a0, a1);
                // Against the larger entry of the row, in the units of the row.
                let omega = wide.sqrt().max(1.0 / h);
                let scale = if a0 + a1 > 0.0 {
                    h * h
                } else if u0 > 0.0 {
                    h
                } else {
                    1.0
                };
                let (ey, eu) = (f64::from(got.0) - want[0], f64::from(got.1) - want[1]);
                assert!(
                    ey.abs() <= 2e-6 * scale,
                    "ks {ks} kd {kd} dt {dt} {start:?}: y {} {}",
                    got.0,
                    want[0]
                );
                assert!(
                    eu.abs() <= 4e-6 * scale * omega,
                    "ks {ks} kd {kd} dt {dt} {start:?}: u {} {}",
                    got.1,
                    want[1]
                );
            }
        }
    }
}

/// At any fraction of a step the offset is that of the exact solution.
#[test]
fn sub_frames_are_exact() {
    let dt = 1.0 / 30.0_f32;
    for (ks, kd) in [(0.0, 0.0), (355.0, 11.3), (400.0, 40.0), (1.0, 100.0), (9.0, 0.0)] {
        for target in [Target::causal(0.2, -1.0, 0.23, dt), Target::catmull_rom([0.1, 0.2, -0.05, 0.03])] {
            for s in [0.01_f32, 0.37, 0.5, 0.99, 1.0] {
                let (y, v) = evaluate(Spring { ks, kd }, &target, 0.05, 1.5, [0.4, -0.3], dt, s);
                let (h, step) = (f64::from(dt) * f64::from(s), f64::from(dt));
                let per_step = 1.0 / (step * step);
                let alpha =
                    |s: f32| 0.4 + (-0.3 - 0.4) * f64::from(s) - f64::from(target.curvature(s)) * per_step;
                let start = [0.05, 1.5 - f64::from(target.m0) / step];
                let want = oracle::spring(ks.into(), kd.into(), h, start, [alpha(0.0), alpha(s)]);
                let v_want = want[1] + f64::from(target.slope(s)) / step;
                assert!((f64::from(y) - want[0]).abs() < 1e-6, "{ks} {kd} {s}: {y} {}", want[0]);
                assert!((f64::from(v) - v_want).abs() < 5e-5, "{ks} {kd} {s}: {v} {v_want}");
            }
        }
    }
}

/// Beyond the promised domain results stay finite and do not grow.
#[test]
fn extremes_are_finite_and_passive() {
    for ks in [0.0_f32, 1e-30, 1.0, 1e9, 1e20] {
        for kd in [0.0_f32, 1e-30, 1.0, 1e9, 1e18] {
            for dt in [1e-9_f32, 1e-3, 1.0, 1e3, 1e9] {
                let (y, u) = Response::new(Spring { ks, kd }, dt).apply(1.0, 0.0, 0.0, 0.0);
                assert!(y.is_finite() && u.is_finite(), "ks {ks} kd {kd} dt {dt}: {y} {u}");
                assert!(y.abs() <= 1.001, "ks {ks} kd {kd} dt {dt}: {y}");
            }
        }
    }
}
