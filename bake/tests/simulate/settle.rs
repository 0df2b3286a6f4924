//! Equilibria.

use crate::{farthest, flesh, plum, walking};
use glam::{DQuat, DVec3};
use sinew_bake::pose::{self, Pose};
use sinew_bake::simulate::{Settings, Simulation};
use sinew_bake::{Model, import::import};
use std::path::Path;

/// Characters with clips from elsewhere: two legs and four, one part and many, metres and centimetres.
const FILES: [&str; 5] = [
    "big-buck-bunny/bunny_animated.glb",
    "khronos/Fox.glb",
    "khronos/CesiumMan.glb",
    "sintel/sintel_animated.glb",
    "kaykit/Mage.glb",
];
/// Newton's method stops at a step of 1e-5 of an edge; the next one, which is not taken, is far shorter. Two ways to one
/// place may end so far apart, body sizes: an edge of the coarsest cage is a tenth of a body.
const SAME: f64 = 2e-6;

#[test]
fn all_characters_settle_in_all_their_poses() {
    let data = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../shared/data"));
    if !data.exists() {
        assert!(std::env::var_os("CI").is_none(), "no shared data");
        println!("skipped: no shared data");
        return;
    }
    let mut all: Vec<Model> = vec![plum()];
    all.extend(FILES.iter().map(|f| import(&data.join(f)).unwrap()));
    for model in &all {
        let mut flesh = flesh(model);
        let (mut iterations, mut inverted, mut poses) = (0, 0, 0);
        for clip in model.clips.iter().take(3) {
            for k in 0..3_u8 {
                // From rest, the farthest start there is.
                flesh.reset();
                let found = flesh.settle(&Pose::of_clip(model, clip, clip.duration * f32::from(k) / 3.0));
                assert!(found.equilibrium.converged, "{} {} {k}: {found:?}", model.name, clip.name);
                assert!(flesh.nodes().iter().all(|x| x.is_finite()));
                iterations += found.iterations;
                inverted += found.equilibrium.inverted;
                poses += 1;
            }
        }
        println!(
            "{}: {poses} poses, {iterations} iterations, {inverted} of {} elements inside out",
            model.name,
            poses * flesh.moving()
        );
        // Where the bones force them, in the folds of so coarse a cage; a tangle is most of a limb.
        assert!(inverted * 20 <= poses * flesh.moving(), "{}: {inverted}", model.name);
    }
}

#[test]
fn rest_is_an_equilibrium() {
    let model = plum();
    let mut flesh = flesh(&model);
    let found = flesh.settle(&Pose::rest(&model));
    assert!(found.equilibrium.converged && found.iterations == 1, "{found:?}");
    assert!(farthest(&flesh, flesh.nodes(), &flesh.body.cage.rest) < 1e-12);
    assert!(flesh.energies().iter().all(|e| e.abs() < 1e-12), "{:?}", flesh.energies());
}

#[test]
fn the_way_does_not_matter() {
    let model = plum();
    let mut flesh = flesh(&model);
    flesh.settle(&walking(&model, 0.3));
    let straight = flesh.nodes().to_vec();
    flesh.reset();
    for t in [0.9, 0.6, 0.3] {
        flesh.settle(&walking(&model, t));
    }
    let around = farthest(&flesh, flesh.nodes(), &straight);
    println!("two ways: {around:e} body sizes apart");
    assert!(around < SAME, "{around:e}");
}

#[test]
fn flesh_turns_with_its_character() {
    let model = plum();
    let mut flesh = flesh(&model);
    let pose = walking(&model, 0.3);
    flesh.settle(&pose);
    let before = flesh.skin();
    let (turn, shift) = (DQuat::from_scaled_axis(DVec3::new(0.3, 1.9, -0.7)), DVec3::new(1.0, -2.0, 0.5));
    let mut turned = pose;
    let roots = (0..model.nodes.len()).filter(|n| model.nodes[*n].parent.is_none());
    for root in roots {
        turned.rotations[root] = turn * turned.rotations[root];
        turned.translations[root] = turn * turned.translations[root] + shift;
    }
    flesh.settle(&turned);
    let moved: Vec<DVec3> = before.iter().map(|x| turn * *x + shift).collect();
    let apart = farthest(&flesh, &flesh.skin(), &moved);
    println!("turned: {apart:e} body sizes apart");
    assert!(apart < SAME, "{apart:e}");
    // And what is left when the root is taken apart is the same pose.
    let (root, relative) = turned.split_root(&model);
    assert!(pose::root(&model).is_some());
    flesh.reset();
    flesh.settle(&relative);
    let moved: Vec<DVec3> = flesh.skin().iter().map(|x| root.transform_point3(*x)).collect();
    flesh.settle(&turned);
    assert!(farthest(&flesh, &flesh.skin(), &moved) < SAME);
}

#[test]
fn bones_are_followed_to_the_bit() {
    let model = plum();
    let mut flesh = flesh(&model);
    let pose = walking(&model, 0.5);
    flesh.settle(&pose);
    let settled: Vec<DVec3> = flesh.body.binding.fixed.iter().map(|i| flesh.nodes()[*i as usize]).collect();
    flesh.reset();
    flesh.settle(&walking(&model, 0.1));
    flesh.settle(&pose);
    let again: Vec<DVec3> = flesh.body.binding.fixed.iter().map(|i| flesh.nodes()[*i as usize]).collect();
    assert_eq!(settled, again);
    assert!(!settled.is_empty());
}

#[test]
fn weight_makes_flesh_sag_in_proportion() {
    let model = plum();
    let sag = |g: f64| {
        let settings = Settings { gravity: DVec3::new(0.0, -g, 0.0), ..Settings::draft() };
        let mut flesh = Simulation::new(&model, &settings).unwrap();
        assert!(flesh.settle(&Pose::rest(&model)).equilibrium.converged);
        let down =
            flesh.skin().iter().zip(&flesh.body.surface.points).map(|(x, rest)| rest.y - x.y).sum::<f64>();
        down / flesh.skin().len() as f64 / flesh.body.surface.size
    };
    let [little, more] = [0.01, 0.02].map(sag);
    assert!(little > 0.0 && (more / little - 2.0).abs() < 0.01, "{little} {more}");
}

#[test]
fn settings_that_cannot_be_are_refused() {
    let model = plum();
    let draft = Settings::draft;
    let cases = [
        (Settings { ratio: 0.5, ..draft() }, "ratio"),
        (Settings { ratio: f64::NAN, ..draft() }, "ratio"),
        (Settings { young: 0.0, ..draft() }, "modulus"),
        (Settings { young: -1.0, ..draft() }, "modulus"),
        (Settings { young: f64::INFINITY, ..draft() }, "modulus"),
        (Settings { density: 0.0, ..draft() }, "density"),
        (Settings { gravity: DVec3::NAN, ..draft() }, "gravity"),
        (
            Settings {
                damping: sinew_bake::fem::dynamics::Rayleigh { mass: 0.0, stiffness: -1.0 },
                ..draft()
            },
            "damping",
        ),
    ];
    for (settings, word) in cases {
        let error = Simulation::new(&model, &settings).err().map(|e| e.to_string()).unwrap_or_default();
        assert!(error.contains(word), "{word}: {error}");
    }
}
