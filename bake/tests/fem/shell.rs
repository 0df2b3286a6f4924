//! Skin that bends and stretches.

use crate::shapes::noise;
use core::f64::consts::PI;
use glam::{DMat3, DVec3};
use sinew_bake::fem::assembly::{Assembly, Free};
use sinew_bake::fem::newton::{Newton, Tolerance};
use sinew_bake::fem::potential::load::Load;
use sinew_bake::fem::potential::shell::{Shell, Skin};
use sinew_bake::fem::potential::{Potential, energy, gradient};
use sinew_bake::fem::solver::Method;
use sinew_bake::fem::surface::Surface;

const SKIN: Skin = Skin { bending: 2e-3, stretching: 3e-2 };

/// A sheet of `n` × `m` squares, two triangles each, with corners where `place` puts them: rows of `n + 1` points.
fn sheet([n, m]: [u32; 2], place: impl Fn(f64, f64) -> DVec3) -> (Vec<DVec3>, Vec<[u32; 3]>) {
    let at = |i: u32| place(f64::from(i % (n + 1)), f64::from(i / (n + 1)));
    let points = (0..(n + 1) * (m + 1)).map(at).collect();
    let corners = (0..n * m).map(|i| i / n * (n + 1) + i % n);
    let triangles = corners.flat_map(|c| [[c, c + 1, c + n + 2], [c, c + n + 2, c + n + 1]]).collect();
    (points, triangles)
}

fn wavy() -> (Vec<DVec3>, Vec<[u32; 3]>) {
    let mut noise = noise(3);
    let (mut rest, triangles) =
        sheet([9, 7], |x, y| 0.1 * DVec3::new(x, y, libm::sin(x) * libm::cos(0.7 * y)));
    rest.iter_mut().for_each(|x| *x += 0.02 * DVec3::new(noise(), noise(), noise()));
    (rest, triangles)
}

/// At rest no force at all; moved and turned as one 1e-9 of what a stretch by a tenth gives.
#[test]
fn rest_and_rigid_motion_are_free() {
    let (rest, triangles) = wavy();
    let shell = Shell::new(Surface::of_nodes(&rest, triangles).expect("a surface"), SKIN).expect("skin");
    assert!(shell.energy(&rest) == 0.0 && gradient(&[&shell], &rest).iter().all(|g| *g == DVec3::ZERO));
    let force = |x: &[DVec3]| gradient(&[&shell], x).iter().map(|g| g.length()).fold(0.0, f64::max);
    let turn = DMat3::from_axis_angle(DVec3::new(0.6, 0.0, 0.8), 2.0);
    let moved: Vec<DVec3> = rest.iter().map(|x| turn * *x + DVec3::new(1.0, -2.0, 0.5)).collect();
    let stretched: Vec<DVec3> = rest.iter().map(|x| 1.1 * *x).collect();
    assert!(force(&moved) < 1e-9 * force(&stretched), "{} {}", force(&moved), force(&stretched));
}

/// With points that are nodes, and points that share nodes.
#[test]
fn slopes_are_differences() {
    let (rest, triangles) = wavy();
    let count = u32::try_from(rest.len()).expect("few");
    let plain = Surface::of_nodes(&rest, triangles.clone()).expect("a surface");
    let of = |i: u32| [(i, 0.7), ((i + 1) % count, 0.2), ((i + 5) % count, 0.1), (0, 0.0)];
    let points: Vec<[(u32, f64); 4]> = (0..count).map(of).collect();
    let embedded = Surface::new(&rest, &points, triangles).expect("a surface");
    for surface in [plain, embedded] {
        let shell = Shell::new(surface, SKIN).expect("skin");
        let body: [&dyn Potential; 1] = [&shell];
        let mut noise = noise(7);
        let mut any = || DVec3::new(noise(), noise(), noise());
        let x: Vec<DVec3> = rest.iter().map(|x| *x + 0.03 * any()).collect();
        let d: Vec<DVec3> = x.iter().map(|_| any()).collect();
        let h = 1e-6;
        let at = |t: f64| -> Vec<DVec3> { x.iter().zip(&d).map(|(x, d)| *x + t * *d).collect() };
        let slope: f64 = gradient(&body, &x).iter().zip(&d).map(|(g, d)| g.dot(*d)).sum();
        let want = (energy(&body, &at(h)) - energy(&body, &at(-h))) / (2.0 * h);
        assert!((slope - want).abs() < 1e-6 * want.abs(), "{slope} {want}");
        let free = Free::new(x.len(), &[]);
        let mut matrix = free.stiffness(&body);
        shell.hessian(&x, false, &mut Assembly::new(&free, &mut matrix));
        let mut found = vec![DVec3::ZERO; x.len()];
        matrix.multiply(&d, &mut found);
        let (up, down) = (gradient(&body, &at(h)), gradient(&body, &at(-h)));
        let size = found.iter().map(|f| f.length()).fold(0.0, f64::max);
        for (found, (up, down)) in found.iter().zip(up.iter().zip(&down)) {
            assert!(found.distance((*up - *down) / (2.0 * h)) < 1e-6 * size, "{found}");
        }
    }
}

