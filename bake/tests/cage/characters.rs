//! Every character file of the shared data, with what its cage must be.

use crate::{Random, shared};
use glam::DVec3;
use sinew_bake::cage::embed::{Packed, Place, apply, packing_error};
use sinew_bake::cage::{Body, Options, Resolution};
use sinew_bake::import::import;

/// Nodes that are asked for.
const NODES: usize = 1200;

/// What a file must give: a cage of one body, or a reason that names this.
#[derive(Clone, Copy, Debug)]
enum Want {
    Cage,
    Refused(&'static str),
}
use Want::{Cage, Refused};

const FLAT: Want = Refused("flat");
const SKIN: Want = Refused("no mesh has a skin");

const FILES: [(&str, Want); 39] = [
    ("asset-generator/Animation_SkinType_00.gltf", Cage),
    ("asset-generator/Animation_SkinType_01.gltf", Cage),
    ("asset-generator/Animation_Skin_00.gltf", Cage),
    ("asset-generator/Animation_Skin_01.gltf", Cage),
    ("asset-generator/Animation_Skin_02.gltf", Cage),
    ("asset-generator/Animation_Skin_03.gltf", Cage),
    ("asset-generator/Animation_Skin_04.gltf", Cage),
    ("asset-generator/Animation_Skin_05.gltf", Cage),
    ("asset-generator/Buffer_Interleaved_00.gltf", SKIN),
    ("asset-generator/Buffer_Interleaved_01.gltf", SKIN),
    ("big-buck-bunny/bunny.glb", Cage),
    ("big-buck-bunny/bunny_animated.glb", Cage),
    ("godette-vrm/Godette_vrm_v4.vrm", Cage),
    ("kaykit/Mage.glb", Cage),
    ("khronos/CesiumMan.glb", Cage),
    ("khronos/Fox.glb", Cage),
    ("khronos/MorphStressTest.gltf", SKIN),
    ("khronos/RiggedFigure.gltf", Cage),
    ("khronos/RiggedSimple.gltf", Cage),
    ("khronos/SimpleSkin.gltf", FLAT),
    ("makehuman/mh_f_average.glb", Cage),
    ("makehuman/mh_f_curvy.glb", Cage),
    ("makehuman/mh_f_heavy.glb", Cage),
    ("makehuman/mh_m_average.glb", Cage),
    ("makehuman/mh_m_heavy.glb", Cage),
    ("mesh2motion/fox.glb", Cage),
    ("mesh2motion/horse.glb", Cage),
    ("mesh2motion/panda.glb", Cage),
    ("quaternius/Alpaca.glb", Cage),
    ("quaternius/Formal.glb", Cage),
    ("quaternius/Puffer.glb", Cage),
    ("quaternius/Rat.glb", Cage),
    ("sintel/sintel.glb", Cage),
    ("sintel/sintel_animated.glb", Cage),
    ("vrm1-springbone/smoke_spring.vrm", Cage),
    ("vrm1-springbone/springbone_collider_capsule_x0p02_r0p05.vrm", Cage),
    ("vrm1-springbone/springbone_collider_sphere_x0p02_r0p05.vrm", Cage),
    ("vrm1-springbone/swing_springbone_stiffness_0p2.vrm", Cage),
    ("vrm1-springbone/swing_springbone_stiffness_0p8.vrm", Cage),
];

#[test]
fn every_file_gives_a_cage_or_a_reason() {
    for (file, want) in FILES {
        let Some(path) = shared(file) else { continue };
        let options = Options { resolution: Resolution::Vertices(NODES), ..Options::default() };
        let begin = std::time::Instant::now();
        match (import(&path).and_then(|model| Body::new(&model, &options)), want) {
            (Ok(body), Cage) => {
                let seconds = begin.elapsed().as_secs_f64();
                let (cage, binding) = (&body.cage, &body.binding);
                println!(
                    "{file}: {} triangles, {} cubes, {} nodes, {} tets, {} part, {} fixed, {} pulled, {seconds:.2} s",
                    body.surface.triangles.len(),
                    cage.tets.len() / 6,
                    cage.rest.len(),
                    cage.tets.len(),
                    cage.components,
                    binding.fixed.len(),
                    binding.springs.len(),
                );
                check(file, &body);
            }
            (Err(error), Refused(reason)) => {
                let text = error.to_string();
                assert!(text.contains(reason) && text.contains(';'), "{file}: {text}");
            }
            (result, _) => panic!("{file}: {want:?} expected, {:?} found", result.map(|b| b.cage.rest.len())),
        }
    }
}

#[test]
fn no_shared_file_is_forgotten() {
    let Some(root) = shared(".") else { return };
    let mut found = Vec::new();
    for folder in std::fs::read_dir(&root).unwrap().map(|f| f.unwrap().path()).filter(|f| f.is_dir()) {
        for file in std::fs::read_dir(&folder).unwrap().map(|f| f.unwrap().path()) {
            if file.extension().is_some_and(|e| e == "glb" || e == "gltf" || e == "vrm") {
                found.push(file.strip_prefix(&root).unwrap().to_str().unwrap().to_owned());
            }
        }
    }
    found.sort_unstable();
    assert_eq!(found, FILES.map(|(file, _)| file));
}

/// What holds of every body.
fn check(file: &str, body: &Body) {
    let cage = &body.cage;
    let [n, edge] = [cage.rest.len() as f64, cage.edge];
    assert!(n <= NODES as f64 && n >= 0.8 * NODES as f64, "{file}: {n} nodes");
    assert_eq!(cage.components, 1, "{file}");
    for tet in &cage.tets {
        let [a, b, c, d] = tet.map(|i| cage.rest[i as usize]);
        let six = (b - a).cross(c - a).dot(d - a);
        // Coordinates are rounded to 2⁻⁵³ of the body and there are some tens of edges in it.
        assert!((six / (edge * edge * edge) - 1.0).abs() < 1e-12, "{file}: {six}");
    }
    embedding(file, body);
    for (i, row) in body.binding.weights.iter().enumerate() {
        assert!(!row.is_empty() && row.iter().all(|(_, w)| *w > 0.0), "{file}: node {i}: {row:?}");
        assert!((row.iter().map(|(_, w)| w).sum::<f64>() - 1.0).abs() < 1e-12, "{file}: node {i}");
    }
    let binding = &body.binding;
    assert!(!binding.fixed.is_empty(), "{file}: nothing is fixed");
    assert!(binding.fixed.is_sorted_by(|a, b| a < b), "{file}");
    assert!(binding.springs.is_sorted_by(|a, b| a.0 < b.0), "{file}");
    let free_of = |i: &u32| binding.fixed.binary_search(i).is_err();
    assert!(binding.springs.iter().all(|(i, h)| free_of(i) && *h > 0.0 && *h < 1.0), "{file}");
}

/// Points are where they were, and go with an affine map of the nodes; packing errs as little as promised.
fn embedding(file: &str, body: &Body) {
    let (cage, size) = (&body.cage, body.surface.size);
    let off = |nodes: &[DVec3], map: &dyn Fn(DVec3) -> DVec3| {
        let moved = apply(cage, &body.places, nodes);
        moved.iter().zip(&body.surface.points).map(|(x, p)| x.distance(map(*p))).fold(0.0, f64::max)
    };
    for place in &body.places {
        assert!(place.weights.iter().all(|w| *w >= -1e-9), "{file}: {place:?}");
        assert!((place.weights.iter().sum::<f64>() - 1.0).abs() < 1e-14, "{file}: {place:?}");
    }
    // Barycentric weights are rounded to some 2⁻⁵² of body size by edge.
    assert!(off(&cage.rest, &|p| p) < 1e-13 * size, "{file}");
    let turn = glam::DMat3::from_cols_array(&[0.3, -1.0, 2.0, 0.5, 0.0, -0.7, 1.1, 0.4, -0.2]);
    let map = |p: DVec3| turn * p + DVec3::new(0.1, -2.0, 3.0) * size;
    let nodes: Vec<DVec3> = cage.rest.iter().map(|p| map(*p)).collect();
    assert!(off(&nodes, &map) < 1e-12 * size, "{file}");
    // The longest edges of a cube's tetrahedra are its diagonals.
    let bound = 1.5 / 65535.0 * 3.0_f64.sqrt() * cage.edge;
    let error = packing_error(cage, &body.places, &cage.rest);
    assert!(error <= bound && error > 0.2 * bound, "{file}: {error} {bound}");
}

#[test]
fn packed_places_come_out_of_their_bytes() {
    let mut random = Random(5);
    for tet in [0, 7, u32::MAX] {
        let [a, b, c] = [random.next(), random.next(), random.next()].map(|x| x / 3.0);
        let packed = Packed::from(Place { tet, weights: [1.0 - a - b - c, a, b, c] });
        assert_eq!(Packed::from_bytes(packed.to_bytes()), packed);
        assert_eq!(Packed::from(Place::from(packed)), packed);
    }
    let bytes = Packed { tet: 0x0403_0201, weights: [0x0605, 0x0807, 0x0a09] }.to_bytes();
    assert_eq!(bytes, [1, 2, 3, 4, 5, 6, 7, 8, 9, 10], "little-endian, in order");
}
