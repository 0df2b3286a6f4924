//! Contact of a body with itself.

use crate::shapes::{fat, nodes, noise, voxels};
use glam::{DMat3, DVec3};
use sinew_bake::fem::assembly::{Assembly, Free};
use sinew_bake::fem::drive::{Outcome, drive};
use sinew_bake::fem::dynamics::{BackwardEuler, Rayleigh, State};
use sinew_bake::fem::element::Elements;
use sinew_bake::fem::energy::neo_hookean::NeoHookean;
use sinew_bake::fem::mass::Mass;
use sinew_bake::fem::newton::{Newton, Tolerance};
use sinew_bake::fem::potential::contact::{Barrier, Contact};
use sinew_bake::fem::potential::load::Load;
use sinew_bake::fem::potential::pull::{Pull, Spring};
use sinew_bake::fem::potential::{Potential, energy, gradient, solid::Solid};
use sinew_bake::fem::solver::Method;
use sinew_bake::fem::surface::Surface;
use std::collections::BTreeMap;

const EDGE: f64 = 0.1;
const TOLERANCE: Tolerance = Tolerance { step: 1e-5 * EDGE, iterations: 60 };

/// Triangles that bound tetrahedra, seen from outside against the clock.
fn boundary(tets: &[[u32; 4]]) -> Vec<[u32; 3]> {
    let mut faces = BTreeMap::new();
    for [a, b, c, d] in tets {
        for face in [[*a, *c, *b], [*a, *b, *d], [*b, *c, *d], [*a, *d, *c]] {
            let mut key = face;
            key.sort_unstable();
            if faces.remove(&key).is_none() {
                faces.insert(key, face);
            }
        }
    }
    faces.into_values().collect()
}

/// A bar with two bones in it, and the places of all nodes where its fore part is folded by an angle, as far as bones
/// are told.
struct Elbow {
    rest: Vec<DVec3>,
    fixed: Vec<u32>,
    body: Solid<4, NeoHookean>,
    surface: Surface,
}

impl Elbow {
    fn new() -> Self {
        let (rest, tets) = voxels([14, 3, 3], EDGE, |_| true);
        let surface = Surface::of_nodes(&rest, boundary(&tets)).expect("a surface");
        let in_middle = |x: f64| x > 0.05 && x < 0.25;
        let fixed = nodes(&rest, |x| in_middle(x.y) && in_middle(x.z) && (x.x - 0.7).abs() > 0.15);
        let body = Solid::new(Elements::tets(&rest, tets).expect("tetrahedra"), NeoHookean::new(fat()));
        Self { rest, fixed, body, surface }
    }

    fn contact(&self) -> Contact {
        Contact::new(self.surface.clone(), Barrier { reach: 0.1 * EDGE, stiffness: 15_000.0 })
            .expect("settings")
    }

    fn folded(&self, degrees: f64) -> Vec<DVec3> {
        let middle = DVec3::new(0.7, 0.15, 0.15);
        let turn = DMat3::from_rotation_z(degrees.to_radians());
        let of = |x: &DVec3| if x.x > 0.7 { middle + turn * (*x - middle) } else { *x };
        self.rest.iter().map(of).collect()
    }
}

