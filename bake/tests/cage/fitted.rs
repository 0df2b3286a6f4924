//! Cages by isosurface stuffing.

use crate::shared;
use crate::solids::{moved, sphere, union};
use core::f64::consts::PI;
use glam::DVec3;
use sinew_bake::cage::{Body, Cage, Options, Resolution, Shape, Surface, stuffed};
use sinew_bake::import::import;

/// Smallest and largest dihedral angle of all tetrahedra, degrees.
fn angles(cage: &Cage) -> [f64; 2] {
    let mut out = [f64::INFINITY, 0.0_f64];
    for tet in &cage.tets {
        let p = tet.map(|i| cage.rest[i as usize]);
        // Normals of faces, outwards: the angle between two faces is π minus that of their normals.
        let faces = [[1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1]];
        let normals = faces.map(|[a, b, c]| (p[b] - p[a]).cross(p[c] - p[a]).normalize());
        for (i, j) in (0..4).flat_map(|i| (0..i).map(move |j| (i, j))) {
            let angle = libm::acos((-normals[i].dot(normals[j])).clamp(-1.0, 1.0)).to_degrees();
            out = [out[0].min(angle), out[1].max(angle)];
        }
    }
    out
}

/// No tetrahedron is inside out, and all angles are good.
fn check(name: &str, cage: &Cage) {
    let six = |tet: &[u32; 4]| {
        let [a, b, c, d] = tet.map(|i| cage.rest[i as usize]);
        (b - a).cross(c - a).dot(d - a)
    };
    assert!(cage.tets.iter().all(|tet| six(tet) > 0.0), "{name}");
    let [low, high] = angles(cage);
    println!("{name}: {} nodes, {} tets, {low:.2} to {high:.2} degrees", cage.rest.len(), cage.tets.len());
    // Labelle and Shewchuk 2007, table 1.
    assert!(low >= 10.78 && high <= 164.75, "{name}: {low} {high}");
}

/// The skin of a ball of radius 1 is at a distance of a quarter of an edge. What is cut of it is of second order:
/// chords of length up to √2 edges sag by l²/8, over the area of 4π.
#[test]
fn a_ball_is_fitted_closely() {
    let (points, triangles) = sphere(5);
    let surface = Surface::plain("ball", &points, &triangles).unwrap();
    for edge in [0.2, 0.1] {
        let cage = stuffed(&surface, Resolution::Size(edge)).unwrap();
        check("ball", &cage);
        let radius: f64 = 1.0 + 0.25 * edge;
        let full = 4.0 / 3.0 * PI * radius * radius * radius;
        let sag = 4.0 * PI * radius * radius * 2.0 * edge * edge / 8.0;
        let volume = cage.volume();
        assert!(volume < full + 1e-9 && volume > full - sag, "{volume} between {} and {full}", full - sag);
        assert_eq!(cage.components, 1);
        // Tetrahedra match: no node that is inside is on the boundary. Between two vertices `f` bends by l²/8r at most,
        // and the ball of triangles is 6e-4 short.
        for i in cage.boundary(&cage.tets).iter().flatten() {
            let off = cage.rest[*i as usize].length() - radius;
            assert!(off.abs() <= edge * edge / 8.0 / (1.0 - edge) + 6e-4, "node {i} is off by {off}");
        }
    }
}

#[test]
fn parts_stay_apart_and_are_counted() {
    let two = union([sphere(3), moved(sphere(3), DVec3::X * 3.0)]);
    let surface = Surface::plain("two", &two.0, &two.1).unwrap();
    let cage = stuffed(&surface, Resolution::Size(0.3)).unwrap();
    check("two", &cage);
    assert_eq!(cage.components, 2);
    assert!(cage.notes[0].contains("2 parts touch nowhere"), "{:?}", cage.notes);
}

#[test]
fn characters_are_fitted_with_good_angles() {
    let files =
        ["big-buck-bunny/bunny.glb", "makehuman/mh_f_heavy.glb", "khronos/Fox.glb", "sintel/sintel.glb"];
    for file in files {
        let Some(path) = shared(file) else { continue };
        let model = import(&path).unwrap();
        let size = Surface::new(&model).unwrap().size;
        let options =
            Options { shape: Shape::Fitted, resolution: Resolution::Size(size / 32.0), ..Options::default() };
        let begin = std::time::Instant::now();
        let body = Body::new(&model, &options).unwrap();
        println!("{:.2} s", begin.elapsed().as_secs_f64());
        check(file, &body.cage);
        assert!(!body.binding.fixed.is_empty() && body.places.len() == body.surface.points.len(), "{file}");
    }
}

#[test]
fn a_number_of_nodes_is_kept_to() {
    let (points, triangles) = sphere(3);
    let surface = Surface::plain("ball", &points, &triangles).unwrap();
    let cage = stuffed(&surface, Resolution::Vertices(800)).unwrap();
    assert!((500..=800).contains(&cage.rest.len()), "{}", cage.rest.len());
    for wrong in
        [Resolution::Size(0.0), Resolution::Size(f64::NAN), Resolution::Size(1e-4), Resolution::Vertices(3)]
    {
        let error = stuffed(&surface, wrong).unwrap_err().to_string();
        assert!(error.starts_with("ball: cage: ") && error.contains(';'), "{error}");
    }
}
