//! What takes linear solves alone: the Poisson system, projective dynamics, co-rotated elasticity in given frames.

use crate::shapes::{block, fat, nodes, noise, prism_block};
use glam::{DMat3, DVec3};
use sinew_bake::builtin;
use sinew_bake::cage::layers::{Layers, Settings};
use sinew_bake::fem::assembly::Free;
use sinew_bake::fem::element::Elements;
use sinew_bake::fem::energy::arap::Arap;
use sinew_bake::fem::energy::corotated::Corotated;
use sinew_bake::fem::newton::{Newton, Tolerance};
use sinew_bake::fem::poisson::Poisson;
use sinew_bake::fem::potential::{Potential, solid::Solid, warped::Warped};
use sinew_bake::fem::projective::Projective;
use sinew_bake::fem::solver::Method;

/// A turn that grows along the body, a bend, and waves: nothing that an element could hold exactly, folds aside.
fn bent(x: DVec3) -> DVec3 {
    let turn = DMat3::from_rotation_y(2.0 * x.y) * DMat3::from_rotation_z(1.5 * x.x);
    turn * (x + 0.03 * DVec3::new(libm::sin(9.0 * x.y), libm::sin(7.0 * x.z), libm::sin(8.0 * x.x)))
}

/// How far from `bent` the nodes end, body sizes, that begin at rest with the fixed ones in their place.
fn recovered<const N: usize>(name: &str, rest: &[DVec3], elements: &Elements<N>, fixed: &[u32]) -> f64 {
    let truth: Vec<DVec3> = rest.iter().map(|x| bent(*x)).collect();
    let targets: Vec<DMat3> = (0..elements.len()).map(|e| elements.deformation(e, &truth)).collect();
    let mut x = rest.to_vec();
    fixed.iter().for_each(|i| x[*i as usize] = truth[*i as usize]);
    let before = apart(&x, &truth);
    Poisson::new(elements, Free::new(rest.len(), fixed)).expect("a factor").recover(&targets, &mut x);
    let size = apart(rest, &vec![rest[0]; rest.len()]);
    let error = apart(&x, &truth) / size;
    println!("{name}: {error:.1e} body sizes from {:.2}", before / size);
    assert!(before / size > 0.1, "{name}: it was far before");
    error
}

fn apart(a: &[DVec3], b: &[DVec3]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max)
}

#[test]
fn a_deformation_is_recovered_from_its_gradients() {
    let (rest, tets) = block([12, 6, 5], 0.1);
    assert!(recovered("tetrahedra", &rest, &tets, &nodes(&rest, |x| x.x < 1e-9)) < 1e-6);
    let (rest, prisms) = prism_block([10, 4, 6], 0.1);
    assert!(recovered("prisms", &rest, &prisms, &nodes(&rest, |x| x.y < 1e-9)) < 1e-6);
    let layers = Layers::new(&builtin::character(), &Settings::default()).expect("layers");
    let prisms = Elements::prisms(&layers.rest, layers.prisms.clone()).expect("prisms");
    let mut free = vec![false; layers.rest.len()];
    layers.prisms.iter().flatten().for_each(|i| free[*i as usize] = !layers.fixed[*i as usize]);
    let fixed: Vec<u32> = (0..).zip(&free).filter(|(_, free)| !**free).map(|(i, _)| i).collect();
    assert!(recovered("layers of Plum", &layers.rest, &prisms, &fixed) < 1e-6);
}

#[test]
fn gradients_of_no_map_are_met_in_the_mean_of_squares() {
    let (rest, tets) = block([4, 3, 3], 0.1);
    let fixed = nodes(&rest, |x| x.x < 1e-9);
    let mut noise = noise(5);
    let targets: Vec<DMat3> =
        (0..tets.len()).map(|_| DMat3::from_cols_array(&core::array::from_fn(|_| noise()))).collect();
    let mut x = rest.clone();
    Poisson::new(&tets, Free::new(rest.len(), &fixed)).expect("a factor").recover(&targets, &mut x);
    let error = |x: &[DVec3]| -> f64 {
        let of = |e: usize| {
            let off = (tets.deformation(e, x) - targets[e]).to_cols_array();
            tets.volumes[e] * off.iter().map(|o| o * o).sum::<f64>()
        };
        (0..tets.len()).map(of).sum()
    };
    let least = error(&x);
    for i in (0..rest.len()).filter(|i| !fixed.contains(&u32::try_from(*i).expect("few"))) {
        for step in [DVec3::X, DVec3::Y, DVec3::Z, -DVec3::X, -DVec3::Y, -DVec3::Z] {
            x[i] += 1e-4 * step;
            assert!(error(&x) > least, "node {i} would rather go {step}");
            x[i] -= 1e-4 * step;
        }
    }
}