/// Folded by 150° in 15 parts: without contact triangles cross, with it none ever does, all nodes arrive and come to rest.
#[test]
fn an_elbow_does_not_fold_through_itself() {
    let elbow = Elbow::new();
    let contact = elbow.contact();
    let all: [&dyn Potential; 2] = [&elbow.body, &contact];
    for potentials in [&all[..1], &all] {
        let free = Free::new(elbow.rest.len(), &elbow.fixed);
        let mut newton = Newton::new(free, potentials, Method::DIRECT).expect("memory");
        let mut x = elbow.rest.clone();
        let mut crossings = Vec::new();
        for k in 1..=15 {
            let to = elbow.folded(10.0 * f64::from(k));
            let (found, outcome) = drive(&mut newton, potentials, &mut x, &to, TOLERANCE);
            assert!(found.converged && outcome == Outcome::Arrived, "{k}: {outcome:?} {found:?}");
            assert!(found.energies.iter().all(|e| e.is_finite()), "{k}: {found:?}");
            assert!(elbow.fixed.iter().all(|i| x[*i as usize] == to[*i as usize]), "{k}: not there");
            crossings.push(contact.crossings(&x));
            if potentials.len() == 2 {
                let (count, least) = contact.closest(&x);
                println!("{} degrees: {count} pairs, {least:.3} of their reach apart", 10 * k);
                assert!(least > 0.0 && (k < 15 || count > 20), "{k}: {count} {least}");
            }
        }
        println!("crossings {crossings:?}");
        assert_eq!(crossings.iter().sum::<usize>() > 0, potentials.len() == 1, "{crossings:?}");
    }
}

/// A square plate of 2 × 2 × `n`² triangles on the xz plane, nodes in rows along x.
fn plate(n: u32, size: f64, at: DVec3) -> (Vec<DVec3>, Vec<[u32; 3]>) {
    let place =
        |i: u32| at + size * DVec3::new(f64::from(i % (n + 1)), 0.0, f64::from(i / (n + 1))) / f64::from(n);
    let points = (0..(n + 1) * (n + 1)).map(place).collect();
    let corner = |i: u32| i / n * (n + 1) + i % n;
    let squares = (0..n * n).map(corner);
    let triangles = squares.flat_map(|c| [[c, c + n + 1, c + 1], [c + 1, c + n + 1, c + n + 2]]).collect();
    (points, triangles)
}

/// Two bodies as one.
fn both(
    (mut points, mut triangles): (Vec<DVec3>, Vec<[u32; 3]>),
    (more, others): (Vec<DVec3>, Vec<[u32; 3]>),
) -> (Vec<DVec3>, Surface) {
    let first = u32::try_from(points.len()).expect("few");
    points.extend(more);
    triangles.extend(others.into_iter().map(|t| t.map(|i| i + first)));
    let surface = Surface::of_nodes(&points, triangles).expect("a surface");
    (points, surface)
}

/// Nodes that springs pull to `by` from where they are.
fn pulled(x: &[DVec3], nodes: core::ops::Range<usize>, stiffness: f64, by: DVec3) -> Pull {
    let spring = |i: usize| Spring { node: u32::try_from(i).expect("few"), stiffness, to: x[i] + by };
    Pull { springs: nodes.map(spring).collect() }
}

/// One plate above another that is fixed, the edges of both parallel.
fn plates(angle: f64) -> (Vec<DVec3>, Surface) {
    let (mut upper, triangles) = plate(2, 1.0, DVec3::new(0.1, 0.3, 0.2));
    upper.iter_mut().for_each(|x| *x = DMat3::from_rotation_y(angle) * *x);
    both(plate(3, 2.0, DVec3::new(-0.5, 0.0, -0.5)), (upper, triangles))
}

