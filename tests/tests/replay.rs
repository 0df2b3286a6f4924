//! Replays: the same comes out, every difference is named, every damage is told.

use sinew::replay::format::check;
use sinew::replay::{
    Cause, Difference, Extent, Field, HeaderField, KERNEL_VERSION, LifeField, Motion, Place, PointField,
    Record, Recorder, Replay, ReplayError, Stage, Verdict, Verifier, verify,
};
use sinew::{Character, Pose, StepError, Stepped, Tunables};
use sinew_tests::recording::{FRAMES, pose, record, root, with_character};

fn recorded(every: u32) -> Vec<u8> {
    with_character(|c| record(c, every))
}

fn verdict(bytes: &[u8]) -> Result<Verdict, ReplayError> {
    with_character(|c| verify(c, &Replay::parse(bytes)?, Extent::Whole, |_, _| {}))
}

fn difference(bytes: &[u8]) -> Difference {
    match verdict(bytes) {
        Ok(Verdict::Different(difference)) => difference,
        other => panic!("a difference was planted: {other:?}"),
    }
}

/// Byte offset of a part of `bytes`.
fn offset(bytes: &[u8], part: &[u8]) -> usize {
    part.as_ptr().addr() - bytes.as_ptr().addr()
}

/// Writes the check of the `words` words at `start` again.
fn reseal(bytes: &mut [u8], start: usize, words: usize, record: u64, kind: u32) {
    let end = start + 4 * words;
    let (words, _) = bytes[start..end].as_chunks::<4>();
    let words: Vec<u32> = words.iter().map(|w| u32::from_le_bytes(*w)).collect();
    bytes[end..end + 4].copy_from_slice(&check(record, kind, &words).to_le_bytes());
}

#[test]
fn a_recording_verifies_with_any_snapshot_interval() {
    for every in [0, 1, 7] {
        let bytes = recorded(every);
        assert_eq!(verdict(&bytes), Ok(Verdict::Same { frames: FRAMES }), "every {every}");
        let replay = Replay::parse(&bytes).expect("a whole replay");
        assert_eq!(replay.frames().count(), 24);
        assert_eq!(replay.header(HeaderField::SnapshotEvery), u64::from(every));
    }
}

/// One number for the whole run, on every machine. Changes with the arithmetic: then raise `KERNEL_VERSION`.
#[test]
fn the_digest_of_the_run_is_golden() {
    let bytes = recorded(0);
    let finished = Replay::parse(&bytes).expect("a whole replay").finished();
    assert_eq!(finished.frames, FRAMES);
    assert_eq!(finished.digest, 0x7261_4f3d_e2f1_e5db, "{:#018x}", finished.digest);
}

#[test]
fn the_recording_begins_anywhere_and_the_verifier_has_any_past() {
    let bytes = with_character(|c| {
        record(c, 0); // a life before
        record(c, 5)
    });
    with_character(|c| {
        c.set_tunables(&Tunables { gain: 3.0, ..*c.tunables() }).expect("valid");
        c.freeze(true);
        let replay = Replay::parse(&bytes).expect("a whole replay");
        let (mut calls, mut last) = (0, (0, 0));
        let verdict = verify(c, &replay, Extent::FirstDifference, |done, of| {
            calls += 1;
            last = (done, of);
        });
        assert_eq!(verdict, Ok(Verdict::Same { frames: FRAMES }));
        assert_eq!((calls, last), (24, (24, 24)));
    });
}

#[test]
fn refused_and_held_steps_are_in_the_replay() {
    let bytes = recorded(0);
    let replay = Replay::parse(&bytes).expect("a whole replay");
    let frames: Vec<_> = replay.frames().collect();
    assert_eq!(frames[3].outcome.returned(), Some(Ok(Stepped::Held)));
    assert_eq!(frames[11].outcome.returned(), Some(Err(StepError::BadJoint(1))));
    let Motion::Pose(recorded) = frames[11].motion else { panic!("a pose") };
    let joints: Vec<_> = recorded.joints().collect();
    assert_eq!(joints[2], pose(11)[2]);
    assert!(joints[1][3][2].is_nan());
    let wrong = with_character(|c| {
        let mut recorder = Recorder::new(c, 0, Vec::new()).expect("memory");
        let result = recorder.step(Pose { root: root(0), root_from_joint: &pose(0)[..2] }, 0.1);
        assert!(result.is_err(), "{result:?}");
        recorder.finish().expect("memory").1.frames
    });
    assert_eq!(wrong, 0);
}

