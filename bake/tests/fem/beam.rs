//! A cantilever and a hanging bar against their closed forms, and Poisson's ratio of a stretched bar.

use crate::shapes::{block, nodes, prism_block};
use glam::DVec3;
use sinew_bake::fem::assembly::Free;
use sinew_bake::fem::element::Elements;
use sinew_bake::fem::energy::{
    Energy, corotated::Corotated, neo_hookean::NeoHookean, stvk::StVenantKirchhoff,
};
use sinew_bake::fem::mass::Mass;
use sinew_bake::fem::material::Lame;
use sinew_bake::fem::newton::{Newton, Tolerance};
use sinew_bake::fem::potential::{Potential, load::Load, solid::Solid};
use sinew_bake::fem::solver::Method;

/// Where nodes come to rest.
fn settle(rest: &[DVec3], fixed: &[u32], potentials: &[&dyn Potential]) -> Vec<DVec3> {
    let mut x = rest.to_vec();
    let mut newton = Newton::new(Free::new(rest.len(), fixed), potentials, Method::DIRECT).expect("memory");
    let found = newton.minimize(potentials, &mut x, Tolerance { step: 1e-10, iterations: 50 });
    assert!(found.converged, "{found:?}");
    x
}

/// How far the end of a beam of 1 × 0.2 × 0.2 m sinks under its weight, with `n` voxels over its thickness.
fn sag(n: usize, lame: Lame, density: f64) -> f64 {
    let edge = 0.2 / n as f64;
    let (rest, tets) = block([5 * n, n, n], edge);
    let mass = Mass::new(rest.len()).with_tets(&tets, density);
    let weight = Load::weight(&mass, DVec3::new(0.0, -9.81, 0.0));
    let body = Solid::new(tets, NeoHookean::new(lame));
    let x = settle(&rest, &nodes(&rest, |x| x.x < 1e-9), &[&body, &weight]);
    let end = nodes(&rest, |x| x.x > 1.0 - 1e-9);
    end.iter().map(|i| rest[*i as usize].y - x[*i as usize].y).sum::<f64>() / end.len() as f64
}

/// `w = q l⁴/8EI + q l²/2κGA`, κ = 10(1 + ν)/(12 + 11ν) (Timoshenko, Cowper 1966); errors of linear tetrahedra fall with
/// the square of their size. Without contraction, so that the clamp holds nothing back that theory lets go.
#[test]
fn a_cantilever_sinks_as_it_must() {
    let (e, nu, density) = (1e6, 0.0, 50.0);
    let lame = Lame::new(e, nu).expect("a material");
    let q = density * 9.81 * 0.04;
    let (bending, shear) = (q / (8.0 * e * 0.2_f64 * 0.2 * 0.2 * 0.2 / 12.0), q / (2.0 * lame.mu * 0.04));
    let want = bending + shear * (12.0 + 11.0 * nu) / (10.0 * (1.0 + nu));
    // What is too much of coarse elements is stiffness, so that is what falls evenly.
    let [a, b, c] = [3, 6, 12].map(|n| 1.0 / sag(n, lame, density));
    let limit = 1.0 / (c - (b - c) / 3.0);
    let order = ((a - b) / (b - c)).log2();
    println!(
        "sag {:.6} {:.6} {:.6} m, limit {limit:.6}, theory {want:.6}, order {order:.2}",
        1.0 / a,
        1.0 / b,
        1.0 / c
    );
    assert!((order - 2.0).abs() < 0.25, "order {order}");
    assert!((limit / want - 1.0).abs() < 5e-3, "{limit} {want}");
}

