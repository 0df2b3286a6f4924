//! Motion in time: free flight, decay of modes, explicit steps.

use crate::modes::slowest;
use crate::shapes::{block, fat, nodes, noise};
use glam::{DMat3, DVec3};
use sinew_bake::fem::assembly::Free;
use sinew_bake::fem::dynamics::{BackwardEuler, Rayleigh, State};
use sinew_bake::fem::energy::{corotated::Corotated, neo_hookean::NeoHookean};
use sinew_bake::fem::mass::Mass;
use sinew_bake::fem::newton::Tolerance;
use sinew_bake::fem::potential::solid::Solid;
use sinew_bake::fem::solver::Method;

const TIGHT: Tolerance = Tolerance { step: 1e-11, iterations: 50 };

/// Nothing holds it: linear momentum stays, and so does angular momentum but for what backward Euler loses of the
/// rotation itself, here at rest on average.
#[test]
fn momentum_is_kept_in_free_flight() {
    let (rest, tets) = block([3, 2, 2], 0.1);
    let mass = Mass::new(rest.len()).with_tets(&tets, 1000.0);
    let body = Solid::new(tets, NeoHookean::new(fat()));
    let mut noise = noise(5);
    let v: Vec<DVec3> = rest.iter().map(|_| DVec3::new(1.0 + noise(), noise(), 2.0 * noise())).collect();
    let mut state = State { x: rest.clone(), v };
    let momentum = |s: &State| mass.times(&s.v).into_iter().sum::<DVec3>();
    let before = momentum(&state);
    let free = Free::new(rest.len(), &[]);
    let mut steps = BackwardEuler::new(free, &[&body], mass.clone(), Rayleigh::default(), Method::DIRECT)
        .expect("memory");
    for _ in 0..60 {
        let to: Vec<DVec3> = state.x.iter().zip(&state.v).map(|(x, v)| *x + *v / 60.0).collect();
        let found = steps.step(&[&body], &mut state, &to, 1.0 / 60.0, TIGHT);
        assert!(found.converged, "{found:?}");
    }
    let off = momentum(&state).distance(before) / before.length();
    assert!(off < 1e-9, "{off}");
}

/// Backward Euler shrinks a mode by `1/√(1 + w²)` a step and turns it by `atan w`, `w = ωh`.
#[test]
fn a_mode_decays_as_it_must() {
    let (rest, tets) = block([8, 2, 3], 0.1);
    let mass = Mass::new(rest.len()).with_tets(&tets, 1000.0);
    let body = Solid::new(tets, Corotated::new(fat()));
    let free = Free::new(rest.len(), &nodes(&rest, |x| x.x < 1e-9));
    let (mode, square) = slowest(&rest, &free, &body, &mass);
    let h = 0.4 / square.sqrt();
    let w = square.sqrt() * h;
    // So small that the body is linear.
    let amplitude = 1e-7;
    let x = rest.iter().zip(&mode).map(|(x, m)| *x + amplitude * *m).collect();
    let mut state = State { x, v: vec![DVec3::ZERO; rest.len()] };
    let mut steps = BackwardEuler::new(free, &[&body], mass.clone(), Rayleigh::default(), Method::DIRECT)
        .expect("memory");
    let tolerance = Tolerance { step: 1e-15, iterations: 4 };
    let weighed = mass.times(&mode);
    let along = |v: &[DVec3]| v.iter().zip(&weighed).map(|(v, m)| v.dot(*m)).sum::<f64>();
    let away = |x: &[DVec3]| x.iter().zip(&rest).map(|(x, r)| *x - *r).collect::<Vec<_>>();
    let state_of = |s: &State| (along(&away(&s.x)), along(&s.v) / square.sqrt());
    let mut before = state_of(&state);
    for _ in 0..10 {
        let to = state.x.clone();
        steps.step(&[&body], &mut state, &to, h, tolerance);
        let after = state_of(&state);
        let shrunk = after.0.hypot(after.1) / before.0.hypot(before.1);
        let angle = |(q, p): (f64, f64)| libm::atan2(p, q);
        let turned = (angle(before) - angle(after)).rem_euclid(core::f64::consts::TAU);
        assert!((shrunk * (1.0 + w * w).sqrt() - 1.0).abs() < 1e-5, "{shrunk}");
        assert!((turned - libm::atan(w)).abs() < 1e-5, "{turned} {}", libm::atan(w));
        before = after;
    }
}

/// Rayleigh's: a falling body without stiffness slows down by `1/(1 + αh)` a step; a mode's decay has βω² beside it.
#[test]
fn damping_is_what_was_asked_for() {
    let (rest, tets) = block([4, 2, 3], 0.1);
    let mass = Mass::new(rest.len()).with_tets(&tets, 1000.0);
    let body = Solid::new(tets, Corotated::new(fat()));
    let free = Free::new(rest.len(), &nodes(&rest, |x| x.x < 1e-9));
    let (mode, square) = slowest(&rest, &free, &body, &mass);
    let (h, alpha, beta) = (0.3 / square.sqrt(), 0.2 * square.sqrt(), 0.5 / square.sqrt());
    let damping = Rayleigh { mass: alpha, stiffness: beta };
    let mut steps =
        BackwardEuler::new(free, &[&body], mass.clone(), damping, Method::DIRECT).expect("memory");
    let (q, p) = (1e-7, 2e-7 * square.sqrt());
    let x = rest.iter().zip(&mode).map(|(x, m)| *x + q * *m).collect();
    let mut state = State { x, v: mode.iter().map(|m| p * *m).collect() };
    let to = state.x.clone();
    steps.step(&[&body], &mut state, &to, h, Tolerance { step: 1e-15, iterations: 4 });
    // v'(1 + h(α + βω²) + h²ω²) = v − hω² q
    let want = (p - h * square * q) / (1.0 + h * (alpha + beta * square) + h * h * square);
    let weighed = mass.times(&mode);
    let found: f64 = state.v.iter().zip(&weighed).map(|(v, m)| v.dot(*m)).sum();
    assert!((found / want - 1.0).abs() < 1e-5, "{found} {want}");
}

/// Turned about, the same motion, turned about.
#[test]
fn motion_does_not_know_north() {
    let (rest, tets) = block([3, 2, 2], 0.1);
    let turn = DMat3::from_axis_angle(DVec3::new(0.6, 0.0, 0.8), 1.0);
    let mass = Mass::new(rest.len()).with_tets(&tets, 1000.0);
    let run = |turn: DMat3| {
        let rest: Vec<DVec3> = rest.iter().map(|x| turn * *x).collect();
        let tets = sinew_bake::fem::element::Elements::tets(&rest, tets.nodes.clone()).expect("tetrahedra");
        let body = Solid::new(tets, NeoHookean::new(fat()));
        let free = Free::new(rest.len(), &[0, 1]);
        let mut steps = BackwardEuler::new(free, &[&body], mass.clone(), Rayleigh::default(), Method::DIRECT)
            .expect("memory");
        let mut noise = noise(9);
        let v = rest.iter().map(|_| turn * DVec3::new(noise(), noise(), noise())).collect();
        let mut state = State { x: rest, v };
        for _ in 0..10 {
            let to = state.x.clone();
            let found = steps.step(&[&body], &mut state, &to, 1.0 / 60.0, TIGHT);
            assert!(found.converged, "{found:?}");
        }
        state.x
    };
    let (straight, turned) = (run(DMat3::IDENTITY), run(turn));
    for (a, b) in straight.iter().zip(&turned) {
        assert!((turn * *a).distance(*b) < 1e-9, "{a} {b}");
    }
}
