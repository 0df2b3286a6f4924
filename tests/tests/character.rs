//! A character through everything that users do to one: the complaints of `design` as tests.

#![allow(clippy::float_cmp, reason = "bits are compared")]

use sinew::{Asset, Character, Pose, Root, StepError, Stepped, Tunables};
use sinew_tests::run::{bits, distance, length, memory, parse, path};
use sinew_tests::tube;

const SIZE: f64 = 2.078;

/// Runs `character` along [`path`] to `end` seconds in steps of `dt` (the clip swings too).
fn travel(character: &mut Character<'_>, end: f64, dt: f64) {
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "small numbers")]
    let steps = (end / dt).round() as u32;
    for i in 1..=steps {
        let t = f64::from(i) * dt;
        step_at(character, t, dt);
    }
}

#[allow(clippy::cast_possible_truncation, reason = "rounding is meant")]
fn step_at(character: &mut Character<'_>, t: f64, dt: f64) {
    let stepped = character.step_clip(0, (t % 1.0) as f32, path(t, SIZE), dt as f32);
    assert_eq!(stepped, Ok(Stepped::Advanced), "time {t}");
}

#[test]
fn flesh_moves_and_softness_zero_does_not() {
    let aligned = tube::asset(1.0);
    let asset = parse(&aligned);
    let mut memory = memory(&asset);
    let mut character = Character::new(asset, &mut memory).unwrap();
    travel(&mut character, 1.0, 1.0 / 60.0);
    let moved = length(character.offsets());
    assert!(moved > 0.01 && moved < 0.5, "largest offset {moved}");
    let flesh = tube::flesh(1.0);
    let model = tube::model(1.0);
    for (v, softness) in flesh.softness.iter().enumerate() {
        if *softness == 0.0 {
            assert_eq!(character.positions()[v], model.primitives[0].positions[v], "vertex {v}");
        }
    }
    assert!(character.normals().iter().all(|n| (n[0] * n[0] + n[1] * n[1] + n[2] * n[2] - 1.0).abs() < 1e-5));
}

#[test]
fn rest_stays_rest_bit_for_bit() {
    let aligned = tube::asset(1.0);
    let asset = parse(&aligned);
    let mut memory = memory(&asset);
    let mut character = Character::new(asset, &mut memory).unwrap();
    let (positions, normals) = (bits(character.positions()), bits(character.normals()));
    for i in 0..10_000_u32 {
        let dt = [1.0 / 60.0, 1.0 / 144.0, 0.02, 0.5][(i % 4) as usize];
        character.step_rest(Root { translation: [3.0, 0.0, -1.0], ..Root::default() }, dt).unwrap();
    }
    assert_eq!(bits(character.positions()), positions);
    assert_eq!(bits(character.normals()), normals);
}

#[test]
fn motion_dies_to_rest_exactly() {
    let aligned = tube::asset(1.0);
    let asset = parse(&aligned);
    let mut memory = memory(&asset);
    let mut character = Character::new(asset, &mut memory).unwrap();
    let rest = bits(character.positions());
    travel(&mut character, 0.7, 1.0 / 60.0);
    assert_ne!(bits(character.positions()), rest);
    for _ in 0..1200 {
        character.step_rest(path(0.7, SIZE), 1.0 / 60.0).unwrap();
    }
    assert_eq!(bits(character.positions()), rest);
}

/// The same motion at any frame rate; the bound is published in the README.
#[test]
fn frame_rates_agree_at_common_times() {
    let aligned = tube::asset(1.0);
    let run = |rate: f64| {
        let asset = parse(&aligned);
        let mut memory = memory(&asset);
        let mut character = Character::new(asset, &mut memory).unwrap();
        travel(&mut character, 2.0, 1.0 / rate);
        character.offsets().to_vec()
    };
    let reference = run(1920.0);
    let amplitude = length(&reference);
    for (rate, bound) in
        [(24.0, 0.012), (30.0, 0.012), (60.0, 0.004), (90.0, 0.002), (144.0, 0.001), (240.0, 0.0005)]
    {
        let difference = distance(&run(rate), &reference) / amplitude;
        println!("{rate} Hz: {difference:.5} of the largest offset");
        assert!(difference <= bound, "{rate} Hz differs by {difference} of the largest offset {amplitude}");
    }
}