/// A plate that springs pull through another in one step of Newton's stays above, and is where springs and barrier are even.
#[test]
fn what_is_fast_does_not_jump_over() {
    let (rest, surface) = plates(0.3);
    let (lower, upper) = (0..16, 16..rest.len());
    let fixed: Vec<u32> = lower.map(|i| u32::try_from(i).expect("few")).collect();
    let contact = Contact::new(surface, Barrier { reach: 0.05, stiffness: 1e4 }).expect("settings");
    for fall in [0.1, 0.5, 5.0, 500.0] {
        let pull = pulled(&rest, upper.clone(), 10.0, DVec3::new(0.0, -fall, 0.0));
        let run = |potentials: &[&dyn Potential]| {
            let mut x = rest.clone();
            let mut newton =
                Newton::new(Free::new(x.len(), &fixed), potentials, Method::DIRECT).expect("memory");
            let found = newton.minimize(potentials, &mut x, Tolerance { step: 1e-9, iterations: 200 });
            assert!(
                found.converged && found.energies.windows(2).all(|e| e[1] <= e[0] * (1.0 + 1e-12)),
                "{fall}: {found:?}"
            );
            x
        };
        let low = |x: &[DVec3]| x[16..].iter().map(|x| x.y).fold(f64::INFINITY, f64::min);
        let (through, kept) = (run(&[&pull]), run(&[&pull, &contact]));
        assert!((low(&through) - (0.3 - fall)).abs() < 1e-9, "nothing is in the way");
        println!("{fall} m: {:.5} above, {:?}", low(&kept), contact.closest(&kept));
        let touched = fall > 0.3;
        assert!(if touched { (0.0..0.05).contains(&low(&kept)) } else { (low(&kept) - 0.2).abs() < 1e-9 });
        assert_eq!(contact.crossings(&kept), 0, "{fall}");
    }
}

/// Two ridges across each other, neither with a point near the other: edges alone keep them apart.
#[test]
fn ridges_meet_by_their_edges() {
    let ridge = |up: f64| {
        let points = [[-1.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, -up, -1.0], [0.0, -up, 1.0]];
        (points.map(DVec3::from).to_vec(), vec![[0, 1, 3], [1, 0, 2]])
    };
    let turn = DMat3::from_rotation_y(core::f64::consts::FRAC_PI_2);
    let (upper, triangles) = ridge(-1.0);
    let upper = upper.iter().map(|x| turn * *x + DVec3::new(0.3, 0.5, 0.2)).collect();
    let (rest, surface) = both(ridge(1.0), (upper, triangles));
    let contact = Contact::new(surface, Barrier { reach: 0.05, stiffness: 1e4 }).expect("settings");
    let pull = pulled(&rest, 4..8, 10.0, -2.0 * DVec3::Y);
    let potentials: [&dyn Potential; 2] = [&pull, &contact];
    let mut x = rest.clone();
    let free = Free::new(8, &[0, 1, 2, 3]);
    let mut newton = Newton::new(free, &potentials, Method::DIRECT).expect("memory");
    let found = newton.minimize(&potentials, &mut x, Tolerance { step: 1e-9, iterations: 200 });
    let (count, least) = contact.closest(&x);
    println!("ridges: {count} pairs, {least}, {} steps", found.steps.len());
    assert!(found.converged && contact.crossings(&x) == 0 && count > 0 && least > 0.0, "{found:?}");
}

/// Two plates pressed together, edges parallel to all digits and nearly so: the same but for the angle.
#[test]
fn parallel_edges_are_no_exception() {
    let found = [0.0, 1e-9, 1e-6, 1e-3].map(|angle| {
        let (rest, surface) = plates(angle);
        let fixed: Vec<u32> = (0..16).collect();
        let contact = Contact::new(surface, Barrier { reach: 0.05, stiffness: 1e4 }).expect("settings");
        let pull = pulled(&rest, 16..rest.len(), 100.0, DVec3::new(0.0, -1.0, 0.0));
        let potentials: [&dyn Potential; 2] = [&pull, &contact];
        let mut x = rest.clone();
        let mut newton =
            Newton::new(Free::new(x.len(), &fixed), &potentials, Method::DIRECT).expect("memory");
        let found = newton.minimize(&potentials, &mut x, Tolerance { step: 1e-9, iterations: 200 });
        let (count, least) = contact.closest(&x);
        println!("{angle}: {count} pairs, {least}, {} steps, {:?}", found.steps.len(), found.energies.last());
        assert!(found.converged && count > 9 && least > 0.0, "{angle}: {found:?}");
        *found.energies.last().expect("an energy")
    });
    for (energy, angle) in found.iter().zip([0.0, 1e-9, 1e-6, 1e-3]) {
        assert!((energy / found[0] - 1.0).abs() <= angle, "{angle}: {found:?}");
    }
}

