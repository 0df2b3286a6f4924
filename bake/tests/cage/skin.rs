//! Weights and binding on toys whose answers are known.

use crate::solids::{cuboid, sphere};
use glam::{DMat4, DQuat, DVec3};
use sinew_bake::Model;
use sinew_bake::cage::weights::weights;
use sinew_bake::cage::{Body, Joining, Options, Resolution, Surface, voxels};
use sinew_bake::model::{Joint, Node, Primitive};

/// A box of 1 × 4 × 1 with two bones along it: weights run linearly from one to the other.
fn pillar() -> Model {
    let (low, high) = (DVec3::new(-0.5, 0.0, -0.5), DVec3::new(0.5, 4.0, 0.5));
    let (mut points, mut triangles) = cuboid(low, high);
    for _ in 0..4 {
        (points, triangles) = split(points, &triangles);
    }
    let node = |name: &str, parent, y| Node {
        name: name.into(),
        parent,
        translation: DVec3::Y * y,
        rotation: DQuat::IDENTITY,
        scale: DVec3::ONE,
    };
    let nodes = vec![node("lower", None, 0.0), node("upper", Some(0), 2.0), node("mesh", None, 0.0)];
    let joints = [0.0, -2.0]
        .iter()
        .enumerate()
        .map(|(node, y)| Joint { node, joint_from_bind: DMat4::from_translation(DVec3::Y * *y) })
        .collect();
    let weight = |p: &DVec3| p.as_vec3().y / 4.0;
    let primitive = Primitive {
        node: 2,
        normals: vec![[0.0, 1.0, 0.0]; points.len()],
        stride: 4,
        joints: points.iter().flat_map(|_| [0, 1, 0, 0]).collect(),
        weights: points.iter().flat_map(|p| [1.0 - weight(p), weight(p), 0.0, 0.0]).collect(),
        positions: points.iter().map(|p| p.as_vec3().to_array()).collect(),
        indices: triangles,
        ..Primitive::default()
    };
    Model { name: "pillar".into(), nodes, joints, primitives: vec![primitive], ..Model::default() }
}

/// Each triangle in four; corners are not shared.
fn split(points: Vec<DVec3>, triangles: &[[u32; 3]]) -> (Vec<DVec3>, Vec<[u32; 3]>) {
    let mut out = (Vec::new(), Vec::new());
    for t in triangles {
        let [a, b, c] = t.map(|i| points[i as usize]);
        let [ab, bc, ca] = [(a + b) / 2.0, (b + c) / 2.0, (c + a) / 2.0];
        for corners in [[a, ab, ca], [b, bc, ab], [c, ca, bc], [ab, bc, ca]] {
            let first = u32::try_from(out.0.len()).unwrap();
            out.0.extend(corners);
            out.1.push([first, first + 1, first + 2]);
        }
    }
    out
}

fn body(model: &Model, edge: f64) -> Body {
    Body::new(model, &Options { resolution: Resolution::Size(edge), ..Options::default() }).unwrap()
}

/// A linear function is harmonic. A node takes the weights of skin that is an edge away at most, so it is off by an edge
/// times the slope of the weights at most, and by the maximum principle so is what is inside.
#[test]
fn linear_weights_stay_linear_inside() {
    let model = pillar();
    let surface = Surface::new(&model).unwrap();
    let cage = voxels(&surface, Resolution::Size(0.1), Joining::Apart).unwrap();
    let found = weights(&surface, &cage);
    // The solve ends at a residual of 1e-13; weights of skin are single floats, made to sum to 1: 6e-8.
    assert!(found.defect < 1e-6 && found.least >= -1e-9, "{} {}", found.defect, found.least);
    for (p, row) in cage.rest.iter().zip(&found.rows) {
        let upper = row.iter().find(|(node, _)| *node == 1).map_or(0.0, |(_, w)| *w);
        assert!((upper - (p.y / 4.0).clamp(0.0, 1.0)).abs() <= 0.1 / 4.0 + 1e-6, "{p}: {upper}");
        assert!(row.iter().all(|(_, w)| *w > 0.0), "{p}: {row:?}");
    }
}