#[test]
fn jittered_steps_agree_with_even_ones() {
    let aligned = tube::asset(1.0);
    let asset = parse(&aligned);
    let (mut even, mut uneven) = (memory(&asset), memory(&asset));
    let mut even = Character::new(asset, &mut even).unwrap();
    let mut uneven = Character::new(asset, &mut uneven).unwrap();
    travel(&mut even, 2.0, 1.0 / 120.0);
    for i in 1..=240_u32 {
        // Knots move by up to 40 % of a step; the last is on time.
        let knot = |i: u32| {
            f64::from(i) + if i.is_multiple_of(240) { 0.0 } else { 0.4 * f64::from(i * 7 % 11) / 11.0 }
        };
        let (a, b) = (knot(i - 1) / 120.0, knot(i) / 120.0);
        step_at(&mut uneven, b, b - a);
    }
    let difference = distance(even.offsets(), uneven.offsets()) / length(even.offsets());
    assert!(difference < 0.01, "{difference}");
}

#[test]
fn scale_changes_nothing() {
    let offsets = |scale: f64| {
        let aligned = tube::asset(scale);
        let asset = parse(&aligned);
        let mut memory = memory(&asset);
        let mut character = Character::new(asset, &mut memory).unwrap();
        for i in 1..=90_u32 {
            let t = f64::from(i) / 60.0;
            let Root { translation, rotation } = path(t, SIZE);
            let root = Root { translation: translation.map(|x| x * scale), rotation };
            #[allow(clippy::cast_possible_truncation, reason = "rounding is meant")]
            character.step_clip(0, t as f32 % 1.0, root, 1.0 / 60.0).unwrap();
        }
        #[allow(clippy::cast_possible_truncation, reason = "rounding is meant")]
        let inverse = (1.0 / scale) as f32;
        character.offsets().iter().map(|o| o.map(|x| x * inverse)).collect::<Vec<_>>()
    };
    let one = offsets(1.0);
    for scale in [0.01, 100.0] {
        let difference = distance(&offsets(scale), &one) / length(&one);
        assert!(difference < 1e-4, "scale {scale}: {difference}");
    }
}

#[test]
fn far_from_the_origin_is_the_same() {
    let aligned = tube::asset(1.0);
    let asset = parse(&aligned);
    let (mut near, mut far) = (memory(&asset), memory(&asset));
    let mut near = Character::new(asset, &mut near).unwrap();
    let mut far = Character::new(asset, &mut far).unwrap();
    // Steps that f64 holds exactly at a million metres: the same bits.
    for i in 0..240_u32 {
        let x = f64::from(i % 16) / 64.0;
        let root = |origin: f64| Root { translation: [origin + x, 0.5 * x, origin], ..Root::default() };
        near.step_rest(root(0.0), 1.0 / 60.0).unwrap();
        far.step_rest(root(1e6), 1.0 / 60.0).unwrap();
    }
    assert!(length(near.offsets()) > 1e-3);
    assert_eq!(bits(near.offsets()), bits(far.offsets()));
}

#[test]
fn inertia_zero_ignores_the_root() {
    let aligned = tube::asset(1.0);
    let asset = parse(&aligned);
    let mut memory = memory(&asset);
    let mut character = Character::new(asset, &mut memory).unwrap();
    let level = Tunables { gravity: [0.0; 3], inertia: 0.0, ..*character.tunables() };
    // Without gravity the tube relaxes upward once; what is asked is that the root adds nothing.
    character.set_tunables(&level).unwrap();
    for _ in 0..600 {
        character.step_rest(Root::default(), 1.0 / 60.0).unwrap();
    }
    let before = bits(character.offsets());
    for i in 0..120_u32 {
        let t = f64::from(i) / 60.0;
        let Root { translation, .. } = path(t, SIZE);
        character.step_rest(Root { translation, ..Root::default() }, 1.0 / 60.0).unwrap();
    }
    assert_eq!(bits(character.offsets()), before);
}

#[test]
fn a_teleport_is_not_felt() {
    let aligned = tube::asset(1.0);
    let asset = parse(&aligned);
    let mut memory = memory(&asset);
    let mut character = Character::new(asset, &mut memory).unwrap();
    for _ in 0..10 {
        character.step_rest(Root::default(), 1.0 / 60.0).unwrap();
    }
    let rest = bits(character.positions());
    let away = Root { translation: [500.0, 0.0, 0.0], ..Root::default() };
    character.step_rest(away, 1.0 / 60.0).unwrap();
    assert_eq!(bits(character.positions()), rest, "detected");
    let near = Root { translation: [500.5, 0.0, 0.0], ..Root::default() };
    character.teleport();
    character.step_rest(near, 1.0 / 60.0).unwrap();
    assert_eq!(bits(character.positions()), rest, "declared");
    character.step_rest(away, 1.0 / 60.0).unwrap();
    assert_ne!(bits(character.positions()), rest, "half a metre in a frame is felt otherwise");
}

