//! Replays that nobody recorded: whatever the bytes, an error or a verdict, and at once.

use sinew::replay::format::{HEADER_LEN, check};
use sinew::replay::{Extent, HeaderField, Recorder, Replay, Verdict, verify};
use sinew::{Pose, Root};
use sinew_tests::recording::{record, with_character};

/// A generator of xorshift numbers.
struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        self.0
    }

    fn below(&mut self, n: usize) -> usize {
        usize::try_from(self.next() % n as u64).expect("below a usize")
    }
}

/// Reads and, where that goes, runs; the replay is told apart from an undamaged one.
fn survive(bytes: &[u8]) -> bool {
    with_character(|c| match Replay::parse(bytes) {
        Ok(replay) => verify(c, &replay, Extent::Whole, |_, _| {}).is_ok(),
        Err(_) => false,
    })
}

/// Makes every check of the file fit its words again, as an attacker would.
fn reseal_header(bytes: &mut [u8]) {
    for field in HeaderField::ALL {
        let at = 4 + 12 * field.index() as usize;
        let (words, _) = bytes[at..at + 8].as_chunks::<4>();
        let words = [words[0], words[1]].map(u32::from_le_bytes);
        bytes[at + 8..at + 12].copy_from_slice(&check(u64::MAX, field.index(), &words).to_le_bytes());
    }
}

#[test]
fn hostile_header_values_are_errors() {
    let whole = with_character(|c| record(c, 6));
    let values = [0, 1, 2, 4, 255, 1 << 16, 1 << 31, u64::from(u32::MAX), 1 << 62, u64::MAX - 51, u64::MAX];
    for field in HeaderField::ALL {
        for value in values {
            let mut bytes = whole.clone();
            let at = 4 + 12 * field.index() as usize;
            bytes[at..at + 8].copy_from_slice(&value.to_le_bytes());
            reseal_header(&mut bytes);
            let harmless = match field {
                HeaderField::KernelVersion | HeaderField::Canary | HeaderField::SnapshotEvery => true,
                HeaderField::FormatVersion | HeaderField::DigestVersion => value == 1,
                _ => false,
            };
            assert_eq!(survive(&bytes), harmless, "{field} = {value}");
        }
    }
}

#[test]
fn shuffled_bytes_are_survived() {
    let whole = with_character(|c| record(c, 6));
    let mut random = Random(0x9e37_79b9_7f4a_7c15);
    for round in 0..4_000 {
        let mut bytes = whole.clone();
        for _ in 0..=random.below(4) {
            let (from, to) = (random.below(bytes.len()), random.below(bytes.len()));
            let len = random.below(64).min(bytes.len() - from.max(to));
            match random.below(4) {
                0 => bytes[to] = random.next().to_le_bytes()[0],
                1 => bytes.copy_within(from..from + len, to),
                2 => bytes.truncate(to.max(1)),
                _ => {
                    let moved = bytes[from..from + len].to_vec();
                    bytes.splice(to..to, moved);
                }
            }
        }
        if round % 2 == 0 && bytes.len() >= HEADER_LEN {
            reseal_header(&mut bytes);
        }
        survive(&bytes);
    }
    for len in 0..600 {
        let noise: Vec<u8> = (0..len).map(|_| random.next().to_le_bytes()[0]).collect();
        assert!(!survive(&noise), "{len} bytes of noise");
    }
}

impl Random {
    /// Any bits now and then, mostly a number of ordinary size.
    fn float(&mut self) -> f32 {
        let bits = self.next().to_le_bytes();
        let [a, b, c, d, kind, ..] = bits;
        let any = f32::from_bits(u32::from_le_bytes([a, b, c, d]));
        if kind < 8 { any } else { f32::from(i16::from_le_bytes([a, b])) * 3e-5 }
    }

    fn vector<const N: usize>(&mut self) -> [f32; N] {
        core::array::from_fn(|_| self.float())
    }
}

/// One random call; refusals are as good as steps.
fn call(recorder: &mut Recorder<'_, '_, Vec<u8>>, random: &mut Random, saved: &mut Vec<u8>) {
    let root = Root {
        translation: random.vector::<3>().map(f64::from),
        rotation: [0.0, random.float(), random.float(), 1.0],
    };
    let dt = random.float() * 0.1;
    let _ = match random.below(16) {
        0 => recorder.freeze(random.below(2) == 0),
        1 => recorder.set_rate_divisor(u32::try_from(random.below(4)).expect("small")),
        2 => recorder.teleport(),
        3 => recorder.settle(),
        4 => recorder.reset(),
        5 => {
            let mut tunables = *recorder.character().tunables();
            tunables.wind = random.vector();
            tunables.gain = random.float();
            tunables.regions[random.below(2)].frequency = random.float() * 20.0;
            recorder.set_tunables(&tunables)
        }
        6 => {
            saved.resize(recorder.character().state_len(), 0);
            recorder.character().save_state(saved).map_err(Into::into)
        }
        7 => recorder.load_state(saved),
        8..12 => recorder.step_clip(0, random.float(), root, dt).map(|_| ()),
        _ => {
            let joints = [0, 1, 2].map(|_| {
                let [x, y, z, w] = [random.vector(), random.vector(), random.vector(), random.vector()];
                [x, y, z, w]
            });
            recorder.step(Pose { root, root_from_joint: &joints }, dt).map(|_| ())
        }
    };
}

#[test]
fn whatever_was_recorded_verifies() {
    let mut random = Random(0x2545_f491_4f6c_dd1d);
    for round in 0..300 {
        let bytes = with_character(|c| {
            let mut recorder = Recorder::new(c, 3, Vec::new()).expect("memory");
            let mut saved = Vec::new();
            for _ in 0..60 {
                call(&mut recorder, &mut random, &mut saved);
                let c = recorder.character();
                let shown = [c.raw_offsets(), c.positions(), c.normals()];
                assert!(shown.concat().as_flattened().iter().all(|x| x.is_finite()), "round {round}");
            }
            recorder.finish().expect("memory").0
        });
        let replay = Replay::parse(&bytes).expect("what was recorded can be read");
        let verdict = with_character(|c| verify(c, &replay, Extent::FirstDifference, |_, _| {}));
        assert_eq!(verdict, Ok(Verdict::Same { frames: replay.finished().frames }), "round {round}");
    }
}
