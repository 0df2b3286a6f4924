//! Classes 41 to 54: floats in every field of an asset, a saved state, the tunables, root, pose and time.

use crate::content::{with_all, with_word};
use crate::offer::{HARMLESS, Seen, mid_run, stepped};
use sinew::asset::layout::Section;
use sinew::{Affine, Character, Pose, Root, Tunables};
use sinew_tests::asset_bytes::{place_of, tube};
use sinew_tests::recording::{pose, root};
use sinew_tests::special::{INFINITIES, LARGEST, NANS, NEGATIVE_ZERO, SUBNORMALS};

/// Every float of the tube: section and word.
fn places() -> Vec<(Section, usize)> {
    let whole = tube();
    let all = [
        Section::JointFromBind,
        Section::Rest,
        Section::InfluenceWeights,
        Section::Softness,
        Section::Normals,
        Section::StencilTangents,
        Section::Regions,
        Section::NodeRest,
        Section::Times,
        Section::Values,
    ];
    let of = |s: Section| (0..place_of(&whole, s).len() / 4).map(move |i| (s, i));
    let meta = (14..19).map(|i| (Section::Meta, i));
    all.into_iter().flat_map(of).chain(meta).chain([(Section::Clips, 2)]).collect()
}

/// Offers a value in every float field of everything.
fn everywhere(value: f32) -> Vec<Seen> {
    let mut seen: Vec<Seen> =
        places().into_iter().map(|(section, i)| with_word(section, i, value.to_bits())).collect();
    seen.extend((0..Tunables::WORDS).map(|i| tunable(i, value)));
    seen.extend(in_a_state(value));
    seen.extend(in_a_step(value));
    seen
}

/// Offers a tunable by its word; what is taken must run.
fn tunable(index: usize, value: f32) -> Seen {
    mid_run(|c| {
        let mut words = c.tunables().to_words();
        words[index] = value;
        match Tunables::from_words(&words).map(|t| c.set_tunables(&t)) {
            Ok(taken) => {
                taken.expect("what `from_words` takes, `set_tunables` takes");
                run(c);
                HARMLESS
            }
            Err(error) => error.code(),
        }
    })
}

/// A few frames to see whether numbers stay finite; far jumps and long times among them.
fn run(c: &mut Character<'_>) {
    for i in 10..16 {
        let joints = pose(i);
        for dt in [1e-5, 0.02, 0.9] {
            c.step(Pose { root: root(i), root_from_joint: &joints }, dt).expect("a valid frame");
        }
    }
}

/// Offers saved states with a float changed under a true digest.
fn in_a_state(value: f32) -> Vec<Seen> {
    let offsets = {
        // Pending time; rotation of the root; every tunable; some of the arrays.
        let tunables = (0..Tunables::WORDS).map(|i| 80 + 4 * i);
        [28, 64, 68, 72, 76].into_iter().chain(tunables).chain((400..1100).step_by(28))
    };
    let offer = |at: usize| {
        mid_run(|c| {
            // On the stack: nothing here may allocate.
            let mut room = [0_u8; 2048];
            let state = &mut room[..c.state_len()];
            c.save_state(state).expect("its length");
            state[at..at + 4].copy_from_slice(&value.to_le_bytes());
            let end = state.len() - 8;
            let digest = sinew::math::digest::of_bytes(&state[..end]);
            state[end..].copy_from_slice(&digest.to_le_bytes());
            match c.load_state(state) {
                Ok(()) => {
                    run(c);
                    HARMLESS
                }
                // A field out of its range, or damage: a state has one code for both.
                Err(error) => error.code(),
            }
        })
    };
    offsets.map(offer).collect()
}

/// What is done to the root, the joints and the time of a step.
type Change<'a> = dyn Fn(&mut Root, &mut [Affine; 3], &mut f32) + 'a;

/// Offers every number of a step.
fn in_a_step(value: f32) -> Vec<Seen> {
    let mut seen = Vec::new();
    let offer = |change: &Change<'_>| {
        mid_run(|c| {
            let (mut root, mut joints, mut dt) = (root(3), pose(3), 0.02);
            change(&mut root, &mut joints, &mut dt);
            stepped(c.step(Pose { root, root_from_joint: &joints }, dt))
        })
    };
    for i in 0..3 {
        seen.push(offer(&|root, _, _| root.translation[i] = f64::from(value)));
    }
    for i in 0..4 {
        seen.push(offer(&|root, _, _| root.rotation[i] = value));
    }
    for i in 0..36 {
        seen.push(offer(&|_, joints, _| joints.as_flattened_mut().as_flattened_mut()[i] = value));
    }
    seen.push(offer(&|root, _, _| root.rotation = [value; 4]));
    seen.push(mid_run(|c| match stepped(c.step_clip(0, value, root(3), 0.02)) {
        "held" => HARMLESS,
        other => other,
    }));
    seen.push(match offer(&|_, _, dt| *dt = value) {
        "held" => HARMLESS, // no time, or less than none, passed
        other => other,
    });
    seen
}