/// A closed surface has a hinge at each edge, a rim none, nor a fin, nor a triangle the wrong way round.
#[test]
fn hinges_are_where_two_triangles_meet() {
    let rest = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z, DVec3::ONE];
    let hinges = |triangles: &[[u32; 3]]| {
        let surface = Surface::of_nodes(&rest, triangles.to_vec()).expect("a surface");
        Shell::new(surface, SKIN).expect("skin").hinges.len()
    };
    let tet = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]];
    assert_eq!(hinges(&tet), 6);
    assert_eq!(hinges(&tet[..3]), 3);
    assert_eq!(hinges(&[tet[0], tet[1], tet[2], tet[3], [1, 3, 4]]), 5);
    assert_eq!(hinges(&[[0, 1, 2], [0, 1, 3]]), 0);
    assert_eq!(hinges(&[[0, 1, 2], [1, 0, 3]]), 1);
    assert!(Shell::new(Surface::default(), Skin { bending: -1.0, ..SKIN }).is_err());
    assert!(Shell::new(Surface::default(), Skin { bending: f64::NAN, ..SKIN }).is_err());
}

/// Of a sheet rolled up to a cylinder `E = 3/2 k_b A/R²`: an edge along it has `l̄²/Ā = 3 l̄/b` and bends by `b/R` where
/// triangles are `b` wide. As a polygon of `n` sides `b = 2R sin(π/n)` and the angle `2π/n`: too much by `π²/6n²`.
#[test]
fn the_energy_of_a_cylinder_converges() {
    let (radius, length) = (0.3, 1.0);
    let want = 1.5 * SKIN.bending * 2.0 * PI * radius * length / (radius * radius);
    let off = [16_u32, 32, 64].map(|n| {
        let side = 2.0 * radius * libm::sin(PI / f64::from(n));
        let (flat, triangles) = sheet([n, 4], |x, y| DVec3::new(side * x, 0.25 * length * y, 0.0));
        let shell = Shell::new(Surface::of_nodes(&flat, triangles).expect("a surface"), SKIN).expect("skin");
        let (rolled, _) = sheet([n, 4], |x, y| {
            let turn = 2.0 * PI * x / f64::from(n);
            DVec3::new(radius * libm::cos(turn), 0.25 * length * y, radius * libm::sin(turn))
        });
        // The seam is a rim: of n edges around there are n - 1 hinges.
        let found = shell.energy(&rolled) * f64::from(n) / f64::from(n - 1);
        let relative = found / want - 1.0;
        let predicted = PI / f64::from(n) / libm::sin(PI / f64::from(n)) - 1.0;
        assert!((relative - predicted).abs() < 1e-10, "{n}: {relative} {predicted}");
        relative
    });
    println!("cylinder, relative errors {off:?}");
    assert!(off.windows(2).all(|e| ((e[0] / e[1]).log2() - 2.0).abs() < 0.01), "{off:?}");
}