/// A bar, its left end fixed, the right one turned by half a right angle and pulled.
fn pulled() -> (Vec<DVec3>, Elements<4>, Vec<u32>, Vec<DVec3>) {
    let (rest, tets) = block([8, 2, 2], 0.1);
    let fixed = nodes(&rest, |x| x.x < 1e-9 || x.x > 0.8 - 1e-9);
    let turn = DMat3::from_rotation_x(core::f64::consts::FRAC_PI_4);
    let start = rest.iter().map(|x| if x.x > 0.7 { turn * *x + 0.1 * DVec3::X } else { *x }).collect();
    (rest, tets, fixed, start)
}

/// Newton's minimum.
fn newton(potential: &dyn Potential, count: usize, fixed: &[u32], start: &[DVec3]) -> (Vec<DVec3>, usize) {
    let mut x = start.to_vec();
    let mut newton = Newton::new(Free::new(count, fixed), &[potential], Method::DIRECT).expect("memory");
    let found = newton.minimize(&[potential], &mut x, Tolerance { step: 1e-10, iterations: 100 });
    assert!(found.converged, "{found:?}");
    (x, found.steps.len())
}

#[test]
fn projective_dynamics_ends_where_newton_does_and_never_climbs() {
    let (rest, tets, fixed, mut x) = pulled();
    let weight = 9000.0;
    let solid = Solid::new(tets.clone(), Arap::new(weight));
    let (truth, _) = newton(&solid, rest.len(), &fixed, &x);
    let still = Projective::still(&tets, Free::new(rest.len(), &fixed), weight).expect("a factor");
    let mut energy = solid.energy(&x);
    let mut iterations = 0;
    while apart(&x, &truth) > 1e-7 {
        still.iterate(&mut x, &[]);
        let lower = solid.energy(&x);
        assert!(lower <= energy * (1.0 + 1e-12), "{iterations}: {lower} over {energy}");
        (energy, iterations) = (lower, iterations + 1);
        assert!(iterations < 2000, "{}", apart(&x, &truth));
    }
    println!("projective dynamics: {iterations} iterations to 1e-7 m");
}

#[test]
fn projective_dynamics_keeps_momentum() {
    let (rest, tets) = block([3, 2, 2], 0.1);
    let mass = vec![0.7; rest.len()];
    let h = 0.01;
    let moving = Projective::moving(&tets, Free::new(rest.len(), &[]), 9000.0, &mass, h).expect("a factor");
    let mut noise = noise(9);
    let (mut x, mut v) = (rest.clone(), vec![DVec3::ZERO; rest.len()]);
    v.iter_mut().for_each(|v| *v = DVec3::new(noise(), noise(), noise()));
    let momentum = |v: &[DVec3]| -> DVec3 { v.iter().map(|v| 0.7 * *v).sum() };
    let before = momentum(&v);
    for _ in 0..20 {
        let from = x.clone();
        let coasting: Vec<DVec3> = x.iter().zip(&v).map(|(x, v)| *x + h * *v).collect();
        x.copy_from_slice(&coasting);
        (0..10).for_each(|_| moving.iterate(&mut x, &coasting));
        v = x.iter().zip(&from).map(|(x, from)| (*x - *from) / h).collect();
    }
    assert!(momentum(&v).distance(before) < 1e-9 * before.length(), "{} {before}", momentum(&v));
}

#[test]
fn one_solve_in_turned_frames_is_exact_for_what_is_turned_and_stretched() {
    let (rest, tets) = block([4, 3, 3], 0.1);
    let fixed = nodes(&rest, |x| {
        [x.x, x.y, x.z].iter().zip([0.4, 0.3, 0.3]).any(|(x, h)| *x < 1e-9 || *x > h - 1e-9)
    });
    let turn = DMat3::from_rotation_y(1.1) * DMat3::from_rotation_x(-0.6);
    let map = turn * DMat3::from_diagonal(DVec3::new(1.2, 0.9, 1.05));
    let truth: Vec<DVec3> = rest.iter().map(|x| map * *x).collect();
    let mut start = rest.clone();
    fixed.iter().for_each(|i| start[*i as usize] = truth[*i as usize]);
    let warped = Warped { elements: &tets, rotations: vec![turn; tets.len()], material: fat() };
    let (found, steps) = newton(&warped, rest.len(), &fixed, &start);
    // The second finds nothing left to do.
    assert!(steps == 2 && apart(&found, &truth) < 1e-12, "{steps} {}", apart(&found, &truth));
}

#[test]
fn frames_that_follow_end_at_the_co_rotated_minimum() {
    let (rest, tets, fixed, mut x) = pulled();
    let solid = Solid::new(tets.clone(), Corotated::new(fat()));
    let (truth, _) = newton(&solid, rest.len(), &fixed, &x);
    let once = {
        let warped = Warped::at(&tets, fat(), &x);
        newton(&warped, rest.len(), &fixed, &x).0
    };
    for _ in 0..400 {
        let warped = Warped::at(&tets, fat(), &x);
        x = newton(&warped, rest.len(), &fixed, &x).0;
    }
    println!("after one solve {:.1e} m, after all {:.1e} m", apart(&once, &truth), apart(&x, &truth));
    assert!(apart(&x, &truth) < 1e-7, "{}", apart(&x, &truth));
}
