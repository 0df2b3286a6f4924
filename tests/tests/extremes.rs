//! Poses as large as are let in: numbers stay finite, and the character recovers.

use sinew::{Character, Pose, Root, StepError};
use sinew_tests::run::{bits, memory, parse};
use sinew_tests::tube;

/// A small generator of its own, so that the runs are the same everywhere.
struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        self.0 >> 33
    }

    fn sign(&mut self) -> f32 {
        if self.next() % 2 == 0 { 1.0 } else { -1.0 }
    }
}

#[test]
fn the_largest_poses_keep_every_number_finite() {
    let aligned = tube::asset(1.0);
    let asset = parse(&aligned);
    let joints = asset.joint_from_bind.len();
    let mut memory = memory(&asset);
    let mut character = Character::new(asset, &mut memory).expect("memory fits");
    let rest = bits(character.positions());
    let mut tunables = *character.tunables();
    (tunables.gain, tunables.teleport, tunables.inertia) = (100.0, 1e9, 1.0);
    tunables.regions.iter_mut().for_each(|r| (r.frequency, r.damping, r.gain) = (60.0, 0.0, 100.0));
    character.set_tunables(&tunables).expect("the largest tunables");
    let mut random = Random(7);
    for frame in 0..2000 {
        let pose: Vec<_> =
            (0..joints).map(|_| [[(); 3]; 4].map(|column| column.map(|()| 1e7 * random.sign()))).collect();
        let translation = [1e300, -1e300, 0.0].map(|x| x * f64::from(random.sign()));
        let root = Root { translation, ..Root::default() };
        let dt = [1e-5, 1.0 / 144.0, 1.0 / 60.0, 0.4][frame % 4];
        character.step(Pose { root, root_from_joint: &pose }, dt).expect("as large as is let in");
        let finite = |v: &[[f32; 3]]| v.as_flattened().iter().all(|x| x.is_finite());
        assert!(finite(character.raw_offsets()), "offsets, frame {frame}");
        assert!(finite(character.positions()), "positions, frame {frame}");
        assert!(finite(character.normals()), "normals, frame {frame}");
    }
    character.reset();
    character.step_rest(Root::default(), 1.0 / 60.0).expect("at rest");
    assert_eq!(bits(character.positions()), rest);
    let mut pose = vec![sinew::math::affine::IDENTITY; joints];
    pose[1][3][0] = 1.1e7;
    let refused = character.step(Pose { root: Root::default(), root_from_joint: &pose }, 1.0 / 60.0);
    assert_eq!(refused, Err(StepError::BadJoint(1)));
}