/// Fixed nodes that are told to pass through fixed nodes stop before, and it is said.
#[test]
fn what_cannot_be_is_named() {
    let (rest, surface) = plates(0.2);
    let contact = Contact::new(surface, Barrier { reach: 0.05, stiffness: 1e4 }).expect("settings");
    let fixed: Vec<u32> = (0..).take(rest.len()).collect();
    let mut newton = Newton::new(Free::new(rest.len(), &fixed), &[&contact], Method::DIRECT).expect("memory");
    let mut x = rest.clone();
    let to: Vec<DVec3> =
        rest.iter().enumerate().map(|(i, x)| if i < 16 { *x } else { *x - DVec3::Y }).collect();
    let (_, outcome) = drive(&mut newton, &[&contact], &mut x, &to, Tolerance { step: 1e-6, iterations: 5 });
    let Outcome::Blocked { at } = outcome else { panic!("{outcome:?}") };
    let height = x[16].y;
    assert!(height > 0.0 && height < 1e-4 && (at - (0.3 - height)).abs() < 1e-12, "{at} {height}");
    assert_eq!(contact.crossings(&x), 0);
}

/// Two plates nearer than they feel, with points that three nodes move, one of them the same for all; and a place of the nodes.
fn embedded() -> (Contact, Vec<DVec3>) {
    let (mut nodes, surface) = plates(0.3);
    nodes.iter_mut().skip(16).for_each(|x| x.y -= 0.27);
    let shared = u32::try_from(nodes.len()).expect("few");
    nodes.push(DVec3::new(0.3, 1.0, 0.3));
    let of = |i: u32| [(i, 0.9), (if i % 4 == 3 { i - 1 } else { i + 1 }, 0.04), (shared, 0.06), (0, 0.0)];
    let points: Vec<[(u32, f64); 4]> = (0..shared).map(of).collect();
    // At rest they are far apart.
    let rest: Vec<DVec3> = (0..).zip(&nodes).map(|(i, x)| if i < 16 { *x } else { *x + DVec3::Y }).collect();
    let surface = Surface::new(&rest, &points, surface.triangles).expect("a surface");
    let contact = Contact::new(surface, Barrier { reach: 0.05, stiffness: 1e4 }).expect("settings");
    let mut noise = noise(5);
    let x = nodes.iter().map(|x| *x + 0.004 * DVec3::new(noise(), noise(), noise())).collect();
    (contact, x)
}

/// Forces are slopes of the energy, the matrix those of the forces: with points that share nodes.
#[test]
fn slopes_of_embedded_surfaces_are_differences() {
    let (contact, x) = embedded();
    let (count, least) = contact.closest(&x);
    assert!(count > 20 && least < 0.9, "{count} {least}");
    let free = Free::new(x.len(), &[]);
    let body: [&dyn Potential; 1] = [&contact];
    let mut matrix = free.stiffness_with(&body, &free.touching(&body, &x));
    contact.hessian(&x, false, &mut Assembly::new(&free, &mut matrix));
    let mut noise = noise(8);
    for _ in 0..10 {
        let d: Vec<DVec3> = x.iter().map(|_| DVec3::new(noise(), noise(), noise())).collect();
        let h = 1e-7;
        let at = |t: f64| -> Vec<DVec3> { x.iter().zip(&d).map(|(x, d)| *x + t * *d).collect() };
        let slope: f64 = gradient(&body, &x).iter().zip(&d).map(|(g, d)| g.dot(*d)).sum();
        let want = (energy(&body, &at(h)) - energy(&body, &at(-h))) / (2.0 * h);
        assert!((slope - want).abs() < 1e-6 * want.abs(), "{slope} {want}");
        let mut found = vec![DVec3::ZERO; x.len()];
        matrix.multiply(&d, &mut found);
        let (up, down) = (gradient(&body, &at(h)), gradient(&body, &at(-h)));
        let size = found.iter().map(|f| f.length()).fold(0.0, f64::max);
        for (found, (up, down)) in found.iter().zip(up.iter().zip(&down)) {
            assert!(found.distance((*up - *down) / (2.0 * h)) < 1e-6 * size, "{found}");
        }
    }
}

