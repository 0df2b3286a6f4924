//! A factor and the multigrid cycle: one solution.

use crate::shapes::{block, fat, nodes, noise, prism_block};
use glam::{DMat3, DVec3};
use sinew_bake::fem::assembly::{Assembly, Free};
use sinew_bake::fem::energy::{corotated::Corotated, neo_hookean::NeoHookean};
use sinew_bake::fem::iterative::Iterative;
use sinew_bake::fem::newton::{Newton, Tolerance};
use sinew_bake::fem::potential::{Potential, solid::Solid};
use sinew_bake::fem::solver::{Method, Solver};

/// One end held, the other turned by a radian about the bar.
fn turned(rest: &[DVec3], length: f64) -> (Vec<u32>, Vec<DVec3>) {
    let fixed = nodes(rest, |x| x.x < 1e-9 || x.x > length - 1e-9);
    let turn = |x: &DVec3| DMat3::from_rotation_x(x.x / length) * *x;
    (fixed, rest.iter().map(turn).collect())
}

/// The same system by both; iterations stay few when there are eight times the unknowns.
#[test]
fn a_factor_and_cycles_give_one_solution() {
    let mut counts = Vec::new();
    for n in [8_usize, 16] {
        let edge = 0.8 / n as f64;
        let (rest, tets) = block([n, n / 2, n / 2], edge);
        let (fixed, x) = turned(&rest, 0.8);
        let free = Free::new(rest.len(), &fixed);
        let body = Solid::new(tets, NeoHookean::new(fat()));
        let mut k = free.stiffness(&[&body]);
        body.hessian(&x, true, &mut Assembly::new(&free, &mut k));
        let mut noise = noise(5);
        let b: Vec<DVec3> = (0..k.len()).map(|_| DVec3::new(noise(), noise(), noise())).collect();
        let (mut direct, mut iterated) = (b.clone(), b);
        Solver::new(&k, Method::DIRECT).and_then(|mut s| s.solve(&k, &mut direct)).expect("a factor");
        let mut cycles = Iterative::new(&k);
        cycles.factorize(&k).and_then(|()| cycles.solve(&mut iterated)).expect("a solution");
        let size = direct.iter().map(|x| x.length()).fold(0.0, f64::max);
        let apart = direct.iter().zip(&iterated).map(|(a, b)| (*a - *b).length()).fold(0.0, f64::max);
        println!(
            "grids of {:?}: {} iterations, {:.1e} apart",
            cycles.rows(),
            cycles.iterations,
            apart / size
        );
        assert!(apart < 1e-8 * size, "{apart} of {size}");
        counts.push(cycles.iterations);
    }
    assert!(counts[1] <= 80 && counts[1] <= 2 * counts[0], "{counts:?}");
}

/// Newton by either ends at one equilibrium, on tetrahedra and on prisms, in as many steps.
#[test]
fn newton_ends_at_one_equilibrium() {
    let (rest, tets) = block([8, 2, 2], 0.1);
    let (other, prisms) = prism_block([8, 2, 2], 0.1);
    let cases: [(&[DVec3], Box<dyn Potential>); 3] = [
        (&rest, Box::new(Solid::new(tets.clone(), NeoHookean::new(fat())))),
        (&rest, Box::new(Solid::new(tets, Corotated::new(fat())))),
        (&other, Box::new(Solid::new(prisms, NeoHookean::new(fat())))),
    ];
    for (rest, body) in cases {
        let (fixed, start) = turned(rest, 0.8);
        let [direct, iterated] = [Method::DIRECT, Method::Multigrid].map(|method| {
            let mut x = start.clone();
            let mut newton =
                Newton::new(Free::new(rest.len(), &fixed), &[body.as_ref()], method).expect("memory");
            let found = newton.minimize(&[body.as_ref()], &mut x, Tolerance { step: 1e-9, iterations: 50 });
            assert!(found.converged, "{method:?}: {found:?}");
            (x, found.steps.len())
        });
        let apart = direct.0.iter().zip(&iterated.0).map(|(a, b)| (*a - *b).length()).fold(0.0, f64::max);
        println!("{} and {} steps, {apart:.1e} m apart", direct.1, iterated.1);
        assert!(apart < 1e-9 && direct.1.abs_diff(iterated.1) <= 1, "{apart}");
    }
}
