//! Recordings of people on characters.

use glam::DVec3;
use sinew_bake::import::import;
use sinew_bake::pose::bvh::Bvh;
use sinew_bake::pose::names::{Limb, Role, Side, roles};
use sinew_bake::pose::{Pose, retarget, retarget::Retarget};
use sinew_bake::{Model, builtin};
use std::path::PathBuf;

/// Of two conventions of names, T-pose and arms down.
const RECORDINGS: [&str; 3] = [
    "motion-cmu/07_01_walk.bvh",
    "motion-cmu/jumping_jacks.bvh",
    "motion-cmu/13_30_jumping_jacks_twists_squats_jog.bvh",
];
const CHARACTERS: [&str; 3] =
    ["makehuman/mh_m_heavy.glb", "big-buck-bunny/bunny_animated.glb", "godette-vrm/Godette_vrm_v4.vrm"];

fn data() -> Option<PathBuf> {
    let data = PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/../../shared/data"));
    if data.exists() {
        return Some(data);
    }
    assert!(std::env::var_os("CI").is_none(), "no shared data");
    eprintln!("skipped: no shared data");
    None
}

/// Where the joints of a character are.
fn places(model: &Model, pose: &Pose) -> Vec<DVec3> {
    pose.transforms(model).iter().map(|m| m.w_axis.truncate()).collect()
}

#[test]
fn bones_point_where_the_recordings_do() {
    let Some(data) = data() else { return };
    let bones = [
        (Limb::Arm, Limb::Forearm),
        (Limb::Forearm, Limb::Hand),
        (Limb::Thigh, Limb::Shin),
        (Limb::Shin, Limb::Foot),
    ];
    for file in RECORDINGS {
        let bvh = Bvh::read(&data.join(file)).unwrap();
        let names: Vec<&str> = bvh.joints.iter().map(|j| j.name.as_str()).collect();
        let parents: Vec<Option<usize>> = bvh.joints.iter().map(|j| j.parent).collect();
        let from = roles(&names, &parents);
        for character in CHARACTERS {
            let model = import(&data.join(character)).unwrap();
            let retarget = Retarget::new(&model, &bvh, file).unwrap();
            let names: Vec<&str> = model.nodes.iter().map(|n| n.name.as_str()).collect();
            let parents: Vec<Option<usize>> = model.nodes.iter().map(|n| n.parent).collect();
            let to = roles(&names, &parents);
            // Characters of VRM 0 look the other way.
            let turn = if model.vrm.as_ref().is_some_and(|vrm| vrm.major_version == 0) { -1.0 } else { 1.0 };
            let mut worst: f64 = 0.0;
            for frame in (bvh.first_frame()..bvh.frames()).step_by(37) {
                let source: Vec<DVec3> = bvh.placed(frame).iter().map(|p| p.translation).collect();
                let target = places(&model, &retarget.pose(&model, &bvh, frame));
                for side in [Side::Left, Side::Right] {
                    for (a, b) in bones {
                        let [a, b] = [a, b].map(|limb| Role::Of(side, limb));
                        let of = |p: &[DVec3], r: &std::collections::BTreeMap<Role, usize>| {
                            (p[r[&b]] - p[r[&a]]).normalize()
                        };
                        let cos = of(&source, &from).dot(DVec3::new(turn, 1.0, turn) * of(&target, &to));
                        worst = worst.max(libm::acos(cos.min(1.0)).to_degrees());
                    }
                }
            }
            println!("{file} on {character}: {worst:.1e} degrees");
            // But for rounding, and fronts that differ by what a hand that placed the hips was off.
            assert!(worst < 1.0, "{file} on {character}: {worst}");
        }
    }
}

#[test]
fn who_walks_stays_on_the_floor() {
    let Some(data) = data() else { return };
    let bvh = Bvh::read(&data.join(RECORDINGS[0])).unwrap();
    for character in CHARACTERS {
        let model = import(&data.join(character)).unwrap();
        let height = |places: &[DVec3]| {
            let moving = sinew_bake::pose::moving_nodes(&model);
            let all = places.iter().zip(&moving).filter(|(_, m)| **m).map(|(p, _)| p.y);
            all.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), y| (l.min(y), h.max(y)))
        };
        let rest = places(&model, &Pose::rest(&model));
        let (floor, top) = height(&rest);
        let poses = retarget::poses(&model, &bvh, "walk", 10.0).unwrap();
        for pose in &poses {
            let (low, _) = height(&places(&model, pose));
            assert!((low - floor).abs() < 0.08 * (top - floor), "{character}: {low} over {floor} of {top}");
        }
        let [first, last] = [0, poses.len() - 1].map(|k| places(&model, &poses[k]));
        let gone = first.iter().zip(&last).map(|(a, b)| DVec3::new(a.x - b.x, 0.0, a.z - b.z).length());
        // Two and a half seconds of a walk are two or three steps: more than a height of one with long legs, less than
        // that of one without.
        let far = gone.fold(0.0, f64::max) / (top - floor);
        println!("{character}: walks {far:.2} heights");
        assert!((0.3..3.0).contains(&far), "{character}: {far}");
    }
}

#[test]
fn a_fox_is_no_person() {
    let Some(data) = data() else { return };
    let bvh = Bvh::read(&data.join(RECORDINGS[0])).unwrap();
    for model in [import(&data.join("mesh2motion/panda.glb")).unwrap(), builtin::character()] {
        match Retarget::new(&model, &bvh, "walk.bvh") {
            Ok(_) => println!("{} has all joints", model.name),
            Err(e) => assert!(
                e.to_string().contains("rename the joints") && e.to_string().contains(&model.name),
                "{e}"
            ),
        }
    }
    let model = import(&data.join(CHARACTERS[0])).unwrap();
    for rate in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(retarget::poses(&model, &bvh, "walk.bvh", rate).is_err(), "{rate}");
    }
}
