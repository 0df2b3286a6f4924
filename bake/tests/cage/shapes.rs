//! Winding numbers, repairs and lattices on shapes whose numbers are known.

use crate::solids::{Mesh, cuboid, moved, obj, sphere, union};
use crate::{Random, shared};
use glam::DVec3;
use sinew_bake::cage::embed::embed;
use sinew_bake::cage::{Cage, Joining, Resolution, Surface, voxels};
use sinew_bake::import::import;

fn plain((points, triangles): &Mesh) -> Surface {
    Surface::plain("shape", points, triangles).unwrap()
}

fn cage(mesh: &Mesh, edge: f64, joining: Joining) -> Cage {
    voxels(&plain(mesh), Resolution::Size(edge), joining).unwrap()
}

/// The figures of Deep Emulator's data: an 11×11×11 lattice over a sphere of radius 1.
#[test]
fn the_sphere_of_deep_emulator_comes_out() {
    let cage = cage(&sphere(5), 0.2, Joining::Apart);
    assert_eq!([cage.tets.len(), cage.rest.len()], [4320, 1015], "720 cubes of six");
    assert!((cage.volume() - 720.0 * 0.008).abs() < 1e-12, "{}", cage.volume());
    let mut neighbors = vec![std::collections::BTreeSet::<u32>::new(); cage.rest.len()];
    for tet in &cage.tets {
        for i in tet {
            neighbors[*i as usize].extend(tet.iter().copied().filter(|j| j != i));
        }
    }
    let middle = cage.rest.iter().position(|p| p.length() < 1e-12).unwrap();
    assert_eq!(neighbors[middle].len(), 14, "inside, every node has 14 neighbors");
    let axial = cage.links.iter().filter(|l| l.contains(&u32::try_from(middle).unwrap())).count();
    assert_eq!(axial, 6, "of which 6 are along the axes");
    let faces = cage.boundary(&cage.tets);
    // A closed surface of genus 0: V − E + F = 2, E = 3F/2.
    let mut on: Vec<u32> = faces.iter().flatten().copied().collect();
    on.sort_unstable();
    on.dedup();
    assert_eq!(on.len(), 2 + faces.len() / 2, "boundary faces match");
}

/// Of all kinds of files: 80 points each in the box of the body, close to the skin too.
#[test]
fn winding_by_groups_is_the_direct_sum() {
    let files = ["big-buck-bunny/bunny.glb", "godette-vrm/Godette_vrm_v4.vrm", "kaykit/Mage.glb"];
    let files =
        files.into_iter().chain(["khronos/CesiumMan.glb", "khronos/Fox.glb", "khronos/RiggedFigure.gltf"]);
    let files = files.chain(["makehuman/mh_f_heavy.glb", "mesh2motion/fox.glb", "mesh2motion/horse.glb"]);
    let files = files.chain(["mesh2motion/panda.glb", "quaternius/Alpaca.glb", "quaternius/Formal.glb"]);
    let files = files.chain(["quaternius/Puffer.glb", "quaternius/Rat.glb", "sintel/sintel.glb"]);
    let mut random = Random(1);
    for file in files {
        let Some(path) = shared(file) else { continue };
        let surface = Surface::new(&import(&path).unwrap()).unwrap();
        let (low, high) = surface.bounds();
        let mut worst: f64 = 0.0;
        for i in 0..80 {
            let mut p = random.point(low, high);
            if i % 2 == 0 {
                p = surface.nearest(p).point.lerp(p, 0.05);
            }
            worst = worst.max((surface.winding(p) - surface.winding_exact(p)).abs());
        }
        println!("{file}: {worst:.1e}");
        assert!(worst <= 0.015, "{file}: {worst}");
    }
}

#[test]
fn winding_counts_the_layers_of_overlapping_parts() {
    let two = plain(&union([sphere(3), moved(sphere(3), DVec3::new(1.0, 0.0, 0.0))]));
    for (x, layers) in [(-0.7, 1.0), (0.5, 2.0), (1.7, 1.0), (2.5, 0.0), (-1.5, 0.0)] {
        let p = DVec3::new(x, 0.05, -0.02);
        // Closed: a whole number, but for the sum of some 1000 angles of rounding 1e-15.
        assert!((two.winding_exact(p) - layers).abs() < 1e-12, "{x}: {}", two.winding_exact(p));
        assert!((two.winding(p) - layers).abs() < 0.015, "{x}: {}", two.winding(p));
    }
}

