//! Classes 48 to 53 and 72 to 75: what is handed in while a character runs.

use crate::container::{recording, saved};
use crate::offer::{HARMLESS, Seen, good_step, mid_run, stepped};
use sinew::kernel::spring::{Knots, Spring, Step, advance};
use sinew::replay::{Extent, Replay, verify};
use sinew::{Affine, Asset, Character, Pose, Root};
use sinew_tests::asset_bytes::{aligned, seal, tube};
use sinew_tests::recording::{pose, root, with_character};
use sinew_tests::special;

/// A step with these joints.
fn posed(c: &mut Character<'_>, joints: &[Affine; 3]) -> Seen {
    stepped(c.step(Pose { root: root(3), root_from_joint: joints }, 0.02))
}

pub(crate) fn times() -> Vec<Seen> {
    let huge = [0.0, -0.0, -1.0, -1e30, 1e-30, 1e-5, 1.5, 1e4, 1e30];
    let offers = huge.into_iter().chain(special::all());
    let both = |dt: f32| {
        [
            mid_run(|c| stepped(c.step_clip(0, 0.1, root(3), dt))),
            mid_run(|c| stepped(c.step_rest(root(3), dt))),
            mid_run(|c| match c.warm_up(0, 1, root(3), dt.max(0.01)) {
                Ok(()) => HARMLESS,
                Err(error) => error.code(),
            }),
        ]
    };
    offers.flat_map(both).collect()
}

pub(crate) fn matrices() -> Vec<Seen> {
    let zero = [[0.0; 3]; 4];
    let with = |c0: [f32; 3], c1: [f32; 3], c2: [f32; 3]| [c0, c1, c2, [0.1, 0.2, 0.3]];
    let (x, y, z) = ([1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]);
    let bad = [
        zero,
        with(x, x, x),
        with(x, y, [0.0; 3]),
        with([-1.0, 0.0, 0.0], y, z),
        with(x.map(|c| -c), y.map(|c| -c), z.map(|c| -c)),
        with(x, [50.0, 1.0, 0.0], z),
        with([1e-20, 0.0, 0.0], y, z),
        with([1e7, 0.0, 0.0], y, [0.0, 0.0, 1e-7]),
        [[1e7; 3]; 4],
        [[-1e7; 3]; 4],
        [[1e-38; 3]; 4],
    ];
    let mut seen = Vec::new();
    for matrix in bad {
        seen.push(mid_run(|c| posed(c, &[matrix; 3])));
        for joint in 0..3 {
            let mut joints = pose(3);
            joints[joint] = matrix;
            seen.push(mid_run(|c| posed(c, &joints)));
        }
    }
    seen
}

/// Stiffest and softest springs on the shortest and longest steps.
pub(crate) fn beyond_the_domain() -> Vec<Seen> {
    let mut seen = Vec::new();
    for (frequency, damping) in
        [(60.0, 100.0), (60.0, 0.0), (f32::MIN_POSITIVE, 100.0), (0.0, 0.0), (1e-6, 100.0)]
    {
        for dt in [1e-5, 0.1, 1.0, 9.9, 10.0, 11.0, 1e6] {
            seen.push(mid_run(|c| {
                let mut tunables = *c.tunables();
                tunables.settle_after = 10.0;
                (tunables.frequency, tunables.damping) = (20.0, 100.0);
                tunables.regions.iter_mut().for_each(|r| (r.frequency, r.damping) = (frequency, damping));
                c.set_tunables(&tunables).expect("in range");
                for i in 3..6 {
                    let joints = pose(i * 40);
                    let result = stepped(c.step(Pose { root: root(i), root_from_joint: &joints }, dt));
                    assert_eq!(result, HARMLESS, "{frequency} Hz, damping {damping}, {dt} s");
                }
                HARMLESS
            }));
        }
    }
    seen
}

