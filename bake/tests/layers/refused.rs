//! Bodies that cannot have layers, and what is said of them.

use crate::body::{body, capsule};
use glam::DVec3;
use sinew_bake::Model;
use sinew_bake::cage::layers::{Layers, Settings};

const BONES: [DVec3; 3] = [DVec3::ZERO, DVec3::new(0.0, 0.5, 0.0), DVec3::Y];

fn refusal(model: &Model, settings: &Settings) -> String {
    Layers::new(model, settings).expect_err("a refusal").to_string()
}

#[test]
fn an_open_surface_is_refused_with_its_place() {
    let (points, mut triangles) = capsule(1.0, 0.2, 16);
    triangles.truncate(triangles.len() - 1);
    let error = refusal(&body(&points, &triangles, &BONES), &Settings::everywhere());
    assert!(error.contains("body: skin, near") && error.contains("3 open"), "{error}");
    assert!(error.contains("close the holes"), "{error}");
}

#[test]
fn bones_without_a_length_are_refused() {
    let (points, triangles) = capsule(1.0, 0.2, 16);
    let middle = points.iter().sum::<DVec3>() / f64::from(u32::try_from(points.len()).unwrap());
    // One joint where the middle of its skin is.
    let error = refusal(&body(&points, &triangles, &[middle]), &Settings::everywhere());
    assert!(error.contains("no bone has a length") && error.contains("rig the body"), "{error}");
}

#[test]
fn a_flat_body_is_refused() {
    let (points, triangles) = capsule(1.0, 0.2, 16);
    let flat: Vec<DVec3> = points.iter().map(|p| *p * DVec3::new(1.0, 1.0, 1e-5)).collect();
    let error = refusal(&body(&flat, &triangles, &BONES), &Settings::everywhere());
    assert!(error.contains("the body is flat") || error.contains("no part is closed"), "{error}");
}

#[test]
fn positions_that_are_no_numbers_are_refused() {
    let (points, triangles) = capsule(1.0, 0.2, 16);
    let mut model = body(&points, &triangles, &BONES);
    model.primitives[0].positions[17][1] = f32::NAN;
    assert!(refusal(&model, &Settings::everywhere()).contains("vertex 17"));
}

#[test]
fn a_body_that_is_thin_all_over_is_refused() {
    let (points, triangles) = capsule(1.0, 0.2, 16);
    let model = body(&points, &triangles, &BONES);
    let error = refusal(&model, &Settings { skinned: vec!["bone_*".to_owned()], ..Settings::default() });
    assert!(error.contains("nothing is left"), "{error}");
}

#[test]
fn no_triangles_are_refused() {
    let error = refusal(&body(&[DVec3::ZERO], &[], &BONES), &Settings::everywhere());
    assert!(error.contains("no triangle with an area"), "{error}");
}

/// A surface wound the other way round is turned, not refused: its layers are the same.
#[test]
fn an_inside_out_body_is_turned() {
    let (points, mut triangles) = capsule(1.0, 0.2, 16);
    let layers = Layers::new(&body(&points, &triangles, &BONES), &Settings::everywhere()).unwrap();
    triangles.iter_mut().for_each(|t| t.swap(1, 2));
    let turned = Layers::new(&body(&points, &triangles, &BONES), &Settings::everywhere()).unwrap();
    assert_eq!(turned, layers);
}
