//! Where the flesh of each character of the shared data is.

use glam::DVec3;

use super::{auto, character, extreme, from_corner, places, softest};

#[test]
fn foxes_have_soft_tails_and_ears_and_rigid_paws() {
    for file in ["khronos/Fox.glb", "mesh2motion/fox.glb"] {
        let Some(model) = character(file) else { continue };
        let flesh = auto(&model);
        let places = places(&model, &flesh);
        assert!(extreme(&places, DVec3::NEG_Z) > 0.9, "{file}: tip of the tail");
        assert!(extreme(&places, DVec3::Y) > 0.5, "{file}: tip of an ear");
        assert!(softest(&places, |p| p.y < 0.04) == 0.0, "{file}: paws");
        assert!(extreme(&places, DVec3::Z) == 0.0, "{file}: nose");
        assert!(softest(&places, |p| p.z.abs() < 0.1 && p.y < 0.3) > 0.5, "{file}: belly");
        let names: Vec<&str> = flesh.regions.iter().map(|r| r.name.as_str()).collect();
        assert!(names.contains(&"tail") && names.contains(&"ear"), "{file}: {names:?}");
    }
}

#[test]
fn the_bunny_has_a_soft_belly_and_ears_and_rigid_hands_feet_and_face() {
    let Some(model) = character("big-buck-bunny/bunny.glb") else { return };
    let places = places(&model, &auto(&model));
    let belly = places.iter().filter(|(p, _)| (0.2..0.3).contains(&p.y) && p.x.abs() < 0.03 && p.z > 0.1);
    assert!(belly.map(|(_, s)| *s).fold(1.0, f32::min) > 0.8, "belly");
    assert!(extreme(&places, DVec3::Y) > 0.8, "tip of an ear");
    assert!(softest(&places, |p| p.x.abs() > 0.22) == 0.0, "hands");
    assert!(softest(&places, |p| p.y < 0.03) == 0.0, "feet");
    assert!(softest(&places, |p| (0.47..0.55).contains(&p.y) && p.x.abs() < 0.1 && p.z > 0.1) == 0.0, "face");
}

#[test]
fn a_rat_has_soft_ears_though_they_hang_on_its_neck() {
    let Some(model) = character("quaternius/Rat.glb") else { return };
    let flesh = auto(&model);
    let places = from_corner(&places(&model, &flesh));
    let ear = |p: DVec3| p.y > 0.24 && p.z > 0.72;
    assert!(softest(&places, |p| ear(p) && p.x < 0.1) > 0.5, "right ear");
    assert!(softest(&places, |p| ear(p) && p.x > 0.1) > 0.5, "left ear");
    assert!(
        softest(&places, |p| p.y > 0.253 && p.z > 0.72) > softest(&places, |p| ear(p) && p.y < 0.245),
        "tip"
    );
    assert!(softest(&places, |p| p.z > 0.84) == 0.0, "snout");
    assert!(softest(&places, |p| p.y < 0.01 && p.z > 0.4) == 0.0, "feet");
    assert!(flesh.regions.iter().any(|r| r.name == "ear"), "{:?}", flesh.regions);
}

#[test]
fn ears_of_people_are_a_little_soft_and_their_faces_rigid() {
    for body in ["f_average", "f_curvy", "f_heavy", "m_average", "m_heavy"] {
        let Some(model) = character(&format!("makehuman/mh_{body}.glb")) else { continue };
        let places = places(&model, &auto(&model));
        let head = |p: DVec3| p.y > 0.74;
        let ears = softest(&places, |p| head(p) && p.x.abs() > 0.033);
        assert!((0.05..0.4).contains(&ears), "{body}: ears {ears}");
        assert!(softest(&places, |p| head(p) && p.x.abs() < 0.028) == 0.0, "{body}: face");
    }
}

#[test]
fn a_puffer_is_a_body_with_a_tail() {
    let Some(model) = character("quaternius/Puffer.glb") else { return };
    let flesh = auto(&model);
    let places = from_corner(&places(&model, &flesh));
    let middle = |p: DVec3| (0.2..0.36).contains(&p.x);
    assert!(softest(&places, |p| middle(p) && p.y < 0.08 && p.z > 0.3) > 0.8, "belly");
    assert!(softest(&places, |p| middle(p) && p.z < 0.05) > 0.9, "tail fin");
    let names: Vec<&str> = flesh.regions.iter().map(|r| r.name.as_str()).collect();
    assert_eq!(names, ["flesh", "tail"], "regions");
    let body = flesh.region.iter().zip(&flesh.softness).filter(|(r, s)| **r == 0 && **s > 0.0).count();
    assert!(2 * body > flesh.region.len(), "only {body} vertices of flesh");
}