#[test]
fn hitches_neither_explode_nor_linger() {
    let aligned = tube::asset(1.0);
    let asset = parse(&aligned);
    let mut memory = memory(&asset);
    let mut character = Character::new(asset, &mut memory).unwrap();
    travel(&mut character, 1.0, 1.0 / 60.0);
    let usual = length(character.offsets());
    for dt in [0.3_f32, 0.9, 5.0, 1e9, 1.0 / 60.0] {
        character.step_clip(0, 0.4, path(1.0, SIZE), dt).unwrap();
        let o = length(character.offsets());
        assert!(o.is_finite() && o <= 4.0 * usual, "after {dt} s: {o}, usually {usual}");
    }
}

#[test]
fn bad_time_and_bad_poses_change_nothing() {
    let aligned = tube::asset(1.0);
    let asset = parse(&aligned);
    let mut memory = memory(&asset);
    let mut character = Character::new(asset, &mut memory).unwrap();
    travel(&mut character, 0.5, 1.0 / 60.0);
    let before = (character.digests(), bits(character.positions()));
    let identity = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [0.0; 3]];
    let root = path(0.5, SIZE);
    fn pose(root: Root, root_from_joint: &[sinew::Affine]) -> Pose<'_> {
        Pose { root, root_from_joint }
    }
    for dt in [0.0, -0.0, -1.0, -1e9] {
        assert_eq!(character.step(pose(root, &[identity; 3]), dt), Ok(Stepped::Held));
    }
    for dt in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        assert_eq!(character.step(pose(root, &[identity; 3]), dt), Err(StepError::TimeNotFinite));
    }
    for bad in [f32::NAN, f32::INFINITY, 1e30] {
        for entry in 0..12 {
            let mut joints = [identity; 3];
            joints[1].as_flattened_mut()[entry] = bad;
            assert_eq!(character.step(pose(root, &joints), 0.01), Err(StepError::BadJoint(1)));
        }
    }
    let lost = Root { translation: [f64::NAN, 0.0, 0.0], ..root };
    let flat = Root { rotation: [0.0; 4], ..root };
    for root in [lost, flat] {
        assert_eq!(character.step_rest(root, 0.01), Err(StepError::BadRoot));
    }
    assert!(matches!(character.step(pose(root, &[identity; 2]), 0.01), Err(StepError::JointCount(_))));
    assert_eq!(character.step_clip(7, 0.0, root, 0.01), Err(StepError::NoSuchClip(7)));
    assert_eq!((character.digests(), bits(character.positions())), before);
}

#[test]
fn gravity_and_wind_have_an_effect() {
    let aligned = tube::asset(1.0);
    let asset = parse(&aligned);
    let settled = |gravity: [f32; 3], wind: [f32; 3]| {
        let mut memory = memory(&asset);
        let mut character = Character::new(asset, &mut memory).unwrap();
        let t = Tunables { gravity, wind, ..*character.tunables() };
        character.set_tunables(&t).unwrap();
        for _ in 0..120 {
            character.step_rest(Root::default(), 1.0 / 60.0).unwrap();
        }
        let sum = character.raw_offsets().iter().fold([0.0; 3], |s, o| [0, 1, 2].map(|i| s[i] + o[i]));
        #[allow(clippy::cast_precision_loss, reason = "a small count")]
        sum.map(|x| x / character.raw_offsets().len() as f32)
    };
    let g = asset.meta.gravity;
    assert_eq!(settled([0.0, -g, 0.0], [0.0; 3]), [0.0; 3], "authored gravity is rest");
    assert!(settled([0.0; 3], [0.0; 3])[1] > 1e-3, "without gravity flesh floats up");
    assert!(settled([0.0, -2.0 * g, 0.0], [0.0; 3])[1] < -1e-3, "more gravity sags");
    let blown = settled([0.0, -g, 0.0], [4.0, 0.0, 0.0]);
    assert!(blown[0] > 1e-3 && blown[0] > 4.0 * blown[1].abs(), "wind along x: {blown:?}");
}

#[test]
fn gravity_pulls_turned_flesh() {
    let aligned = tube::asset(1.0);
    let asset = parse(&aligned);
    let mut memory = memory(&asset);
    let mut character = Character::new(asset, &mut memory).unwrap();
    let (s, c) = (core::f32::consts::FRAC_1_SQRT_2, core::f32::consts::FRAC_1_SQRT_2);
    let lying = Root { rotation: [0.0, 0.0, s, c], ..Root::default() };
    for _ in 0..240 {
        character.step_rest(lying, 1.0 / 60.0).unwrap();
    }
    // World down is +x... of the root turned a quarter about z: flesh sags along −x of the root, and is freed along y.
    let top = character.raw_offsets()[character.raw_offsets().len() - 1];
    assert!(top[0] < -1e-3 && top[1] > 1e-3, "{top:?}");
}