/// Frames before the record of each byte, from the errors of all truncations.
fn frames_before(bytes: &[u8]) -> Vec<Option<u64>> {
    let frame = |len| match Replay::parse(&bytes[..len]) {
        Err(ReplayError::NoHeader) => None,
        Err(ReplayError::Truncated { frame }) => Some(frame),
        other => panic!("{len} bytes: {other:?}"),
    };
    (0..bytes.len()).map(frame).collect()
}

#[test]
fn one_changed_byte_anywhere_is_named() {
    let mut bytes = recorded(6);
    let frames = frames_before(&bytes);
    assert_eq!(frames.iter().filter(|f| f.is_none()).count(), sinew::replay::format::HEADER_LEN);
    for i in 0..bytes.len() {
        for mask in [0x01, 0x80, 0xff] {
            bytes[i] ^= mask;
            match (verdict(&bytes), frames[i]) {
                (Err(ReplayError::BadMagic(_)), None) => assert!(i < 4, "byte {i}"),
                (Err(ReplayError::Header(field)), None) => {
                    assert_eq!(field, HeaderField::ALL[(i - 4) / 12], "byte {i}");
                }
                (Err(ReplayError::Damaged { frame, .. }), Some(f)) => assert_eq!(frame, f, "byte {i}"),
                (Ok(Verdict::Different(Difference { frame, cause: Cause::Damaged(field), .. })), Some(f)) => {
                    // A snapshot stands behind its frame.
                    assert_eq!(frame, if field == Field::Snapshot { f - 1 } else { f }, "byte {i}");
                }
                other => panic!("byte {i} ^ {mask:#x}: {other:?}"),
            }
            bytes[i] ^= mask;
        }
    }
}

#[test]
fn joints_and_stages_of_damaged_bytes_are_named() {
    let bytes = recorded(6);
    // Record 0 is a pose: tag, dt and check, root and check, then the joints; then the outcome.
    let start = Replay::parse(&bytes).expect("a whole replay").start();
    let record = offset(&bytes, start) + start.len();
    let damaged = |at: usize| {
        let mut bytes = bytes.clone();
        bytes[record + at] ^= 0x10;
        bytes
    };
    for (at, field) in [
        (1, Field::Tag),
        (4, Field::Dt),
        (12, Field::Root),
        (56, Field::Joint(0)),
        (56 + 52 + 47, Field::Joint(1)),
        (56 + 2 * 52 + 51, Field::Joint(2)),
    ] {
        assert_eq!(verdict(&damaged(at)), Err(ReplayError::Damaged { frame: 0, field }), "byte {at}");
    }
    let outcome = 56 + 3 * 52;
    for (at, stage) in [
        (0, Some(Stage::Life)),
        (12, Some(Stage::Pose)),
        (20, Some(Stage::Skin)),
        (28, Some(Stage::Dynamics)),
        (43, Some(Stage::Embed)),
        (44, None),
    ] {
        let found = difference(&damaged(outcome + at));
        assert_eq!((found.frame, found.stage, found.differing), (0, stage, 1), "byte {at}");
        assert_eq!((found.cause, found.detail), (Cause::Damaged(Field::Outcome), None), "byte {at}");
    }
}