#[test]
fn ears_of_a_coarse_fox_do_not_reach_its_cheeks() {
    let Some(model) = character("khronos/Fox.glb") else { return };
    let places = from_corner(&places(&model, &auto(&model)));
    assert!(extreme(&places, DVec3::Y) > 0.8, "tip");
    let cheek = |p: DVec3| (0.3..0.38).contains(&p.y) && (0.72..0.75).contains(&p.z);
    assert!(softest(&places, cheek) < 0.1, "cheek");
}

#[test]
fn a_backpack_is_rigid() {
    let Some(model) = character("godette-vrm/Godette_vrm_v4.vrm") else { return };
    let flesh = auto(&model);
    let mut v = 0;
    let mut worn = 0;
    for primitive in &model.primitives {
        let joints = primitive.joints.chunks_exact(primitive.stride);
        for (joints, weights) in joints.zip(primitive.weights.chunks_exact(primitive.stride)) {
            let name = |j: &u16| model.nodes[model.joints[usize::from(*j)].node].name.as_str();
            let share: f32 = joints
                .iter()
                .zip(weights)
                .filter(|(j, _)| name(j).starts_with("backpack"))
                .map(|(_, w)| w)
                .sum();
            if share > 0.99 {
                assert!(flesh.softness[v] == 0.0, "vertex {v} of the backpack is {} soft", flesh.softness[v]);
                worn += 1;
            }
            v += 1;
        }
    }
    assert!(worn > 100, "only {worn} vertices");
}

#[test]
fn a_heavy_body_is_softest_at_the_belly() {
    let Some(model) = character("makehuman/mh_f_heavy.glb") else { return };
    let places = places(&model, &auto(&model));
    let front = |low: f64, high: f64| softest(&places, move |p| (low..high).contains(&p.y) && p.z > 0.02);
    assert!(front(0.44, 0.55) > 0.8, "belly");
    assert!(softest(&places, |p| (0.36..0.44).contains(&p.y) && p.z < -0.02) > 0.2, "buttocks");
    assert!(softest(&places, |p| p.y > 0.74 && p.x.abs() < 0.03) == 0.0, "head");
    assert!(softest(&places, |p| p.y < 0.1) == 0.0, "feet");
    assert!(softest(&places, |p| p.x.abs() > 0.21) == 0.0, "hands");
}

#[test]
fn toys_wobble_at_the_free_end() {
    for file in ["khronos/SimpleSkin.gltf", "khronos/RiggedSimple.gltf"] {
        let Some(model) = character(file) else { continue };
        let places = places(&model, &auto(&model));
        assert!(extreme(&places, DVec3::Y) > 0.5, "{file}: free end");
        assert!(extreme(&places, DVec3::NEG_Y) == 0.0, "{file}: held end");
    }
}

#[test]
fn spring_bones_are_left_alone() {
    let Some(model) = character("godette-vrm/Godette_vrm_v4.vrm") else { return };
    let flesh = auto(&model);
    let springs = &model.vrm.as_ref().expect("a VRM file").spring_nodes;
    let mut v = 0;
    let mut left = 0;
    for primitive in &model.primitives {
        let joints = primitive.joints.chunks_exact(primitive.stride);
        for (joints, weights) in joints.zip(primitive.weights.chunks_exact(primitive.stride)) {
            let held = |j: &u16| springs.contains(&model.joints[usize::from(*j)].node);
            let share: f32 = joints.iter().zip(weights).filter(|(j, _)| held(j)).map(|(_, w)| w).sum();
            if share > 0.5 {
                assert!(flesh.softness[v] == 0.0, "vertex {v} is moved twice");
                left += 1;
            }
            v += 1;
        }
    }
    assert!(left > 0, "no vertex is moved by spring bones");
    assert!(flesh.notes.iter().any(|n| n.contains("spring bones")), "{:?}", flesh.notes);
    assert!(flesh.softness.iter().any(|s| *s > 0.5), "the rest has flesh");
}

#[test]
fn clothes_and_eyes_move_with_the_skin_beneath() {
    let Some(model) = character("makehuman/mh_f_heavy.glb") else { return };
    let flesh = auto(&model);
    let places = places(&model, &flesh);
    let counts: Vec<usize> = model.primitives.iter().map(|p| p.positions.len()).collect();
    let body = (0..counts.len()).max_by_key(|p| counts[*p]).expect("a body");
    let start: usize = counts[..body].iter().sum();
    let skin = start..start + counts[body];
    let (mut worst, mut worn) = (0.0_f32, 0);
    for (_, (p, soft)) in places.iter().enumerate().filter(|(v, _)| !skin.contains(v)) {
        let beneath = places[skin.clone()].iter().map(|(q, s)| (p.distance_squared(*q), *s));
        let (distance, under) = beneath.min_by(|a, b| a.0.total_cmp(&b.0)).expect("skin");
        if distance < 0.01 * 0.01 {
            worst = worst.max((soft - under).abs());
            worn += 1;
        }
    }
    assert!(worn > 1000, "only {worn} vertices of clothes");
    assert!(worst < 0.1, "softness differs by {worst} from the skin beneath");
}
