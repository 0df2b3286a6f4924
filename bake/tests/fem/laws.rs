//! What holds for every element and energy: patch tests, rigid motion, slopes, threads.

use crate::shapes::{block, fat, nodes, noise, prism_block};
use glam::{DMat3, DVec3};
use sinew_bake::fem::assembly::{Assembly, Free};
use sinew_bake::fem::element::Elements;
use sinew_bake::fem::energy::{
    arap::Arap, corotated::Corotated, neo_hookean::NeoHookean, stvk::StVenantKirchhoff,
};
use sinew_bake::fem::newton::{Newton, Tolerance};
use sinew_bake::fem::potential::{Potential, energy, gradient, solid::Solid};
use sinew_bake::fem::solver::Method;

/// Names, and what has them.
type Bodies = Vec<(&'static str, Box<dyn Potential>)>;

/// Every energy on `elements`.
fn bodies<const N: usize>(elements: &Elements<N>) -> Bodies {
    let solid = |e: &Elements<N>| e.clone();
    vec![
        (
            "stable Neo-Hookean",
            Box::new(Solid::new(solid(elements), NeoHookean::new(fat()))) as Box<dyn Potential>,
        ),
        ("StVK", Box::new(Solid::new(solid(elements), StVenantKirchhoff::with_resistance(fat(), 15_000.0)))),
        ("co-rotated", Box::new(Solid::new(solid(elements), Corotated::new(fat())))),
        ("ARAP", Box::new(Solid::new(solid(elements), Arap::new(fat().mu)))),
    ]
}

/// Blocks of both elements with inner nodes out of line.
fn blocks() -> Vec<(Vec<DVec3>, Bodies)> {
    let shake = |rest: &[DVec3]| -> Vec<DVec3> {
        let mut noise = noise(3);
        rest.iter().map(|x| *x + 0.02 * DVec3::new(noise(), noise(), noise())).collect()
    };
    let (rest, tets) = block([3, 2, 4], 0.1);
    let rest = shake(&rest);
    let tets = Elements::tets(&rest, tets.nodes).expect("tetrahedra");
    let (other, prisms) = prism_block([3, 2, 4], 0.1);
    let other = shake(&other);
    let prisms = Elements::prisms(&other, prisms.nodes).expect("prisms");
    vec![(rest, bodies(&tets)), (other, bodies(&prisms))]
}

/// An affine map of the boundary goes on inside: to 1e-10 of the size, from a start that is far off.
#[test]
fn patch_tests_are_exact() {
    let map = DMat3::from_cols_array(&[1.1, 0.05, 0.0, -0.1, 0.95, 0.08, 0.03, 0.0, 1.04]);
    for (rest, bodies) in blocks() {
        let inside = |x: DVec3| {
            (0.05..0.25).contains(&x.x) && (0.05..0.15).contains(&x.y) && (0.05..0.35).contains(&x.z)
        };
        let fixed = nodes(&rest, |x| !inside(x));
        assert!(fixed.len() < rest.len(), "none free");
        for (name, body) in bodies {
            let want: Vec<DVec3> = rest.iter().map(|x| map * *x).collect();
            let mut x = want.clone();
            let free = Free::new(rest.len(), &fixed);
            let mut noise = noise(1);
            free.node.iter().for_each(|i| x[*i as usize] += 0.02 * DVec3::new(noise(), noise(), noise()));
            let potentials = [body.as_ref()];
            let mut newton = Newton::new(free, &potentials, Method::DIRECT).expect("memory");
            let found = newton.minimize(&potentials, &mut x, Tolerance { step: 1e-9, iterations: 50 });
            let off = x.iter().zip(&want).map(|(x, want)| x.distance(*want)).fold(0.0, f64::max);
            assert!(found.converged && off < 1e-10 * 0.5, "{name}: {off}, {found:?}");
        }
    }
}

/// Turned and moved as a whole there is no force: to 1e-9 of what a stretch by a tenth gives.
#[test]
fn rigid_motion_is_free() {
    let turn = DMat3::from_axis_angle(DVec3::new(0.6, 0.0, 0.8), 2.0);
    for (rest, bodies) in blocks() {
        for (name, body) in bodies {
            let force =
                |x: &[DVec3]| gradient(&[body.as_ref()], x).iter().map(|f| f.length()).fold(0.0, f64::max);
            let moved: Vec<DVec3> = rest.iter().map(|x| turn * *x + DVec3::new(1.0, -2.0, 0.5)).collect();
            let stretched: Vec<DVec3> = rest.iter().map(|x| 1.1 * *x).collect();
            assert!(
                force(&moved) < 1e-9 * force(&stretched),
                "{name}: {} {}",
                force(&moved),
                force(&stretched)
            );
        }
    }
}

/// Forces are slopes of the energy, the matrix those of the forces.
#[test]
fn slopes_are_differences() {
    for (rest, bodies) in blocks() {
        let mut noise = noise(7);
        let mut moved = || -> Vec<DVec3> {
            rest.iter().map(|x| *x + 0.02 * DVec3::new(noise(), noise(), noise())).collect()
        };
        let (x, along) = (moved(), moved());
        let d: Vec<DVec3> = along.iter().zip(&rest).map(|(a, x)| *a - *x).collect();
        let at = |t: f64| -> Vec<DVec3> { x.iter().zip(&d).map(|(x, d)| *x + t * *d).collect() };
        let h = 1e-5;
        for (name, body) in bodies {
            let body = [body.as_ref()];
            let slope: f64 = gradient(&body, &x).iter().zip(&d).map(|(g, d)| g.dot(*d)).sum();
            let want = (energy(&body, &at(h)) - energy(&body, &at(-h))) / (2.0 * h);
            assert!((slope - want).abs() < 1e-6 * want.abs(), "{name}: {slope} {want}");
            let free = Free::new(rest.len(), &[]);
            let mut matrix = free.stiffness(&body);
            body[0].hessian(&x, false, &mut Assembly::new(&free, &mut matrix));
            let mut found = vec![DVec3::ZERO; rest.len()];
            matrix.multiply(&d, &mut found);
            let (up, down) = (gradient(&body, &at(h)), gradient(&body, &at(-h)));
            let size = found.iter().map(|f| f.length()).fold(0.0, f64::max);
            for (found, (up, down)) in found.iter().zip(up.iter().zip(&down)) {
                let want = (*up - *down) / (2.0 * h);
                assert!(found.distance(want) < 1e-6 * size, "{name}: {found} {want}");
            }
        }
    }
}

/// One thread and several: the same bits.
#[test]
fn threads_change_no_bit() {
    let (rest, tets) = block([12, 8, 8], 0.1);
    let body = Solid::new(tets, NeoHookean::new(fat()));
    let mut noise = noise(11);
    let x: Vec<DVec3> = rest.iter().map(|x| *x + 0.03 * DVec3::new(noise(), noise(), noise())).collect();
    let free = Free::new(rest.len(), &[]);
    let all = || {
        let mut matrix = free.stiffness(&[&body]);
        body.hessian(&x, true, &mut Assembly::new(&free, &mut matrix));
        (energy(&[&body], &x).to_bits(), gradient(&[&body], &x), matrix)
    };
    let with = |n| rayon::ThreadPoolBuilder::new().num_threads(n).build().expect("threads").install(all);
    let one = with(1);
    for n in [2, 3, 7] {
        assert!(with(n) == one, "{n} threads");
    }
}
