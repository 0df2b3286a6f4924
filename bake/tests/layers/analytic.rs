//! Bodies whose layers are known.

use crate::body::{body, capsule};
use glam::DVec3;
use sinew_bake::cage::layers::{Layers, Settings};

/// Settings under which a capsule's bone wrap is a capsule of half the radius.
fn half() -> Settings {
    Settings { bone: 0.5, deepest: 1.0, muscle: Vec::new(), ..Settings::everywhere() }
}

/// On the cylinder all layers stand on the same normal: depth R/2, muscle half way.
#[test]
fn the_bone_of_a_capsule_is_half_as_wide() {
    let (points, triangles) = capsule(1.0, 0.2, 32);
    let model = body(&points, &triangles, &[DVec3::ZERO, DVec3::Y * 0.5, DVec3::Y]);
    let layers = Layers::new(&model, &half()).unwrap();
    let n = layers.columns();
    assert_eq!([n, layers.prisms.len()], [points.len(), 2 * triangles.len()]);
    for i in 0..n {
        let [bone, muscle, skin] = [0, 1, 2].map(|k| layers.rest[k * n + i]);
        assert!(((bone + skin) / 2.0).distance(muscle) < 1e-12, "{i}: {muscle}");
        if (0.25..0.75).contains(&skin.y) {
            let radius = DVec3::new(bone.x, 0.0, bone.z).length();
            // The march ends within 0.88⁶⁰ < 5e-4 of the way of 0.1 from its targets.
            assert!((radius - 0.1).abs() < 1e-4, "{i}: {radius}");
            // The caps are smoothed too, which is felt half way along: less than a tenth of a ring's distance.
            let turn = (bone.x * skin.z - bone.z * skin.x) / (0.1 * 0.2);
            assert!(turn.abs() < 1e-3 && (bone.y - skin.y).abs() < 0.006, "{i}: {bone} below {skin}");
        }
    }
    for (pieces, radius) in layers.section(DVec3::Y * 0.5, DVec3::Y).iter().zip([0.1, 0.15, 0.2]) {
        assert!(pieces.len() >= 32, "{}", pieces.len());
        for p in pieces.iter().flatten() {
            let r = libm::hypot(p.x, p.z);
            // A chord of one of 32 sides is cos(π/32) from the middle at least.
            assert!(
                (p.y - 0.5).abs() < 1e-12 && (0.995 * radius - 1e-4..radius + 1e-4).contains(&r),
                "{p}: {radius}"
            );
        }
    }
    let quality = layers.quality();
    assert_eq!([quality.inverted, quality.negative, quality.unsound, layers.unfolded], [0; 4]);
}

/// Sides that prisms share cancel: their volumes sum up to what is between the skin and the bone wrap.
#[test]
fn prisms_fill_what_is_between_skin_and_bone() {
    let (points, triangles) = capsule(1.0, 0.2, 24);
    let model = body(&points, &triangles, &[DVec3::ZERO, DVec3::Y * 0.5, DVec3::Y]);
    let layers = Layers::new(&model, &half()).unwrap();
    let n = layers.columns();
    let inside = |k: usize| {
        let at = |i: u32| layers.rest[i as usize - 2 * n + k * n];
        layers.skin.iter().map(|t| at(t[0]).dot(at(t[1]).cross(at(t[2]))) / 6.0).sum::<f64>()
    };
    let [_, sum] = layers.quality().volume;
    assert!((sum - (inside(2) - inside(0))).abs() < 1e-14, "{sum}");
    // Between cylinders of R and R/2, and half balls: three quarters and seven eighths of the whole.
    let whole = inside(2);
    assert!((0.74..0.88).contains(&(sum / whole)), "{}", sum / whole);
}

/// Thin parts: the upper half of the capsule is left to skinning, and the cage ends in fixed nodes.
#[test]
fn skinned_joints_have_no_layers() {
    let (points, triangles) = capsule(1.0, 0.2, 24);
    let model = body(&points, &triangles, &[DVec3::ZERO, DVec3::Y * 0.5]);
    let layers = Layers::new(&model, &Settings { skinned: vec!["*_1".to_owned()], ..half() }).unwrap();
    let n = layers.columns();
    let rim = layers.rest[2 * n..].iter().map(|p| p.y).fold(0.0, f64::max);
    assert!(rim < 0.5, "{rim}");
    for i in 0..n {
        let [bone, muscle, skin] = [0, 1, 2].map(|k| layers.fixed[k * n + i]);
        let at_end = layers.rest[2 * n + i].y > rim - 1e-6;
        assert_eq!([bone, muscle, skin], [true, at_end, at_end], "{i}");
    }
    for (vertex, column) in layers.column_of.iter().enumerate() {
        assert_eq!(column.is_some(), points[vertex].y < 0.5, "{vertex}");
        if let Some(c) = column {
            assert!(layers.rest[2 * n + *c as usize].distance(points[vertex]) < 1e-7, "{vertex}");
        }
    }
}
