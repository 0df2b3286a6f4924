//! Many characters in one call: each the same as alone.

use sinew::{Affine, Character, LengthError, Pose, Root, StepError, step_batch};
use sinew_tests::run::{memory, parse, path};
use sinew_tests::tube;

const CROWD: usize = 5;
const DT: f32 = 1.0 / 60.0;

/// Joints that sway, differently for each character.
fn joints(count: usize, who: usize, frame: u8) -> Vec<Affine> {
    let sway = |joint: usize| {
        let phase = 0.1 * f32::from(frame) + f32::from(u8::try_from(who + joint).expect("small"));
        sinew::math::affine::from_trs(
            [0.0; 3],
            [0.0, 0.0, 0.2 * sinew::math::trig::sin(phase), 1.0],
            [1.0; 3],
        )
    };
    (0..count).map(sway).collect()
}

#[test]
fn each_character_of_a_batch_is_as_alone_and_a_refused_one_holds_up_no_other() {
    let aligned = tube::asset(1.0);
    let asset = parse(&aligned);
    let count = asset.joint_from_bind.len();
    let mut memories: Vec<_> = (0..2 * CROWD).map(|_| memory(&asset)).collect();
    let mut all: Vec<_> =
        memories.iter_mut().map(|m| Character::new(parse(&aligned), m).expect("memory fits")).collect();
    let (crowd, alone) = all.split_at_mut(CROWD);
    for frame in 0..40 {
        let mut bones: Vec<_> = (0..CROWD).map(|who| joints(count, who, frame)).collect();
        if frame == 20 {
            bones[2][1][0][0] = f32::NAN;
        }
        let root = |who: usize| path(f64::from(frame) / 60.0 + f64::from(u8::try_from(who).unwrap()), 1.0);
        let poses: Vec<_> =
            bones.iter().enumerate().map(|(who, b)| Pose { root: root(who), root_from_joint: b }).collect();
        let batch = step_batch(crowd, &poses, DT).expect("a pose a character");
        let refusal = (frame == 20).then_some((2, StepError::BadJoint(1)));
        assert_eq!(batch.refusal, refusal, "frame {frame}");
        assert_eq!(batch.advanced + batch.refused, CROWD, "frame {frame}");
        for (who, (together, alone)) in crowd.iter().zip(&mut *alone).enumerate() {
            assert_eq!(alone.step(poses[who], DT).is_err(), refusal.is_some() && who == 2);
            assert_eq!(together.digests(), alone.digests(), "character {who}, frame {frame}");
        }
    }
    let digests: Vec<_> = crowd.iter().map(Character::digests).collect();
    assert!(digests.windows(2).all(|d| d[0] != d[1]), "they moved differently");
    let bones = joints(count, 0, 0);
    let pose = [Pose { root: Root::default(), root_from_joint: &bones }];
    assert_eq!(step_batch(crowd, &pose, DT), Err(LengthError { expected: CROWD, found: 1 }));
    assert_eq!(crowd.iter().map(Character::digests).collect::<Vec<_>>(), digests, "nothing changed");
}
