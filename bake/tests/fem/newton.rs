//! Newton's method: down in every step, quadratic at the end, from starts that are beyond all reason.

use crate::shapes::{block, fat, nodes, noise, prism_block};
use glam::{DMat3, DVec3};
use sinew_bake::fem::assembly::Free;
use sinew_bake::fem::element::Elements;
use sinew_bake::fem::energy::{
    Energy, corotated::Corotated, neo_hookean::NeoHookean, stvk::StVenantKirchhoff,
};
use sinew_bake::fem::newton::{Equilibrium, Newton, Tolerance};
use sinew_bake::fem::potential::{Potential, solid::Solid};
use sinew_bake::fem::solver::Method;

/// Of voxels, m.
const EDGE: f64 = 0.1;
const TIGHT: Tolerance = Tolerance { step: 1e-10, iterations: 300 };

fn minimize(body: &dyn Potential, fixed: &[u32], x: &mut [DVec3]) -> Equilibrium {
    let mut newton = Newton::new(Free::new(x.len(), fixed), &[body], Method::DIRECT).expect("memory");
    newton.minimize(&[body], x, TIGHT)
}

/// Never up, but by rounding: of the energy itself, and at its bottom, 0, of the terms that cancel there.
fn falls(found: &Equilibrium) -> bool {
    let terms = 1e-16 * found.energies[0].abs();
    found.energies.windows(2).all(|e| e[1] <= e[0] + 1e-12 * e[0].abs() + terms)
}

/// A bar whose ends are turned against each other by a right angle and pushed together.
fn twisted(rest: &[DVec3]) -> (Vec<u32>, Vec<DVec3>) {
    let fixed = nodes(rest, |x| x.x < 1e-9 || x.x > 0.8 - 1e-9);
    let turn = DMat3::from_rotation_x(core::f64::consts::FRAC_PI_2);
    let middle = DVec3::new(0.0, 0.1, 0.1);
    let x = rest
        .iter()
        .map(|x| if x.x > 0.8 - 1e-9 { turn * (*x - middle) + middle - 0.1 * DVec3::X } else { *x });
    (fixed, x.collect())
}

/// Energy falls in each step; near the end each step is, in edges, at most fifty times the square of
/// the one before.
#[test]
fn the_end_is_quadratic() {
    let (rest, tets) = block([8, 2, 2], EDGE);
    let (other, prisms) = prism_block([8, 2, 2], EDGE);
    let cases: [(&[DVec3], Box<dyn Potential>); 3] = [
        (&rest, Box::new(Solid::new(tets.clone(), NeoHookean::new(fat())))),
        (&rest, Box::new(Solid::new(tets, Corotated::new(fat())))),
        (&other, Box::new(Solid::new(prisms, NeoHookean::new(fat())))),
    ];
    for (rest, body) in cases {
        let (fixed, mut x) = twisted(rest);
        let found = minimize(body.as_ref(), &fixed, &mut x);
        assert!(found.converged && falls(&found) && found.inverted == 0, "{found:?}");
        let mut noise = noise(2);
        for (i, x) in (0..).zip(&mut x).filter(|(i, _)| !fixed.contains(i)) {
            *x += 1e-3 * f64::from(i % 7) / 7.0 * DVec3::new(noise(), noise(), noise());
        }
        let found = minimize(body.as_ref(), &fixed, &mut x);
        // The first is by the projected Hessian; below 1e-13 there is rounding alone.
        let s: Vec<f64> = found.steps[1..].iter().copied().filter(|s| *s > 1e-13).collect();
        println!("steps of {}", s.iter().map(|s| format!("{s:.1e} ")).collect::<String>());
        assert!(s.len() >= 3 && s.windows(2).all(|s| s[1] <= 50.0 / EDGE * s[0] * s[0]), "{:?}", found.steps);
    }
}

/// All nodes at one point, anywhere, mirrored, a hundred metres off: whether it came back to rest. Numbers stay finite,
/// and the energy never grows.
fn torture<E: Energy>(name: &str, body: &Solid<4, E>, rest: &[DVec3]) -> [bool; 4] {
    let fixed = nodes(rest, |x| x.x < 1e-9);
    let mut noise = noise(21);
    let mut any = |size: f64| size * DVec3::new(noise(), noise(), noise());
    let starts: [Vec<DVec3>; 4] = [
        rest.iter().map(|_| DVec3::new(0.2, 0.1, 0.1)).collect(),
        rest.iter().map(|_| any(0.5)).collect(),
        rest.iter().map(|x| DVec3::new(-x.x, x.y, x.z)).collect(),
        rest.iter().map(|x| *x + any(100.0)).collect(),
    ];
    starts.map(|mut x| {
        fixed.iter().for_each(|i| x[*i as usize] = rest[*i as usize]);
        let found = minimize(body, &fixed, &mut x);
        assert!(x.iter().all(|x| x.is_finite()) && found.energies.iter().all(|e| e.is_finite()), "{name}");
        assert!(falls(&found), "{name}: {:?}", found.energies);
        let off = x.iter().zip(rest).map(|(x, r)| x.distance(*r)).fold(0.0, f64::max);
        let Equilibrium { converged, inverted, .. } = found;
        println!(
            "{name}: {} steps, converged {converged}, inverted {inverted}, {off:.1e} m",
            found.steps.len()
        );
        converged && off < 1e-6
    })
}

#[test]
fn no_start_is_too_bad() {
    let (rest, tets) = block([4, 2, 2], EDGE);
    let tets = |_: ()| Elements::<4>::clone(&tets);
    assert_eq!(
        torture("Neo-Hookean", &Solid::new(tets(()), NeoHookean::new(fat())), &rest),
        [true, false, true, false]
    );
    torture("co-rotated", &Solid::new(tets(()), Corotated::new(fat())), &rest);
    torture("StVK", &Solid::new(tets(()), StVenantKirchhoff::with_resistance(fat(), 15_000.0)), &rest);
}
