//! Per-frame code never allocates: a counting allocator proves it, for every public function of a character.

use sinew::replay::{Cursor, Event, Extent, Recorder, Replay, Tape, Verifier, sync_test, verify};
use sinew::{Affine, Asset, Character, Pose, Root, Tunables, step_batch};
use sinew_tests::probe::{Counting, allocations};
use sinew_tests::run::{memory, parse};
use sinew_tests::tube;

#[global_allocator]
static COUNTING: Counting = Counting;

const DT: f32 = 1.0 / 60.0;

/// Runs `f` with a character of the tube, and says how often `f` allocated.
fn count(f: impl FnOnce(&mut Character<'_>, &[Affine])) -> usize {
    let aligned = tube::asset(1.0);
    let asset = parse(&aligned);
    let joints = vec![sinew::math::affine::IDENTITY; asset.joint_from_bind.len()];
    let mut memory = memory(&asset);
    let mut character = Character::new(asset, &mut memory).expect("memory fits");
    let _ = character.step_clip(0, 0.5, Root::default(), DT);
    allocations(|| f(&mut character, &joints)).1
}

#[test]
fn the_counter_counts() {
    assert!(allocations(|| drop(core::hint::black_box(vec![1]))).1 > 0, "a vector is seen");
}

#[test]
fn reading_an_asset_and_making_a_character_allocate_nothing() {
    let aligned = tube::asset(1.0);
    let mut memory = memory(&parse(&aligned));
    let ((), count) = allocations(|| {
        let asset = Asset::parse(bytemuck::cast_slice(&aligned)).expect("a valid asset");
        assert_eq!(Character::required_len(&asset), memory.len());
        let character = Character::new(asset, &mut memory).expect("memory fits");
        core::hint::black_box((character.asset().clip_index("swing"), character.state_len()));
        core::hint::black_box(Character::default_tunables(character.asset()));
    });
    assert_eq!(count, 0);
}

#[test]
fn a_frame_allocates_nothing() {
    let n = count(|c, joints| {
        for i in 0..100_u8 {
            let dt = 1.0 / (60.0 + f32::from(i % 3));
            let root = Root { translation: [0.01 * f64::from(i), 0.0, 0.0], ..Root::default() };
            c.step_clip(0, f32::from(i) / 100.0, root, dt).expect("a valid frame");
            c.step(Pose { root, root_from_joint: joints }, dt).expect("a valid frame");
            c.step_rest(root, dt).expect("a valid frame");
            assert!(c.step(Pose { root, root_from_joint: joints }, f32::NAN).is_err(), "refused");
            assert!(c.step(Pose { root, root_from_joint: &joints[1..] }, dt).is_err(), "refused");
            core::hint::black_box((c.digests(), c.float_environment()));
            core::hint::black_box((c.positions(), c.normals(), c.offsets(), c.raw_offsets(), c.palette()));
        }
        c.warm_up(0, 2, Root::default(), DT).expect("a valid clip");
    });
    assert_eq!(n, 0);
}

#[test]
fn interruptions_allocate_nothing() {
    let n = count(|c, _| {
        c.freeze(true);
        c.freeze(false);
        c.set_rate_divisor(3);
        c.teleport();
        c.settle();
        c.reset();
        let tunables = *c.tunables();
        c.set_tunables(&Tunables { wind: [1.0, 0.0, 0.0], ..tunables }).expect("in range");
        assert!(c.set_tunables(&Tunables { gust: -1.0, ..tunables }).is_err(), "refused");
    });
    assert_eq!(n, 0);
}

#[test]
fn states_and_skinning_allocate_nothing() {
    let aligned = tube::asset(1.0);
    let vertices = parse(&aligned).meta.vertices as usize;
    let (mut positions, mut normals) = (vec![[0.0; 3]; vertices], vec![[0.0; 3]; vertices]);
    let mut bytes = vec![0; 2 * count_state()];
    let n = count(|c, joints| {
        let half = bytes.len() / 2;
        let state = &mut bytes[..half];
        c.save_state(state).expect("its length");
        c.load_state(state).expect("a state of its own");
        state[20] ^= 1;
        assert!(c.load_state(state).is_err(), "refused");
        c.skin_surface(true, &mut positions, &mut normals).expect("its length");
        c.skin_surface(false, &mut positions, &mut normals).expect("its length");
        let step =
            |c: &mut Character<'_>| c.step(Pose { root: Root::default(), root_from_joint: joints }, DT);
        sync_test(c, step, &mut bytes).expect("its length");
    });
    assert_eq!(n, 0);
}

/// Bytes of a state of the tube.
fn count_state() -> usize {
    let mut len = 0;
    count(|c, _| len = c.state_len());
    len
}

#[test]
fn a_batch_allocates_nothing() {
    let aligned = tube::asset(1.0);
    let asset = parse(&aligned);
    let joints = vec![sinew::math::affine::IDENTITY; asset.joint_from_bind.len()];
    let mut memories: Vec<_> = (0..5).map(|_| memory(&asset)).collect();
    let mut crowd: Vec<_> =
        memories.iter_mut().map(|m| Character::new(asset, m).expect("memory fits")).collect();
    let poses = [Pose { root: Root::default(), root_from_joint: &joints }; 5];
    let ((), n) = allocations(|| {
        for _ in 0..10 {
            step_batch(&mut crowd, &poses, DT).expect("a pose each");
        }
        assert!(step_batch(&mut crowd, &poses[1..], DT).is_err(), "refused");
    });
    assert_eq!(n, 0);
}

#[test]
fn recording_and_verifying_allocate_nothing() {
    let mut film = vec![0; 1 << 20];
    let mut state = vec![0; count_state()];
    let n = count(|c, joints| {
        let pose = Pose { root: Root::default(), root_from_joint: joints };
        let mut recorder = Recorder::new(c, 7, Cursor::new(&mut film)).expect("room");
        for i in 0..30_u8 {
            recorder.step_clip(0, f32::from(i) / 30.0, Root::default(), DT).expect("a valid frame");
            recorder.step(pose, DT).expect("a valid frame");
            assert!(recorder.step(pose, f32::INFINITY).is_err(), "refused");
        }
        recorder.freeze(true).expect("room");
        recorder.freeze(false).expect("room");
        recorder.teleport().expect("room");
        recorder.settle().expect("room");
        recorder.reset().expect("room");
        recorder.set_rate_divisor(1).expect("room");
        let tunables = *recorder.character().tunables();
        recorder.set_tunables(&tunables).expect("room");
        recorder.character().save_state(&mut state).expect("its length");
        recorder.load_state(&state).expect("room");
        recorder.event(&Event::Settle).expect("room");
        let (sink, _) = recorder.finish().expect("room");
        let replay = Replay::parse(sink.bytes()).expect("what was recorded");
        core::hint::black_box((replay.suspect(), replay.records().count(), replay.frames().count()));
        verify(c, &replay, Extent::Whole, |_, _| {}).expect("the same asset");
        let mut verifier = Verifier::new(c, &replay).expect("the same asset");
        while verifier.advance().expect("undamaged") {}
        core::hint::black_box((verifier.difference(), verifier.frames(), verifier.character().digests()));
    });
    assert_eq!(n, 0);
    let n = count(|c, joints| {
        let mut tape = Tape::begin(c, 0, Cursor::new(&mut film)).expect("room");
        tape.step(c, Pose { root: Root::default(), root_from_joint: joints }, DT).expect("a valid frame");
        tape.step_clip(c, 0, 0.0, Root::default(), DT).expect("a valid frame");
        tape.event(c, &Event::Teleport).expect("room");
        tape.finish(c).expect("room");
    });
    assert_eq!(n, 0);
}

/// A new public function of these files must be called above, or it is found here.
#[test]
fn every_public_function_is_counted() {
    let here = include_str!("allocations.rs");
    let files = [
        include_str!("../../core/src/character.rs"),
        include_str!("../../core/src/life.rs"),
        include_str!("../../core/src/state.rs"),
        include_str!("../../core/src/batch.rs"),
        include_str!("../../core/src/replay/recorder.rs"),
        include_str!("../../core/src/replay/tape.rs"),
        include_str!("../../core/src/replay/verify.rs"),
        include_str!("../../core/src/replay/sync.rs"),
    ];
    let mut found = 0;
    for file in files {
        for line in file.lines().filter_map(|l| l.trim_start().strip_prefix("pub ")) {
            let Some(name) = line.trim_start_matches("const ").strip_prefix("fn ") else { continue };
            let name = name.split(['(', '<']).next().unwrap_or_default();
            let called = [format!(".{name}("), format!("::{name}("), format!(" {name}(")];
            assert!(name == "code" || called.iter().any(|c| here.contains(c)), "`{name}` is not counted");
            found += 1;
        }
    }
    assert!(found > 40, "{found} functions found");
}