/// A hemisphere without its disk: at the middle of the rim half of all directions are covered.
#[test]
fn an_open_surface_has_the_share_of_directions_that_it_covers() {
    let (points, triangles) = sphere(5);
    let up = |t: &[u32; 3]| t.iter().all(|i| points[*i as usize].z >= 0.0);
    let half: Vec<[u32; 3]> = triangles.into_iter().filter(up).collect();
    let surface = Surface::plain("dome", &points, &half).unwrap();
    assert!((surface.winding_exact(DVec3::ZERO) - 0.5).abs() < 1e-12, "by symmetry");
    // The solid angle of a disk from height h: 2π (1 − h/√(1+h²)); the dome's inside sees the rest of 4π.
    let h: f64 = 0.5;
    let want = 1.0 - 0.5 * (1.0 - h / (1.0 + h * h).sqrt());
    // The rim is a polygon of 128 sides: its area is short by 4e-4 of the disk's.
    assert!((surface.winding_exact(DVec3::new(0.0, 0.0, h)) - want).abs() < 4e-4);
    assert!(
        surface.notes.iter().any(|n| n.starts_with("128 edges have one triangle")),
        "{:?}",
        surface.notes
    );
}

#[test]
fn the_nearest_point_is_the_nearest_of_all_triangles() {
    let Some(path) = shared("volumes/spot.obj") else { return };
    let mesh = obj(&std::fs::read_to_string(path).unwrap());
    let surface = plain(&mesh);
    let (low, high) = surface.bounds();
    let mut random = Random(2);
    for _ in 0..100 {
        let p = random.point(low, high);
        let near = surface.nearest(p);
        assert!((near.at.iter().sum::<f64>() - 1.0).abs() < 1e-12 && near.at.iter().all(|w| *w >= 0.0));
        assert!((near.point.distance(p) - near.distance).abs() < 1e-12);
        // No sample of any triangle is nearer.
        for t in &surface.triangles {
            let [a, b, c] = t.map(|i| surface.points[i as usize]);
            for q in [a, b, c, (a + b) / 2.0, (b + c) / 2.0, (c + a) / 2.0, (a + b + c) / 3.0] {
                assert!(q.distance(p) >= near.distance - 1e-12, "{p}");
            }
        }
    }
}

#[test]
fn bodies_inside_out_and_parts_of_them_are_turned() {
    let (points, triangles) = sphere(3);
    let mut mixed: Vec<[u32; 3]> = triangles.iter().map(|[a, b, c]| [*a, *c, *b]).collect();
    for t in mixed.iter_mut().step_by(7) {
        t.swap(0, 1);
    }
    let want = Surface::plain("sphere", &points, &triangles).unwrap();
    let surface = Surface::plain("sphere", &points, &mixed).unwrap();
    assert!(want.notes.is_empty() && surface.notes.len() == 2, "{:?}", surface.notes);
    assert!((surface.winding_exact(DVec3::ZERO) - 1.0).abs() < 1e-12);
    let two = plain(&union([sphere(2), moved((points, mixed), DVec3::X * 3.0)]));
    assert!((two.winding_exact(DVec3::X * 3.0) - 1.0).abs() < 1e-12, "each part by itself");
}

