//! Class 79: hosts that flush subnormals or round another way. Tested where the register can be set: on `x86_64`.
#![cfg(target_arch = "x86_64")]

use sinew::math::canary::float_environment;
use sinew::{Affine, Asset, Character, Pose, Root, StepError, Stepped, Tunables};
use sinew_bake::recipe::{Recipe, flesh};
use sinew_bake::{builtin, pack};
use sinew_tests::probe::control::{self, DAZ, FTZ, ROUNDING};
use sinew_tests::random::Random;
use sinew_tests::run::{bits, memory, parse};
use sinew_tests::tube;

#[test]
fn the_canary_sees_each_change() {
    let [down, up, zero] = ROUNDING;
    let both = FTZ | DAZ;
    for (changes, word) in [
        (0, 0),
        (FTZ, 0b011_0000),
        (DAZ, 0b000_1000),
        (both, 0b011_1000),
        (down, 0b000_0110),
        (up, 0b100_0001),
        (zero, 0b000_0100),
        (zero | both, 0b011_1100),
    ] {
        let (seen, _) = control::with(changes, float_environment);
        assert_eq!(seen, word, "{changes:#x}: {seen:07b}, expected {word:07b}");
    }
    assert_eq!(float_environment(), 0, "the register is as it was");
}

/// Everything that a character shows and keeps, to the bit.
fn whole(c: &Character<'_>) -> (Vec<u8>, Vec<u32>) {
    let mut state = vec![0; c.state_len()];
    c.save_state(&mut state).expect("its length");
    let shown = [c.positions(), c.normals(), c.palette().as_flattened().as_flattened().as_chunks().0];
    (state, shown.into_iter().flat_map(bits).collect())
}

#[test]
fn the_built_in_character_has_the_same_bits_where_subnormals_are_flushed() {
    let model = builtin::character();
    let flesh = flesh(&model, &Recipe::default()).expect("flesh");
    let aligned = pack::align(&pack::pack(&model, &flesh, 0).expect("an asset"));
    let (asset, _) = control::with(FTZ | DAZ, || parse(&aligned));
    let [mut plain, mut flushed] = [memory(&asset), memory(&asset)];
    let mut plain = Character::new(asset, &mut plain).expect("memory fits");
    let mut flushed =
        control::with(FTZ | DAZ, || Character::new(asset, &mut flushed)).0.expect("memory fits");
    let clips = (0..).take_while(|i| asset.clip(*i).is_some()).count();
    for i in 0..600_u16 {
        let clip = u32::from(i) / 150 % u32::try_from(clips).expect("few");
        let part = f64::from(i % 64) / 256.0;
        let root = Root { translation: [part, 0.5 * part, -part], rotation: [0.0, 0.01, 0.0, 1.0] };
        let step = |c: &mut Character<'_>| c.step_clip(clip, f32::from(i % 96) / 64.0, root, 1.0 / 64.0);
        assert_eq!(step(&mut plain), Ok(Stepped::Advanced));
        assert_eq!(control::with(FTZ | DAZ, || step(&mut flushed)).0, Ok(Stepped::Advanced));
        assert_eq!((plain.float_environment(), flushed.float_environment()), (0, 0b011_1000), "it is told");
        assert!(whole(&plain) == whole(&flushed), "frame {i}");
    }
}

/// Numbers of every size, most of them far too small.
fn small(random: &mut Random) -> f32 {
    let sign = random.word() & 0x8000_0000;
    let exponent = random.below(127);
    f32::from_bits(sign | (exponent << 23) | (random.word() & 0x007f_ffff))
}

/// A disturbed frame: what is done to pose, root, time and tunables.
type Frame = fn(&mut Random, &mut [Affine], &mut Root, &mut f32, &mut Tunables);

const FRAMES: [(&str, Frame); 6] = [
    ("small entries of poses", |random, joints, _, _, _| {
        for x in joints.as_flattened_mut().as_flattened_mut() {
            if random.below(4) == 0 {
                *x = small(random);
            }
        }
    }),
    ("poses that come to rest", |random, joints, _, _, _| {
        if random.below(100) == 0 {
            joints[2][3][0] += 0.1;
        }
    }),
    ("small turns and moves of the root", |random, _, root, _, _| {
        root.rotation = [small(random), small(random), small(random), 1.0];
        root.translation = [0, 1, 2].map(|_| f64::from(small(random)));
    }),
    ("small tunables", |random, joints, _, _, t| {
        let x: [f32; 12] = core::array::from_fn(|_| small(random).abs());
        (t.wind, t.gravity) = ([x[0], -x[1], x[2]], [x[3], -5.0, 0.0]);
        (t.gust, t.gust_rate, t.inertia, t.gain) = (x[4], x[5], x[6], x[7]);
        (t.regions[0].gain, t.regions[1].frequency, t.regions[0].damping) = (x[8], x[9], x[10]);
        t.frequency = x[11].max(1e-6);
        joints[2][3][0] += 0.1 * small(random);
    }),
    ("the stiffest and most damped springs", |random, joints, _, dt, t| {
        t.regions[0].damping = 100.0;
        (t.regions[1].frequency, t.regions[1].damping) = (60.0, 100.0);
        t.settle_after = 10.0;
        *dt = [1e-5, 0.01, 0.1, 1.0, 9.0][random.below(5) as usize];
        joints[2][3][0] += 0.1 * random.unit();
    }),
    ("small times", |random, joints, _, dt, _| {
        *dt = small(random).abs();
        joints[1][3][2] += 0.1 * random.unit();
    }),
];