/// The middle line is bone: it is fixed; the skin is free; between, springs weaken outwards.
#[test]
fn the_bone_is_fixed_and_the_skin_is_free() {
    let body = body(&pillar(), 0.1);
    let holds = body.holds();
    let at = |x: f64, y: f64, z: f64| {
        let near = |p: &DVec3| p.distance_squared(DVec3::new(x, y, z));
        let i =
            (0..holds.len()).min_by(|a, b| near(&body.cage.rest[*a]).total_cmp(&near(&body.cage.rest[*b])));
        holds[i.unwrap()]
    };
    for y in [0.6, 1.0, 1.5, 2.5] {
        let out: Vec<f64> = [0.0, 0.1, 0.2, 0.3, 0.4, 0.5].iter().map(|x| at(*x, y, 0.0)).collect();
        assert!(out[0] >= 1.0 && out[2] >= 1.0, "{y}: {out:?}");
        assert!(out[3] > 0.0 && out[3] < 1.0 && out[5] <= 0.0, "{y}: {out:?}");
        assert!(out.is_sorted_by(|a, b| a >= b), "{y}: {out:?}");
    }
    assert!(at(0.0, 3.9, 0.0) <= 0.0, "beyond the bone's end");
}

/// Where cubes are large a bone still holds the corners around it.
#[test]
fn coarse_cubes_are_held_too() {
    let body = body(&pillar(), 0.4);
    let around = |p: &DVec3| p.x.hypot(p.z) < 0.3 && p.y > 0.3 && p.y < 3.0;
    let mut held = body.cage.rest.iter().zip(body.holds()).filter(|(p, _)| around(p));
    assert!(held.clone().count() > 20 && held.all(|(_, hold)| hold >= 1.0));
}

#[test]
fn paint_overrides() {
    let mut model = pillar();
    let count = model.primitives[0].positions.len();
    for (paint, outside) in [(0.0, 1.0), (0.25, 0.75), (1.0, 0.0)] {
        model.primitives[0].painted = Some(vec![paint; count]);
        let body = body(&model, 0.1);
        let bone = |p: &DVec3| p.x.hypot(p.z) < 0.15 && p.y > 0.6 && p.y < 2.7;
        for (p, hold) in body.cage.rest.iter().zip(body.holds()) {
            if bone(p) {
                assert!(hold >= 1.0, "{p}: {hold}");
            } else if p.x.hypot(p.z) > 0.45 {
                assert!((hold - outside).abs() < 1e-6, "{p}: {hold} of {outside}");
            }
        }
    }
    model.primitives[0].painted = Some(vec![1.5; count]);
    let error = Surface::new(&model).unwrap_err().to_string();
    assert!(error.contains("mesh 0, primitive 0, vertex 0") && error.contains("1.5"), "{error}");
}

#[test]
fn weights_on_missing_joints_are_refused() {
    let spoil: [fn(&mut Model); 3] = [
        |m| m.primitives[0].joints[4 * 7] = 9,
        |m| m.joints[1].node = 5,
        |m| m.primitives[0].weights[4 * 7..4 * 8].fill(0.0),
    ];
    for spoil in spoil {
        let mut model = pillar();
        spoil(&mut model);
        let error = Surface::new(&model).unwrap_err().to_string();
        assert!(error.starts_with("pillar: mesh 0, primitive 0, vertex "), "{error}");
        assert!(error.contains("joint that is missing") && error.ends_with("bind it to a joint"), "{error}");
    }
}

#[test]
fn a_surface_without_skin_has_a_cage_without_weights() {
    let (points, triangles) = sphere(3);
    let surface = Surface::plain("sphere", &points, &triangles).unwrap();
    let cage = voxels(&surface, Resolution::Vertices(500), Joining::Apart).unwrap();
    assert!(weights(&surface, &cage).rows.iter().all(Vec::is_empty));
}

/// The same model gives the same bits with any number of threads.
#[test]
fn threads_do_not_change_a_bit() {
    let model = sinew_bake::builtin::character();
    let with = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| Body::new(&model, &Options::default()).unwrap())
    };
    let (one, four) = (with(1), with(4));
    assert_eq!(one.cage, four.cage);
    assert_eq!(one.binding, four.binding);
    assert_eq!(one.places, four.places);
}