fn each(bits: &[u32]) -> Vec<Seen> {
    bits.iter().flat_map(|bits| everywhere(f32::from_bits(*bits))).collect()
}

pub(crate) fn nan() -> Vec<Seen> {
    each(&NANS)
}

pub(crate) fn infinite() -> Vec<Seen> {
    each(&INFINITIES)
}

pub(crate) fn subnormal() -> Vec<Seen> {
    without_damage(each(&SUBNORMALS))
}

pub(crate) fn negative_zero() -> Vec<Seen> {
    without_damage(each(&[NEGATIVE_ZERO]))
}

pub(crate) fn largest() -> Vec<Seen> {
    let mut seen = each(&LARGEST);
    // As large as is let in, all at once.
    let linear = [Section::JointFromBind, Section::Rest, Section::StencilTangents, Section::Values];
    for value in [1e9, -1e9, 1e6, 1e-6] {
        seen.push(with_all(&linear, value));
        seen.extend(linear.map(|section| with_all(&[section], value)));
    }
    without_damage(seen)
}

/// A state whose field is out of its range counts as damaged; where that is not the point it is left out.
fn without_damage(mut seen: Vec<Seen>) -> Vec<Seen> {
    seen.retain(|s| *s != "STATE_DAMAGED");
    seen
}

/// A value in a field of the regions, in the asset and in the tunables.
fn in_regions(field: usize, value: f32) -> [Seen; 2] {
    [with_word(Section::Regions, field, value.to_bits()), tunable(14 + field, value)]
}

pub(crate) fn negative() -> Vec<Seen> {
    let fields = (0..4).flat_map(|field| [-1e-30, -1.0, -1e30].map(|x| in_regions(field, x)));
    fields.flatten().collect()
}

pub(crate) fn frequencies() -> Vec<Seen> {
    let tiny = f32::MIN_POSITIVE;
    [0.0, tiny, 1e-20, 60.0, 60.000_004, 1.701_411_8e38].into_iter().flat_map(|f| in_regions(0, f)).collect()
}

pub(crate) fn limits() -> Vec<Seen> {
    let longest = [0.0, -0.1, 100.1].into_iter().flat_map(|x| in_regions(3, x));
    // Keys that fall, or stand still.
    let times = [[0, 1.0_f32.to_bits()], [1, 0]].map(|[i, t]| with_word(Section::Times, i as usize, t));
    longest.chain(times).collect()
}

pub(crate) fn quaternions() -> Vec<Seen> {
    let mut seen = Vec::new();
    for q in
        [[0.0; 4], [1e-30; 4], [1e-3, 0.0, 0.0, 2e-4], [0.5; 4], [3.0, 4.0, 0.0, 0.0], [1e5; 4], [1e30; 4]]
    {
        seen.push(mid_run(|c| {
            let joints = pose(3);
            let root = Root { rotation: q, ..root(3) };
            stepped(c.step(Pose { root, root_from_joint: &joints }, 0.02))
        }));
        // All of a node's rest; all keys of the clip's rotation.
        seen.push(q.iter().enumerate().fold(HARMLESS, |worst, (i, x)| {
            match with_word(Section::NodeRest, 3 + i, x.to_bits()) {
                HARMLESS => worst,
                code => code,
            }
        }));
    }
    seen.extend([0.0, -0.0, 1e-30, 1e9].map(|x| with_all(&[Section::Values], x)));
    seen
}

pub(crate) fn scales() -> Vec<Seen> {
    let mut seen = Vec::new();
    for scale in [0.0, -1.0, -0.0, 1e-30, 1e6] {
        for node in 0..3 {
            for axis in 7..10 {
                seen.push(with_word(Section::NodeRest, 10 * node + axis, f32::to_bits(scale)));
            }
        }
        // The clip's only key of a scale.
        seen.extend((30..33).map(|i| with_word(Section::Values, i, scale.to_bits())));
    }
    seen
}