#[test]
fn dirty_triangles_are_left_out_and_nothing_else_changes() {
    let (mut points, mut triangles) = sphere(3);
    let want = cage(&(points.clone(), triangles.clone()), 0.25, Joining::Apart);
    triangles.extend([
        [3, 3, 5],
        [0, 1, 1],
        triangles[5],
        [triangles[9][2], triangles[9][1], triangles[9][0]],
    ]);
    // A seam: a triangle with corners of its own.
    let first = u32::try_from(points.len()).unwrap();
    points.extend(triangles[0].map(|i| points[i as usize]));
    triangles[0] = [first, first + 1, first + 2];
    // A vertex of no triangle.
    points.push(DVec3::splat(100.0));
    let surface = Surface::plain("sphere", &points, &triangles).unwrap();
    assert_eq!(voxels(&surface, Resolution::Size(0.25), Joining::Apart).unwrap(), want);
    let notes = surface.notes.join("; ");
    for part in ["2 triangles without area", "2 triangles are there twice", "1 vertices have no triangle"] {
        assert!(notes.contains(part), "{notes}");
    }
    // A fin: an edge of three triangles.
    points.push(DVec3::splat(0.9));
    let tip = u32::try_from(points.len()).unwrap() - 1;
    let [a, b, _] = triangles[20];
    triangles.push([a, b, tip]);
    let surface = Surface::plain("fin", &points, &triangles).unwrap();
    assert!(surface.notes.iter().any(|n| n == "1 edges have more than two triangles"), "{:?}", surface.notes);
    assert!((surface.winding_exact(DVec3::ZERO) - 1.0).abs() < 0.02, "the fin takes a small solid angle");
}

#[test]
fn unusable_surfaces_are_refused_in_a_line() {
    let (points, triangles) = cuboid(DVec3::ZERO, DVec3::ONE);
    let refused = |points: &[DVec3], triangles: &[[u32; 3]], part: &str| {
        let error = Surface::plain("thing", points, triangles).unwrap_err().to_string();
        assert!(error.starts_with("thing: ") && error.contains(part) && !error.contains('\n'), "{error}");
    };
    refused(&points, &[], "no triangles");
    refused(&[], &[], "no triangles");
    refused(&points, &[[0, 1, 8]], "vertex 8 of 8");
    refused(&points[..3], &[[0, 1, 2]], "flat");
    let slope: Vec<DVec3> = points.iter().map(|p| DVec3::new(p.x, p.y, 2.0 * p.x - p.y)).collect();
    refused(&slope, &triangles, "flat");
    refused(&points.iter().map(|p| *p * DVec3::X).collect::<Vec<_>>(), &triangles, "flat");
    refused(&[DVec3::ONE; 8], &triangles, "one point");
    for wrong in [f64::NAN, f64::INFINITY, 1e300] {
        let mut points = points.clone();
        points[6].y = wrong;
        let part =
            if wrong.is_finite() { "one point" } else { "vertex 6: its rest position is not a finite" };
        refused(&points, &triangles, part);
    }
    let surface = plain(&(points, triangles));
    for (resolution, part) in [
        (Resolution::Size(1e-4), "too small"),
        (Resolution::Size(0.0), "too small"),
        (Resolution::Size(-1.0), "too small"),
        (Resolution::Size(f64::NAN), "too small"),
        (Resolution::Vertices(7), "no cage has 7 nodes"),
        (Resolution::Vertices(0), "no cage has 0 nodes"),
    ] {
        let error = voxels(&surface, resolution, Joining::Apart).unwrap_err().to_string();
        assert!(error.contains(part), "{resolution:?}: {error}");
    }
    assert_eq!(voxels(&surface, Resolution::Vertices(8), Joining::Apart).unwrap().tets.len(), 6);
}

/// Sides of a box in the planes of the lattice make no cubes outside of it.
#[test]
fn a_box_of_whole_cubes_is_filled_exactly() {
    let cage = cage(&cuboid(DVec3::ZERO, DVec3::new(4.0, 3.0, 2.0)), 1.0, Joining::Apart);
    assert_eq!([cage.tets.len(), cage.rest.len(), cage.components], [6 * 24, 5 * 4 * 3, 1]);
    assert!(cage.rest.iter().zip(cage.rest.iter().skip(1)).all(|(a, b)| (a.z, a.y, a.x) < (b.z, b.y, b.x)));
}

/// The tip of an octahedron ends in a corner of the lattice: it touches no cube beyond.
#[test]
fn a_point_on_the_side_of_a_cube_does_not_touch_it() {
    let box_and_tips =
        union([cuboid(DVec3::ZERO, DVec3::new(1.7, 2.0, 2.0)), moved(sphere(0), DVec3::new(5.0, 1.0, 1.0))]);
    let cage = cage(&box_and_tips, 1.0, Joining::Apart);
    assert_eq!([cage.tets.len(), cage.components], [6 * 16, 2], "eight cubes each");
}