/// Changes the character between two steps of the verifier, before step `at`; what is found.
fn disturbed(every: u32, at: u64, disturb: impl Fn(&mut Character<'_>)) -> Difference {
    let bytes = recorded(every);
    let replay = Replay::parse(&bytes).expect("a whole replay");
    with_character(|c| {
        let mut verifier = Verifier::new(c, &replay).expect("the same asset");
        for frame in 0.. {
            if frame == at {
                disturb(verifier.character());
            }
            if !verifier.advance().expect("valid events") {
                break;
            }
        }
        verifier.difference().expect("a planted difference")
    })
}

#[test]
fn a_tunable_changed_in_mid_run_is_named() {
    let damping = 14 + 4 + 1; // of region 1
    let disturb = |c: &mut Character<'_>| {
        let mut tunables = *c.tunables();
        tunables.regions[1].damping = 0.25;
        c.set_tunables(&tunables).expect("valid");
    };
    // The values are those of the first snapshot at or after the step.
    for (every, at, after) in [(1, 9, 9), (7, 9, 13), (0, 16, 23)] {
        let found = disturbed(every, at, disturb);
        assert_eq!((found.frame, found.stage), (at, Some(Stage::Dynamics)), "every {every}");
        assert_eq!(found.cause, Cause::Unknown);
        // The state of step 6, restored before step 14, heals the first two.
        assert!(if at == 9 { found.differing == 5 } else { found.differing > 3 }, "{found:?}");
        let detail = found.detail.expect("a snapshot follows");
        assert_eq!(detail.frame, after);
        assert_eq!(detail.place, Place::Life { field: LifeField::Tunable, component: damping });
        assert_eq!((detail.recorded, detail.computed), (0x3f00_0000, 0x3e80_0000));
        assert!(found.to_string().contains("damping of region 1"), "{found}");
    }
    let gravity = |c: &mut Character<'_>| {
        c.set_tunables(&Tunables { gravity: [0.0, -4.0, 0.0], ..*c.tunables() }).expect("valid");
    };
    assert_eq!(disturbed(1, 4, gravity).stage, Some(Stage::Skin));
    let gain =
        |c: &mut Character<'_>| c.set_tunables(&Tunables { gain: 2.0, ..*c.tunables() }).expect("valid");
    assert_eq!(disturbed(1, 4, gain).stage, Some(Stage::Embed));
    assert_eq!(disturbed(1, 4, |c| c.freeze(true)).stage, Some(Stage::Life));
}

/// The smallest change there is: one bit of one number of the state.
#[test]
fn one_bit_of_the_state_is_named_exactly() {
    let active = usize::try_from(sinew_tests::asset_bytes::ACTIVE).expect("few points");
    for (array, field, stage) in [
        (0, PointField::X, Stage::Skin),
        (1, PointField::Y, Stage::Dynamics),
        (2, PointField::V, Stage::Dynamics),
        (3, PointField::Slope, Stage::Dynamics),
        (4, PointField::F, Stage::Skin),
        (5, PointField::Offset, Stage::Embed),
    ] {
        let mut bytes = recorded(2);
        let replay = Replay::parse(&bytes).expect("a whole replay");
        // The snapshot after step 5.
        let snapshot =
            replay.records().filter_map(|r| if let Record::Snapshot(s) = r { Some(s) } else { None }).nth(2);
        let snapshot = snapshot.expect("a snapshot after step 5");
        let (start, end) = (offset(&bytes, snapshot), offset(&bytes, snapshot) + snapshot.len());
        // Point 7, component y.
        let at = end - 8 - 4 * 3 * active * (6 - array) + 4 * (3 * 7 + 1);
        let before = u32::from_le_bytes(*bytes[at..].first_chunk().expect("four bytes"));
        bytes[at] ^= 1;
        let place = Place::Point { point: 7, vertex: Some(7), field, component: 1 };
        for sealed in [false, true] {
            if sealed {
                let digest = sinew::math::digest::of_bytes(&bytes[start..end - 8]);
                bytes[end - 8..end].copy_from_slice(&digest.to_le_bytes());
            }
            let found = difference(&bytes);
            assert_eq!((found.frame, found.stage), (5, Some(stage)), "{field:?}");
            assert_eq!((found.cause, found.differing), (Cause::Damaged(Field::Snapshot), 1));
            let detail = found.detail.expect("the snapshot itself");
            assert_eq!((detail.frame, detail.place), (5, place));
            assert_eq!((detail.recorded, detail.computed), (u64::from(before ^ 1), u64::from(before)));
            assert_eq!(detail.ulps(), Some(1));
        }
    }
}

/// A fault of the machine in mid-run: the earliest field is told, and its first point.
#[test]
fn a_bit_flipped_in_memory_is_found_where_it_first_shows() {
    let active = usize::try_from(sinew_tests::asset_bytes::ACTIVE).expect("few points");
    let found = disturbed(1, 6, |c| {
        let mut state = vec![0; c.state_len()];
        c.save_state(&mut state).expect("its length");
        let end = state.len() - 8;
        for point in [9, 5] {
            state[end - 4 * 3 * active * 4 + 12 * point + 2] ^= 0x20; // velocity, x
        }
        let digest = sinew::math::digest::of_bytes(&state[..end]);
        state[end..].copy_from_slice(&digest.to_le_bytes());
        c.load_state(&state).expect("a true digest");
    });
    assert_eq!((found.frame, found.stage, found.cause), (6, Some(Stage::Dynamics), Cause::Unknown));
    let place = Place::Point { point: 5, vertex: Some(5), field: PointField::Y, component: 0 };
    assert_eq!(found.detail.expect("a snapshot after every step").place, place, "{found}");
    assert!(found.to_string().starts_with("frame 6, stage dynamics, vertex 5 (point 5), y.x: "), "{found}");
}