#[test]
fn tunables_are_hot() {
    let aligned = tube::asset(1.0);
    let asset = parse(&aligned);
    let mut memory = memory(&asset);
    let mut character = Character::new(asset, &mut memory).unwrap();
    travel(&mut character, 0.5, 1.0 / 60.0);
    let before = bits(character.raw_offsets());
    let t = Tunables { frequency: 1.1, ..*character.tunables() };
    character.set_tunables(&t).unwrap();
    assert_eq!(bits(character.raw_offsets()), before, "a change does not reset");
    assert!(character.set_tunables(&Tunables { gain: f32::NAN, ..t }).is_err());
    assert_eq!(*character.tunables(), t, "a bad change changes nothing");
}

#[test]
fn a_divided_rate_catches_up_exactly() {
    let aligned = tube::asset(1.0);
    let asset = parse(&aligned);
    let (mut a, mut b) = (memory(&asset), memory(&asset));
    let (mut each, mut third) =
        (Character::new(asset, &mut a).unwrap(), Character::new(asset, &mut b).unwrap());
    third.set_rate_divisor(3);
    for i in 1..=90_u32 {
        let t = f64::from(i) / 64.0; // a step of 1/64 s adds up without rounding
        #[allow(clippy::cast_possible_truncation, reason = "exact")]
        let stepped = third.step_clip(0, (t % 1.0) as f32, path(t, SIZE), 1.0 / 64.0).unwrap();
        assert_eq!(stepped == Stepped::Advanced, i % 3 == 0, "step {i}");
        if i % 3 == 0 {
            step_at(&mut each, t, 3.0 / 64.0);
        }
    }
    assert_eq!(each.digests().dynamics, third.digests().dynamics);
}

#[test]
fn freezing_holds_and_then_settles() {
    let aligned = tube::asset(1.0);
    let asset = parse(&aligned);
    let mut memory = memory(&asset);
    let mut character = Character::new(asset, &mut memory).unwrap();
    travel(&mut character, 0.5, 1.0 / 60.0);
    let before = bits(character.positions());
    character.freeze(true);
    for _ in 0..600 {
        assert_eq!(character.step_rest(Root::default(), 1.0 / 60.0), Ok(Stepped::Held));
    }
    assert_eq!(bits(character.positions()), before);
    character.freeze(false);
    character.step_rest(path(0.5, SIZE), 1.0 / 60.0).unwrap();
    assert_eq!(length(character.offsets()), 0.0, "ten seconds later it has come to rest");
}

#[test]
fn a_saved_state_goes_on_bit_for_bit() {
    let aligned = tube::asset(1.0);
    let asset = parse(&aligned);
    let (mut a, mut b) = (memory(&asset), memory(&asset));
    let mut one = Character::new(asset, &mut a).unwrap();
    let mut two = Character::new(asset, &mut b).unwrap();
    travel(&mut one, 0.5, 1.0 / 60.0);
    let mut state = vec![0; one.state_len()];
    one.save_state(&mut state).unwrap();
    two.load_state(&state).unwrap();
    assert_eq!(bits(one.positions()), bits(two.positions()));
    for i in 31..=60_u32 {
        step_at(&mut one, f64::from(i) / 60.0, 1.0 / 60.0);
        step_at(&mut two, f64::from(i) / 60.0, 1.0 / 60.0);
    }
    assert_eq!(one.digests(), two.digests());
    let kept = one.digests();
    for byte in 0..state.len() {
        let mut bad = state.clone();
        bad[byte] ^= 0x10;
        assert!(one.load_state(&bad).is_err(), "byte {byte}");
    }
    assert!(one.load_state(&state[1..]).is_err());
    assert_eq!(one.digests(), kept, "a bad state changes nothing");
}

#[test]
fn looped_clips_close_after_warm_up() {
    let aligned = tube::asset(1.0);
    let asset = parse(&aligned);
    let mut memory = memory(&asset);
    let mut character = Character::new(asset, &mut memory).unwrap();
    character.warm_up(0, 6, Root::default(), 1.0 / 60.0).unwrap();
    let start = character.offsets().to_vec();
    for i in 0..60_u8 {
        character.step_clip(0, f32::from(i) / 60.0, Root::default(), 1.0 / 60.0).unwrap();
    }
    let gap = distance(&start, character.offsets());
    assert!(gap < 1e-3 * length(&start), "{gap} of {}", length(&start));
}

#[test]
fn memory_of_a_wrong_length_is_refused() {
    let aligned = tube::asset(1.0);
    let asset: Asset<'_> = parse(&aligned);
    let len = Character::required_len(&asset);
    for wrong in [0, len - 1, len + 1] {
        let error = Character::new(asset, &mut vec![0.0; wrong]).unwrap_err();
        assert_eq!((error.expected, error.found), (len, wrong));
    }
}