/// A strip that is clamped along one end and pushed at the other sinks by `F L³/3D`, `D = 3 k_b W`, where its rows stay straight:
/// each is moved by one node. Of `n` hinges, the first at the clamp, by `F Σ (L − ib)² b/D`: too much by `3/2n`.
#[test]
fn a_clamped_strip_sinks_as_a_beam() {
    let (length, width, force) = (0.5, 0.1, 1e-6);
    let off = [10_u32, 20, 40].map(|n| {
        let b = length / f64::from(n);
        // One row more is in the clamp, so that the first hinge is at its edge; the last three nodes are steps along a row.
        let mut rest: Vec<DVec3> =
            (0..n + 2).map(|i| DVec3::new(b * (f64::from(i) - 1.0), 0.0, 0.0)).collect();
        rest.extend([0.0, 0.5, 1.0].map(|y| DVec3::new(0.0, width * y, 0.0)));
        let (points, triangles) = sheet([n + 1, 2], |x, y| DVec3::new(x, y, 0.0));
        let index = |x: f64| (0..).take_while(|i| f64::from(*i) < x).count();
        let node = |i: usize| u32::try_from(i).expect("few");
        let row = |p: &DVec3| {
            let (row, step) = (node(index(p.x)), n + 2 + node(index(p.y)));
            [(row, 1.0), (step, 1.0), (0, 0.0), (0, 0.0)]
        };
        let points: Vec<[(u32, f64); 4]> = points.iter().map(row).collect();
        let surface = Surface::new(&rest, &points, triangles).expect("a surface");
        let skin = Skin { bending: 2e-3, stretching: 3.0 };
        let shell = Shell::new(surface, skin).expect("skin");
        let mut load = Load { forces: vec![DVec3::ZERO; rest.len()] };
        load.forces[n as usize + 1].z = -force;
        let fixed = [0, 1, n + 2, n + 3, n + 4];
        let potentials: [&dyn Potential; 2] = [&shell, &load];
        let mut newton =
            Newton::new(Free::new(rest.len(), &fixed), &potentials, Method::DIRECT).expect("memory");
        let mut x = rest.clone();
        let found = newton.minimize(&potentials, &mut x, Tolerance { step: 1e-12, iterations: 100 });
        assert!(found.converged, "{found:?}");
        let sunk = -x[n as usize + 1].z;
        let stiffness = 3.0 * skin.bending * width;
        let beam = force * length * length * length / (3.0 * stiffness);
        let arms = (0..n).map(|i| length - f64::from(i) * b);
        let hinges = force * arms.map(|arm| arm * arm * b).sum::<f64>() / stiffness;
        println!("{n} hinges: {sunk:.6e} m, by their sum {hinges:.6e}, a beam {beam:.6e}");
        // The square of the slope at the end, 2e-4, is what small angles leave out.
        assert!((sunk / hinges - 1.0).abs() < 1e-6, "{n}: {sunk} {hinges}");
        sunk / beam - 1.0
    });
    assert!(off.windows(2).all(|e| ((e[0] / e[1]).log2() - 1.0).abs() < 0.05), "{off:?}");
}

/// One thread and several: the same bits.
#[test]
fn threads_change_no_bit() {
    let mut noise = noise(11);
    let (rest, triangles) = sheet([60, 50], |x, y| 0.01 * DVec3::new(x, y, 0.0));
    let shell = Shell::new(Surface::of_nodes(&rest, triangles).expect("a surface"), SKIN).expect("skin");
    let x: Vec<DVec3> = rest.iter().map(|x| *x + 0.004 * DVec3::new(noise(), noise(), noise())).collect();
    let free = Free::new(rest.len(), &[]);
    let all = || {
        let mut matrix = free.stiffness(&[&shell]);
        shell.hessian(&x, true, &mut Assembly::new(&free, &mut matrix));
        (shell.energy(&x).to_bits(), gradient(&[&shell], &x), matrix)
    };
    let with = |n| rayon::ThreadPoolBuilder::new().num_threads(n).build().expect("threads").install(all);
    let one = with(1);
    for n in [2, 3, 7] {
        assert!(with(n) == one, "{n} threads");
    }
}