#[test]
fn one_bit_of_a_pose_is_seen_at_its_frame_and_stage() {
    let mut bytes = recorded(1);
    let replay = Replay::parse(&bytes).expect("a whole replay");
    let record = replay.records().scan(0, |n, r| {
        *n += 1;
        Some((*n - 1, r))
    });
    let (number, snapshot) = record
        .filter_map(|(n, r)| if let Record::Snapshot(s) = r { Some((n, s)) } else { None })
        .nth(4)
        .expect("the snapshot after step 4");
    // Before the snapshot stand its tag, the outcome, and the joints, all with their checks.
    let joint2 = offset(&bytes, snapshot) - 4 - 48 - 52;
    bytes[joint2 + 40] ^= 1; // its height, by the last bit
    assert_eq!(verdict(&bytes), Err(ReplayError::Damaged { frame: 4, field: Field::Joint(2) }));
    reseal(&mut bytes, joint2, 12, number - 1, 16 + 2);
    let found = difference(&bytes);
    assert_eq!((found.frame, found.stage, found.cause), (4, Some(Stage::Pose), Cause::Unknown));
    let place = found.detail.expect("a snapshot after the step").place;
    assert_eq!(place.stage(), Stage::Skin, "{place}");
}

#[test]
fn causes_are_told_when_they_are_known() {
    let original = recorded(0);
    let start = Replay::parse(&original).expect("a whole replay").start();
    let record = offset(&original, start) + start.len();
    let outcome = record + 56 + 3 * 52;
    let kernel = 4 + 12 * HeaderField::KernelVersion.index() as usize;
    let mut bytes = original;
    bytes[outcome + 20] ^= 1; // digest of the skin
    reseal(&mut bytes, outcome, 11, 0, 5);
    // The end's digest of the whole run no longer fits: no honest recorder writes that.
    let end = bytes.len();
    assert_eq!(verdict(&bytes), Err(ReplayError::Damaged { frame: FRAMES, field: Field::End }));
    let honest = |bytes: &mut Vec<u8>| {
        let records = Replay::parse(&recorded(0)).expect("a whole replay").records().count() as u64;
        let mut digest = sinew::math::digest::Digest::default();
        let mut whole = bytes.clone();
        whole[outcome + 44] ^= 1; // damaged outcomes are left to the verifier
        for frame in Replay::parse(&whole).expect("inputs are whole").frames() {
            let d = frame.outcome.digests;
            let returned: [u32; 2] = match frame.outcome.returned().expect("known") {
                Ok(Stepped::Advanced) => [0, 0],
                Ok(Stepped::Held) => [1, 0],
                Err(StepError::BadJoint(i)) => [4, i],
                Err(StepError::NoSuchClip(i)) => [5, i],
                Err(_) => [2, 0],
            };
            digest.bytes(returned.map(u32::to_le_bytes).as_flattened());
            digest.bytes([d.pose, d.skin, d.dynamics, d.embed].map(u64::to_le_bytes).as_flattened());
        }
        bytes[end - 12..end - 4].copy_from_slice(&digest.finish().to_le_bytes());
        reseal(bytes, end - 20, 4, records - 1, 7);
    };
    honest(&mut bytes);
    let found = difference(&bytes);
    assert_eq!((found.frame, found.stage, found.cause), (0, Some(Stage::Skin), Cause::Unknown));
    bytes[kernel] += 1;
    reseal(&mut bytes, kernel, 2, u64::MAX, HeaderField::KernelVersion.index());
    let cause = Cause::Kernel { recorded: u64::from(KERNEL_VERSION) + 1, here: KERNEL_VERSION };
    assert_eq!(difference(&bytes).cause, cause);
    assert_eq!(Replay::parse(&bytes).expect("inputs are whole").suspect(), Some(cause));
    assert_eq!(Replay::parse(&recorded(0)).expect("a whole replay").suspect(), None);
    bytes[outcome + 8] = 0b11_0000; // a recorder that flushed subnormals
    reseal(&mut bytes, outcome, 11, 0, 5);
    let found = difference(&bytes);
    assert_eq!(found.cause, Cause::Canary { recorded: 0b11_0000, here: 0 });
    assert!(found.to_string().contains("flushed"), "{found}");
}