/// The promise over hostile motion: whatever is small, no bit depends on what the host does to subnormals.
#[test]
fn no_result_depends_on_what_becomes_of_subnormals() {
    let aligned = tube::asset(1.0);
    let asset = parse(&aligned);
    for (name, disturb) in FRAMES {
        let mut random = Random::new(0x5eed);
        let [mut plain, mut flushed] = [memory(&asset), memory(&asset)];
        let mut plain = Character::new(asset, &mut plain).expect("memory fits");
        let mut flushed = Character::new(asset, &mut flushed).expect("memory fits");
        for frame in 0..2_000 {
            let mut joints = [0.0, 0.66, 1.33].map(|y| {
                let [x, turned, z, _] = sinew::math::affine::IDENTITY;
                [x, turned, z, [0.0, y, 0.0]]
            });
            let (mut root, mut dt, mut tunables) = (Root::default(), 1.0 / 60.0, *plain.tunables());
            disturb(&mut random, &mut joints, &mut root, &mut dt, &mut tunables);
            let step = |c: &mut Character<'_>| {
                c.set_tunables(&tunables).expect("in range");
                c.step(Pose { root, root_from_joint: &joints }, dt)
            };
            let (wanted, found) = (step(&mut plain), control::with(FTZ | DAZ, || step(&mut flushed)).0);
            assert_eq!(wanted, found, "{name}, frame {frame}");
            assert!(whole(&plain) == whole(&flushed), "{name}, frame {frame}");
        }
    }
}

#[test]
fn a_step_that_would_round_another_way_is_refused() {
    let aligned = tube::asset(1.0);
    let asset = parse(&aligned);
    let mut memory = memory(&asset);
    let mut c = Character::new(asset, &mut memory).expect("memory fits");
    assert_eq!(c.step_clip(0, 0.1, Root::default(), 0.02), Ok(Stepped::Advanced));
    let before = whole(&c);
    let joints = vec![sinew::math::affine::IDENTITY; asset.joint_from_bind.len()];
    for rounding in ROUNDING {
        let (results, _) = control::with(rounding, || {
            let pose = Pose { root: Root::default(), root_from_joint: &joints };
            [
                c.step(pose, 0.02),
                c.step_clip(0, 0.2, Root::default(), 0.02),
                c.step_rest(Root::default(), 0.02),
            ]
        });
        for result in results {
            let Err(error @ StepError::FloatEnvironment(word)) = result else { panic!("{result:?}") };
            assert_eq!((error.code(), word), ("STEP_FLOAT_ENVIRONMENT", c.float_environment()));
        }
        assert!(whole(&c) == before, "nothing changed");
    }
    assert_eq!(c.step_clip(0, 0.2, Root::default(), 0.02), Ok(Stepped::Advanced), "and on it goes");
    assert_eq!(c.float_environment(), 0);
}

/// Reading and restoring compare and copy: they do not depend on the environment at all.
#[test]
fn files_are_read_the_same_in_any_environment() {
    let aligned = tube::asset(1.0);
    let bytes: &[u8] = bytemuck::cast_slice(&aligned);
    for changes in [FTZ | DAZ, ROUNDING[0], ROUNDING[1], ROUNDING[2]] {
        let (asset, _) = control::with(changes, || Asset::parse(bytes).map(|a| a.hash));
        assert_eq!(asset, Asset::parse(bytes).map(|a| a.hash));
    }
    // A subnormal in an asset is refused, even where it reads as zero.
    let mut bytes = sinew_tests::asset_bytes::tube();
    let at = sinew_tests::asset_bytes::place_of(&bytes, sinew::asset::Section::Rest).start;
    bytes[at..at + 4].copy_from_slice(&1_u32.to_le_bytes());
    sinew_tests::asset_bytes::seal(&mut bytes);
    let words = sinew_tests::asset_bytes::aligned(&bytes);
    let code = || Asset::parse(bytemuck::cast_slice(&words)).map_or_else(|e| e.code(), |_| "taken");
    assert_eq!((code(), control::with(DAZ, code).0), ("ASSET_INVALID_ENTRY", "ASSET_INVALID_ENTRY"));
}