/// A sheet that lies between cubes is inside of the cage too.
#[test]
fn a_sheet_in_a_plane_of_the_lattice_is_enclosed() {
    let [a, b, c, d] = [[2.0, 0.0], [4.0, 0.0], [4.0, 2.0], [2.0, 2.0]].map(|[x, z]| DVec3::new(x, 1.0, z));
    let sheet = (vec![a, b, c, d], vec![[0, 1, 2], [0, 2, 3]]);
    let surface = plain(&union([cuboid(DVec3::ZERO, DVec3::splat(2.0)), sheet]));
    let cage = voxels(&surface, Resolution::Size(1.0), Joining::Apart).unwrap();
    assert_eq!([cage.tets.len(), cage.components], [6 * 16, 1], "cubes on both sides of it");
    assert!(embed("sheet", &cage, &surface.points).is_ok());
}

#[test]
fn parts_that_overlap_are_one_and_others_are_bridged_or_apart() {
    let ball = |x: f64| moved(sphere(3), DVec3::new(x, 0.1 * x, 0.0));
    let eight = union((0..8).map(|i| ball(1.5 * f64::from(i))));
    assert_eq!(cage(&eight, 0.2, Joining::Apart).components, 1);
    let far = union([ball(0.0), ball(4.0), ball(9.0)]);
    let apart = cage(&far, 0.25, Joining::Apart);
    assert_eq!(apart.components, 3);
    assert!(apart.notes[0].contains("3 parts touch nowhere"), "{:?}", apart.notes);
    let bridged = cage(&far, 0.25, Joining::Bridged);
    assert_eq!(bridged.components, 1);
    // Gaps of 2 and 3 between spheres whose middles differ by a tenth of it in y: steps along x alone.
    let added = (bridged.tets.len() - apart.tets.len()) / 6;
    assert!((8 + 12 - 4..=8 + 12 + 2).contains(&added), "{added} cubes: {:?}", bridged.notes);
}

/// Finer cages enclose the body more closely: the volume tends to the body's from above, with the edge.
#[test]
fn volumes_tend_to_the_volume_of_the_body() {
    let (points, triangles) = sphere(5);
    let body: f64 = triangles
        .iter()
        .map(|[a, b, c]| points[*a as usize].dot(points[*b as usize].cross(points[*c as usize])) / 6.0)
        .sum();
    let excess =
        |edge| cage(&(points.clone(), triangles.clone()), edge, Joining::Apart).volume() / body - 1.0;
    let [coarse, fine] = [excess(0.2), excess(0.05)];
    assert!(coarse > 0.0 && fine > 0.0 && (2.5..6.0).contains(&(coarse / fine)), "{coarse} {fine}");
}

#[test]
fn cages_follow_scale_and_place() {
    let Some(path) = shared("volumes/elephant.obj") else { return };
    let (points, triangles) = obj(&std::fs::read_to_string(path).unwrap());
    let size = plain(&(points.clone(), triangles.clone())).size;
    let want = cage(&(points.clone(), triangles.clone()), size / 40.0, Joining::Bridged);
    for scale in [0.0078125, 128.0] {
        let mesh = (points.iter().map(|p| *p * scale).collect(), triangles.clone());
        assert_eq!(cage(&mesh, scale * size / 40.0, Joining::Bridged).tets, want.tets, "{scale}");
    }
}

#[test]
fn a_million_triangles_are_practical() {
    let (points, triangles) = sphere(8); // 524,288
    let mesh = union([(points.clone(), triangles.clone()), moved((points, triangles), DVec3::X * 1.5)]);
    let begin = std::time::Instant::now();
    let surface = plain(&mesh);
    let built = begin.elapsed();
    let cage = voxels(&surface, Resolution::Size(0.15), Joining::Apart).unwrap();
    println!("{} triangles: {built:?} + {:?}", surface.triangles.len(), begin.elapsed() - built);
    assert!(surface.triangles.len() > 1_048_000 && cage.components == 1);
    // A sanity bound for an unoptimised build on a busy machine, not a figure.
    assert!(begin.elapsed().as_secs() < 60, "{:?}", begin.elapsed());
}
