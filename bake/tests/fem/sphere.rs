//! The sphere that the Deep Emulator was trained on (Zheng et al. 2021): size, masses, frequency, explicit steps.

use crate::modes::slowest;
use crate::shapes::{nodes, voxels};
use glam::DVec3;
use sinew_bake::fem::assembly::Free;
use sinew_bake::fem::dynamics::{BackwardEuler, Rayleigh, State, explicit_step};
use sinew_bake::fem::element::Elements;
use sinew_bake::fem::energy::stvk::StVenantKirchhoff;
use sinew_bake::fem::mass::Mass;
use sinew_bake::fem::material::Lame;
use sinew_bake::fem::newton::Tolerance;
use sinew_bake::fem::potential::solid::Solid;
use sinew_bake::fem::solver::Method;

/// Voxels of 0.2 that a sphere of radius 1 reaches into; a beam through the middle along y is held.
fn sphere() -> (Vec<DVec3>, Elements<4>, Vec<u32>) {
    let reached = |centre: DVec3| ((centre - DVec3::ONE).abs() - 0.1).max(DVec3::ZERO).length() < 1.0 - 1e-9;
    let (rest, tets) = voxels([10, 10, 10], 0.2, reached);
    let rest: Vec<DVec3> = rest.into_iter().map(|x| x - DVec3::ONE).collect();
    let core = nodes(&rest, |x| x.x.abs() < 0.21 && x.z.abs() < 0.21);
    let tets = Elements::tets(&rest, tets).expect("tetrahedra");
    (rest, tets, core)
}

/// `k_file` is Young's modulus in units where a frame lasts 1e-3 and the density is 1.
const FRAME: f64 = 1e-3;

fn body(tets: &Elements<4>, e: f64) -> Solid<4, StVenantKirchhoff> {
    let material = Lame::new(e, 0.45).expect("a material");
    Solid::new(tets.clone(), StVenantKirchhoff::with_resistance(material, 15_000.0))
}

/// 1,015 nodes, 4,320 tetrahedra, 99 nodes held; the stiffest has its slowest mode at ωh = 1.2646, fitted to the
/// published motions.
#[test]
fn sizes_and_frequency_are_those_of_the_data() {
    let (rest, tets, core) = sphere();
    assert_eq!((rest.len(), tets.len(), core.len()), (1015, 4320, 99));
    let mass = Mass::new(rest.len()).with_tets(&tets, 1.0);
    let (_, square) = slowest(&rest, &Free::new(rest.len(), &core), &body(&tets, 5e6), &mass);
    let w = square.sqrt() * FRAME;
    println!("slowest mode: ωh = {w:.4} a frame");
    assert!((w / 1.2646 - 1.0).abs() < 5e-4, "{w}");
}

/// Where the core is in frame `t` of one burst: 24 frames to speed, 48 to turn round, 24 to rest.
fn burst(t: usize, a: f64) -> f64 {
    let (mut x, mut v) = (0.0, 0.0);
    for frame in 0..t.min(96) {
        v += if (24..72).contains(&frame) { -a } else { a };
        x += v;
    }
    x
}

/// The motions that it was trained on: implicit steps of a whole frame go through them, hard and soft; the hard one has
/// come to rest again 24 frames later.
#[test]
fn implicit_steps_follow_a_burst() {
    let (rest, tets, core) = sphere();
    let mass = Mass::new(rest.len()).with_tets(&tets, 1.0);
    let free = Free::new(rest.len(), &core);
    for (e, frames) in [(5e6, 120), (5e4, 36)] {
        let body = body(&tets, e);
        let mut steps =
            BackwardEuler::new(free.clone(), &[&body], mass.clone(), Rayleigh::default(), Method::DIRECT)
                .expect("memory");
        let mut state = State { x: rest.clone(), v: vec![DVec3::ZERO; rest.len()] };
        let mut away = Vec::new();
        for t in 1..=frames {
            let along = DVec3::new(1.0, 0.3, -0.5) * (burst(t, 0.01) - burst(t - 1, 0.01));
            let mut to: Vec<DVec3> = state.x.iter().zip(&state.v).map(|(x, v)| *x + FRAME * *v).collect();
            core.iter().for_each(|i| to[*i as usize] = state.x[*i as usize] + along);
            let found =
                steps.step(&[&body], &mut state, &to, FRAME, Tolerance { step: 1e-6, iterations: 60 });
            assert!(found.converged, "frame {t}: {found:?}");
            let frame = state.x[core[0] as usize] - rest[core[0] as usize];
            away.push(state.x.iter().zip(&rest).map(|(x, r)| x.distance(*r + frame)).fold(0.0, f64::max));
        }
        let (most, last) = (away.iter().copied().fold(0.0, f64::max), away[frames - 1]);
        println!("E {e}: at most {most:.3}, after {frames} frames {last:.2e}");
        assert!(if frames > 100 { most > 1e-3 && last < 1e-6 } else { most > 0.1 && most < 1.0 });
    }
}

/// The largest speed after a frame by so many explicit steps from a push.
fn explicit(e: f64, steps: usize) -> f64 {
    let (rest, tets, core) = sphere();
    let mass = Mass::new(rest.len()).with_tets(&tets, 1.0).lumped();
    let (body, free) = (body(&tets, e), Free::new(rest.len(), &core));
    let mut state = State { x: rest.clone(), v: vec![DVec3::ZERO; rest.len()] };
    free.node.iter().for_each(|i| state.v[*i as usize] = DVec3::new(0.0, 0.0, 10.0 * rest[*i as usize].x));
    let h = FRAME / steps as f64;
    for _ in 0..12 * steps {
        let to = state.x.clone();
        explicit_step(&free, &[&body], &mass, &mut state, &to, h);
    }
    state.v.iter().map(|v| v.length()).fold(0.0, |most: f64, v| if v.is_nan() { v } else { most.max(v) })
}

/// Explicit steps of a frame explode, a hundred a frame hold (Zheng et al. 2021, section 5).
#[test]
fn explicit_steps_need_a_hundred_a_frame() {
    let one = explicit(5e6, 1);
    let hundred = explicit(5e6, 100);
    println!("speed after 12 frames: {one:e} by one step a frame, {hundred:.2} by a hundred");
    assert!(one > 1e12 || one.is_nan(), "{one}");
    assert!(hundred < 100.0, "{hundred}");
}