/// `kd² = 4·ks` and up to 8 ulp beside it.
pub(crate) fn critical() -> Vec<Seen> {
    let mut seen = Vec::new();
    for omega in [1e-3, 1.0, 20.0, 377.0, 1e4] {
        for ulps in -8_i32..=8 {
            let kd = f32::from_bits((2.0 * omega * 1.0_f32).to_bits().wrapping_add_signed(ulps));
            for dt in [1e-5, 1.0 / 60.0, 1.0] {
                let step = Step::new(Spring { ks: omega * omega, kd }, dt, 1e-7);
                let mut s = [[0.05_f32; 5], [1.5; 5], [0.7; 5]];
                for _ in 0..20 {
                    let ([y, v, slope], x, f) = (&mut s, [&[0.2][..], &[0.23]], [&[0.3][..], &[-0.2]]);
                    advance(&step, Knots { x, f, y, v, slope });
                }
                assert!(s.as_flattened().iter().all(|x| x.is_finite()), "omega {omega}, {ulps} ulp, {dt} s");
                seen.push(HARMLESS);
            }
        }
    }
    seen
}

pub(crate) fn pose_nan() -> Vec<Seen> {
    let mut seen = Vec::new();
    for bits in special::NANS {
        for i in 0..36 {
            seen.push(mid_run(|c| {
                let mut joints = pose(3);
                joints.as_flattened_mut().as_flattened_mut()[i] = f32::from_bits(bits);
                posed(c, &joints)
            }));
        }
    }
    seen
}

pub(crate) fn teleports() -> Vec<Seen> {
    let roots = [1e30, -1e30, 1e300, f64::MAX, -f64::MAX, 1e7, f64::from(f32::MAX)];
    let roots = roots.into_iter().chain(special::all_f64());
    let far = roots.map(|x| {
        mid_run(|c| {
            let joints = pose(3);
            let mut seen = HARMLESS;
            // There, on from there, and back.
            for translation in [[x, -x, x], [x, x, 0.0], [0.0; 3]] {
                let root = Root { translation, ..root(3) };
                match stepped(c.step(Pose { root, root_from_joint: &joints }, 0.02)) {
                    HARMLESS => {}
                    refused => seen = refused,
                }
                if seen != HARMLESS {
                    break;
                }
            }
            seen
        })
    });
    let joints = [1e30, -1e30, 1e8, 9e6].map(|x| {
        mid_run(|c| {
            let mut joints = pose(3);
            joints[2][3][0] = x;
            posed(c, &joints)
        })
    });
    far.chain(joints).collect()
}

pub(crate) fn time_jumps() -> Vec<Seen> {
    let mut seen = Vec::new();
    for jumps in
        [[0.0, 10.0, 0.0], [10.0, 0.001, 10.0], [1e-6, 1e9, 1e-6], [3e38, 3e38, 3e38], [1.0, 1.000_001, 0.5]]
    {
        for divisor in [1, 2, u32::MAX] {
            seen.push(mid_run(|c| {
                c.set_rate_divisor(divisor);
                let mut last = HARMLESS;
                for dt in jumps {
                    last = stepped(c.step_clip(0, dt, root(3), dt));
                }
                last
            }));
        }
    }
    seen
}

pub(crate) fn another_asset() -> Vec<Seen> {
    let mut other = tube();
    let last = other.len() - 2;
    other[last] ^= 1; // a key of the clip
    seal(&mut other);
    let words = aligned(&other);
    let asset = Asset::parse(bytemuck::cast_slice(&words)).expect("a valid asset");
    let mut memory = vec![0.0; Character::required_len(&asset)];
    let mut character = Character::new(asset, &mut memory).expect("the length asked for");
    let film = recording();
    let film = Replay::parse(&film).expect("a whole replay");
    let mut seen = vec![
        character.load_state(&saved()).map_or_else(|e| e.code(), |()| HARMLESS),
        verify(&mut character, &film, Extent::Whole, |_, _| {}).map_or_else(|e| e.code(), |_| HARMLESS),
    ];
    with_character(|c| good_step(c, 0));
    for joints in [0, 1, 2, 4, 1000] {
        let joints = vec![sinew::math::affine::IDENTITY; joints];
        seen.push(mid_run(|c| stepped(c.step(Pose { root: root(3), root_from_joint: &joints }, 0.02))));
    }
    seen.push(mid_run(|c| stepped(c.step_clip(1, 0.0, root(3), 0.02))));
    seen.push(mid_run(|c| stepped(c.step_clip(u32::MAX, 0.0, root(3), 0.02))));
    seen
}
