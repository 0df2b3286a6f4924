//! Bodies with known answers, and the shared ones.

use glam::{DMat4, DQuat, DVec3};
use sinew_bake::Model;
use sinew_bake::import::import;
use sinew_bake::model::{Joint, Node, Primitive};
use std::path::Path;

const DATA: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../shared/data/makehuman");

/// The bodies of one topology.
pub(crate) const MAKEHUMAN: [&str; 5] =
    ["mh_f_average", "mh_f_curvy", "mh_f_heavy", "mh_m_average", "mh_m_heavy"];

/// A shared body; `None`, with a message, where the data is not at hand.
pub(crate) fn makehuman(name: &str) -> Option<Model> {
    let path = Path::new(DATA).join(name).with_extension("glb");
    if path.exists() {
        return Some(import(&path).unwrap_or_else(|e| panic!("{e}")));
    }
    assert!(std::env::var("CI").as_deref() != Ok("true"), "{} is missing", path.display());
    println!("skipped: {} is not there", path.display());
    None
}

/// A body of one mesh and a chain of joints; each point belongs to the joint below it in `y`.
pub(crate) fn body(points: &[DVec3], triangles: &[[u32; 3]], joints: &[DVec3]) -> Model {
    let mut model = Model { name: "body".to_owned(), ..Model::default() };
    for (i, place) in joints.iter().enumerate() {
        let above = if i == 0 { DVec3::ZERO } else { joints[i - 1] };
        model.nodes.push(Node {
            name: format!("bone_{i}"),
            parent: i.checked_sub(1),
            translation: *place - above,
            rotation: DQuat::IDENTITY,
            scale: DVec3::ONE,
        });
        model.joints.push(Joint { node: i, joint_from_bind: DMat4::from_translation(-*place) });
    }
    #[expect(clippy::cast_possible_truncation, reason = "positions of the format")]
    let positions: Vec<[f32; 3]> = points.iter().map(|p| p.to_array().map(|x| x as f32)).collect();
    let owner = |p: &DVec3| joints.iter().rposition(|j| j.y <= p.y).unwrap_or(0);
    let row = |p: &DVec3| [u16::try_from(owner(p)).unwrap(), 0, 0, 0];
    model.primitives.push(Primitive {
        normals: vec![[0.0, 1.0, 0.0]; positions.len()],
        stride: 4,
        joints: points.iter().flat_map(row).collect(),
        weights: points.iter().flat_map(|_| [1.0, 0.0, 0.0, 0.0]).collect(),
        indices: triangles.to_vec(),
        positions,
        ..Primitive::default()
    });
    model
}

/// A capsule along `y` from 0 to `length`, of the given radius: `around` points on each of its rings.
pub(crate) fn capsule(length: f64, radius: f64, around: u32) -> (Vec<DVec3>, Vec<[u32; 3]>) {
    // Rings from pole to pole: the cap below, the cylinder, the cap above.
    let caps = around / 4;
    let mut rings = Vec::new();
    for i in 1..=caps {
        let (sin, cos) = libm::sincos(core::f64::consts::FRAC_PI_2 * f64::from(i) / f64::from(caps));
        rings.push((-radius * cos, radius * sin));
    }
    let steps = 2 * caps;
    rings.extend((1..steps).map(|i| (length * f64::from(i) / f64::from(steps), radius)));
    rings.extend(
        (0..caps).map(|i| rings[(caps - 1 - i) as usize]).map(|(y, r)| (length - y, r)).collect::<Vec<_>>(),
    );
    let mut points = vec![DVec3::new(0.0, -radius, 0.0)];
    for (y, r) in &rings {
        points.extend((0..around).map(|i| {
            let (sin, cos) = libm::sincos(core::f64::consts::TAU * f64::from(i) / f64::from(around));
            DVec3::new(r * sin, *y, r * cos)
        }));
    }
    points.push(DVec3::new(0.0, length + radius, 0.0));
    let last = u32::try_from(points.len() - 1).unwrap();
    let count = u32::try_from(rings.len()).unwrap();
    let at = |ring: u32, i: u32| 1 + ring * around + i % around;
    let mut triangles = Vec::new();
    for i in 0..around {
        triangles.push([0, at(0, i + 1), at(0, i)]);
        triangles.push([last, at(count - 1, i), at(count - 1, i + 1)]);
        for ring in 0..count - 1 {
            triangles.push([at(ring, i), at(ring, i + 1), at(ring + 1, i)]);
            triangles.push([at(ring + 1, i), at(ring, i + 1), at(ring + 1, i + 1)]);
        }
    }
    (points, triangles)
}