/// `u = ρ g L²/2E` at the end of a bar that hangs from its top, without contraction across.
#[test]
fn a_hanging_bar_grows_as_it_must() {
    let (e, density) = (1e5, 100.0);
    let lame = Lame::new(e, 0.0).expect("a material");
    let want = density * 9.81 / (2.0 * e);
    let off = [2, 4, 8].map(|n| {
        let (rest, tets) = block([2, 4 * n, 2], 0.25 / n as f64);
        let mass = Mass::new(rest.len()).with_tets(&tets, density);
        let weight = Load::weight(&mass, DVec3::new(0.0, -9.81, 0.0));
        let body = Solid::new(tets, Corotated::new(lame));
        let x = settle(&rest, &nodes(&rest, |x| x.y > 1.0 - 1e-9), &[&body, &weight]);
        let end = nodes(&rest, |x| x.y < 1e-9);
        let sunk = end.iter().map(|i| -x[*i as usize].y).sum::<f64>() / end.len() as f64;
        (sunk / want - 1.0).abs()
    });
    println!("hanging bar, relative errors {off:?}");
    assert!(off[2] < 1e-3 && off[2] < off[0], "{off:?}");
}

/// Contraction across over extension along of a bar, pulled at both ends.
fn ratio<const N: usize>(rest: &[DVec3], faces: &[Vec<u32>], body: &Solid<N, impl Energy>, pull: f64) -> f64 {
    let mut forces = vec![DVec3::ZERO; rest.len()];
    for face in faces {
        // Of triangles and parallelograms alike: each corner carries the same part.
        let at = |k: usize| rest[face[k] as usize];
        let triangles = (2..face.len()).map(|k| 0.5 * (at(k - 1) - at(0)).cross(at(k) - at(0)).x);
        let part = pull * triangles.sum::<f64>() / face.len() as f64;
        face.iter().for_each(|i| forces[*i as usize].x += part);
    }
    let load = Load { forces };
    // Held at one node; what turns about it costs nothing and is not pulled at.
    let x = settle(rest, &[0], &[body, &load]);
    let f = body.elements.deformation(0, &x);
    let stretch = f.transpose() * f;
    (1.0 - stretch.y_axis.y.sqrt()) / (stretch.x_axis.x.sqrt() - 1.0)
}

/// Faces at both ends along x, seen from outside against the clock.
fn ends<const N: usize>(rest: &[DVec3], elements: &Elements<N>, faces: &[&[usize]]) -> Vec<Vec<u32>> {
    let (low, high) = rest.iter().fold((f64::MAX, f64::MIN), |(l, h), x| (l.min(x.x), h.max(x.x)));
    let mut out = Vec::new();
    for nodes in &elements.nodes {
        for face in faces {
            let face: Vec<u32> = face.iter().map(|c| nodes[*c]).collect();
            let on = |x: f64| face.iter().all(|i| (rest[*i as usize].x - x).abs() < 1e-9);
            if on(low) || on(high) {
                out.push(face);
            }
        }
    }
    out
}

#[test]
fn a_bar_contracts_by_the_ratio_asked_for() {
    let (rest, tets) = block([4, 2, 2], 0.1);
    let tet_ends = ends(&rest, &tets, &[&[0, 2, 1], &[0, 1, 3], &[1, 2, 3], &[0, 3, 2]]);
    let (other, prisms) = prism_block([4, 2, 2], 0.1);
    let prism_ends = ends(&other, &prisms, &[&[0, 1, 4, 3], &[1, 2, 5, 4], &[2, 0, 3, 5]]);
    for nu in [0.0, 0.3, 0.45, 0.49] {
        let lame = Lame::new(1e5, nu).expect("a material");
        let pull = 1e-5 * 1e5;
        let found = [
            ratio(&rest, &tet_ends, &Solid::new(tets.clone(), NeoHookean::new(lame)), pull),
            ratio(&rest, &tet_ends, &Solid::new(tets.clone(), Corotated::new(lame)), pull),
            ratio(&rest, &tet_ends, &Solid::new(tets.clone(), StVenantKirchhoff::new(lame, 0.0)), pull),
            ratio(&other, &prism_ends, &Solid::new(prisms.clone(), NeoHookean::new(lame)), pull),
        ];
        for found in found {
            assert!((found - nu).abs() < 1e-4, "{found}, asked for {nu}");
        }
    }
}