/// One thread and several, a list of pairs made here or elsewhere: the same bits.
#[test]
fn neither_threads_nor_history_change_a_bit() {
    let elbow = Elbow::new();
    let folded = |contact: &Contact| {
        let potentials: [&dyn Potential; 2] = [&elbow.body, contact];
        let free = Free::new(elbow.rest.len(), &elbow.fixed);
        let mut newton = Newton::new(free, &potentials, Method::DIRECT).expect("memory");
        let mut fold = || {
            let mut x = elbow.rest.clone();
            for degrees in [60.0, 120.0] {
                drive(&mut newton, &potentials, &mut x, &elbow.folded(degrees), TOLERANCE);
            }
            x
        };
        let x = fold();
        assert!(fold() == x, "a second time");
        let free = newton.free();
        let mut matrix = free.stiffness_with(&potentials, &free.touching(&potentials, &x));
        contact.hessian(&x, true, &mut Assembly::new(free, &mut matrix));
        let step: Vec<DVec3> = gradient(&[contact], &x).iter().map(|g| -1e-2 * *g).collect();
        (contact.limit(&x, &step).to_bits(), energy(&potentials, &x).to_bits(), matrix, x)
    };
    let with = |n, contact: &Contact| {
        rayon::ThreadPoolBuilder::new().num_threads(n).build().expect("threads").install(|| folded(contact))
    };
    let contact = elbow.contact();
    let one = with(1, &contact);
    assert!(f64::from_bits(one.0) < 1.0, "nothing to meet");
    assert!(with(3, &elbow.contact()) == one, "threads");
    // Its list is of the end now, and of a place half a reach away.
    let mut noise = noise(4);
    let near: Vec<DVec3> =
        one.3.iter().map(|x| *x + 0.2 * EDGE * 0.1 * DVec3::new(noise(), noise(), noise())).collect();
    contact.energy(&near);
    assert!(with(2, &contact) == one, "history");
}

/// A bar without contact has no part in it: no stencils, no limit.
#[test]
fn without_contact_nothing_changes() {
    let elbow = Elbow::new();
    let free = Free::new(elbow.rest.len(), &elbow.fixed);
    let x = elbow.folded(90.0);
    let contact = elbow.contact();
    for potential in [&elbow.body as &dyn Potential, &contact] {
        assert!(free.touching(&[potential], &elbow.rest).is_empty(), "something touches at rest");
        assert!(gradient(&[&contact], &elbow.rest).iter().all(|g| *g == DVec3::ZERO), "a force at rest");
    }
    let jump: Vec<DVec3> = x.iter().zip(&elbow.rest).map(|(x, r)| *x - *r).collect();
    assert!(elbow.body.limit(&elbow.rest, &jump) >= 1.0 && contact.limit(&elbow.rest, &jump) < 1.0);
}

/// Layers that are fused at rest, lips that nearly are: no force at rest, and they do not pass.
#[test]
fn creases_are_at_rest() {
    let (mut rest, surface) = plates(0.3);
    rest.iter_mut().skip(16).for_each(|x| x.y = 1e-3);
    let surface = Surface::of_nodes(&rest, surface.triangles).expect("a surface");
    let contact = Contact::new(surface.clone(), Barrier { reach: 0.05, stiffness: 1e4 }).expect("settings");
    assert!(contact.energy(&rest) <= 0.0, "energy at rest");
    let pull = pulled(&rest, 16..rest.len(), 10.0, -DVec3::Y);
    let fixed: Vec<u32> = (0..16).collect();
    let mut x = rest.clone();
    let potentials: [&dyn Potential; 2] = [&pull, &contact];
    let mut newton = Newton::new(Free::new(x.len(), &fixed), &potentials, Method::DIRECT).expect("memory");
    let found = newton.minimize(&potentials, &mut x, Tolerance { step: 1e-9, iterations: 300 });
    assert!(found.converged && x[16..].iter().all(|x| (0.0..0.5e-3).contains(&x.y)), "{found:?}");
    // In one place there is nothing to keep apart.
    rest.iter_mut().skip(16).for_each(|x| x.y = 0.0);
    let fused = Surface::of_nodes(&rest, surface.triangles).expect("a surface");
    let contact = Contact::new(fused, Barrier { reach: 0.05, stiffness: 1e4 }).expect("settings");
    let mut away = vec![DVec3::ZERO; rest.len()];
    away[16..].fill(-DVec3::Y);
    assert_eq!((contact.energy(&rest), contact.limit(&rest, &away)), (0.0, 1.0));
}

/// A block that falls on a plate, more than its size and way in one step, neither passes nor is stopped for good by what is
/// not there: it lies on the plate at the end, its weight on the barrier.
#[test]
fn motion_stops_at_what_it_meets() {
    let (block, tets) = voxels([2, 1, 2], 0.2, |_| true);
    let falling = block.iter().map(|x| *x + DVec3::new(0.3, 0.2, 0.3)).collect();
    let (rest, surface) = both(plate(3, 1.0, DVec3::ZERO), (falling, boundary(&tets)));
    let tets = tets.into_iter().map(|t| t.map(|i| i + 16)).collect();
    let fixed: Vec<u32> = (0..16).collect();
    let contact = Contact::new(surface, Barrier { reach: 0.02, stiffness: 15_000.0 }).expect("settings");
    let body = Solid::new(Elements::tets(&rest, tets).expect("tetrahedra"), NeoHookean::new(fat()));
    let mass = Mass::new(rest.len()).with_tets(&body.elements, 1000.0);
    let load = Load::weight(&mass, DVec3::new(0.0, -9.81, 0.0));
    let potentials: [&dyn Potential; 3] = [&body, &load, &contact];
    let damping = Rayleigh { mass: 0.5, stiffness: 0.02 };
    let free = Free::new(rest.len(), &fixed);
    let mut motion = BackwardEuler::new(free, &potentials, mass, damping, Method::DIRECT).expect("memory");
    let mut state = State { x: rest.clone(), v: vec![DVec3::ZERO; rest.len()] };
    state.v[16..].fill(DVec3::new(0.0, -30.0, 0.0));
    let h = 1.0 / 30.0;
    for k in 0..90 {
        let to: Vec<DVec3> = state.x.iter().zip(&state.v).map(|(x, v)| *x + h * *v).collect();
        let found = motion.step(&potentials, &mut state, &to, h, Tolerance { step: 1e-7, iterations: 200 });
        assert!(found.converged && contact.crossings(&state.x) == 0, "{k}: {found:?}");
        assert!(state.x[16..].iter().all(|x| x.y > 0.0), "{k}: passed");
    }
    // Without friction it may slide.
    let fastest = state.v.iter().map(|v| v.y.abs()).fold(0.0, f64::max);
    let low = state.x[16..].iter().map(|x| x.y).fold(f64::INFINITY, f64::min);
    println!("after 3 s {fastest:.1e} m/s, {low} m above, {:?}", contact.closest(&state.x));
    assert!(fastest < 0.01 && low < 0.02, "{fastest} {low}");
    // What carries it is its weight, 0.032 m³ of water.
    let mut push = vec![DVec3::ZERO; rest.len()];
    contact.gradient(&state.x, &mut push);
    let carried: f64 = push[16..].iter().map(|g| -g.y).sum();
    assert!((carried / (32.0 * 9.81) - 1.0).abs() < 0.02, "{carried} N");
}
