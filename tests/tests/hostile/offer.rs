//! Offering bytes and calls, and what comes of it.

use sinew::replay::{Extent, Replay, Verdict, verify};
use sinew::{Affine, Asset, Character, Pose, Root, Stepped, Tunables};
use sinew_tests::asset_bytes::{aligned, seal, tube};
use sinew_tests::probe::allocations;
use sinew_tests::recording::{pose, root, with_character};
use sinew_tests::run::bits;
use std::sync::LazyLock;

/// A code, or a word for what did no harm.
pub(crate) type Seen = &'static str;

/// It was taken, ran, and gave finite numbers.
pub(crate) const HARMLESS: Seen = "harmless";

/// Offers bytes as an asset; what is taken must run.
pub(crate) fn asset(bytes: &[u8]) -> Seen {
    let words = aligned(bytes);
    asset_in_place(&bytemuck::cast_slice(&words)[..bytes.len()])
}

/// [`asset`] without copying to an aligned place.
pub(crate) fn asset_in_place(bytes: &[u8]) -> Seen {
    let (parsed, allocated) = allocations(|| Asset::parse(bytes));
    assert_eq!(allocated, 0, "parsing allocates");
    match parsed {
        Err(error) => {
            assert!(!error.to_string().is_empty(), "an error has a text");
            error.code()
        }
        Ok(asset) => {
            live(asset);
            HARMLESS
        }
    }
}

/// Offers the tube with `edit` done to its bytes and a true hash.
pub(crate) fn edited(edit: impl FnOnce(&mut Vec<u8>)) -> Seen {
    static TUBE: LazyLock<Vec<u8>> = LazyLock::new(tube);
    let mut bytes = TUBE.clone();
    edit(&mut bytes);
    seal(&mut bytes);
    asset(&bytes)
}

/// Whether everything that a character shows and keeps is finite.
pub(crate) fn assert_finite(character: &Character<'_>) {
    let finite = |v: &[[f32; 3]]| v.as_flattened().iter().all(|x| x.is_finite());
    let shown = [character.raw_offsets(), character.offsets(), character.positions(), character.normals()];
    assert!(shown.into_iter().all(finite), "numbers that are not finite");
}

/// Steps through clip and poses; a hostile asset may refuse steps.
fn live(asset: Asset<'_>) {
    let mut memory = vec![0.0; Character::required_len(&asset)];
    let mut character = Character::new(asset, &mut memory).expect("the length asked for");
    let mut buffers =
        [vec![[0.0; 3]; asset.meta.vertices as usize], vec![[0.0; 3]; asset.meta.vertices as usize]];
    for frame in 0..4_u8 {
        let t = f32::from(frame) * 0.125;
        let [x, y, z, _] = sinew::math::affine::IDENTITY;
        let pose: Vec<Affine> = vec![[x, y, z, [t, 0.0, 0.0]]; asset.meta.joints as usize];
        let ((), allocated) = allocations(|| {
            let _ = character.step_clip(0, t, Root::default(), 0.125);
            let _ = character.step_rest(root(frame), 0.125);
            let _ = character.step(Pose { root: root(frame), root_from_joint: &pose }, 0.125);
        });
        assert_eq!(allocated, 0, "a step allocates");
        assert_finite(&character);
    }
    let mut state = vec![0; character.state_len()];
    character.save_state(&mut state).expect("its length");
    assert_eq!(character.load_state(&state), Ok(()), "what was saved can be loaded");
    let [positions, normals] = &mut buffers;
    assert_eq!(character.skin_surface(true, positions, normals), Ok(()), "buffers of its length");
    assert!(character.skin_surface(true, positions, &mut []).is_err(), "a buffer too short");
    assert!(positions.iter().chain(&*normals).flatten().all(|x| x.is_finite()), "skinned");
}

/// Offers bytes as a replay of the tube.
pub(crate) fn replay(bytes: &[u8]) -> Seen {
    let replay = match Replay::parse(bytes) {
        Ok(replay) => replay,
        Err(error) => return error.code(),
    };
    with_character(|c| {
        let verdict = verify(c, &replay, Extent::FirstDifference, |_, _| {});
        assert_finite(c);
        match verdict {
            Err(error) => error.code(),
            Ok(Verdict::Same { .. }) => HARMLESS,
            Ok(Verdict::Different(_)) => "different",
        }
    })
}

/// Offers bytes as a saved state of the tube.
pub(crate) fn state(bytes: &[u8]) -> Seen {
    mid_run(|c| match c.load_state(bytes) {
        Ok(()) => HARMLESS,
        Err(error) => error.code(),
    })
}

/// What a step came to.
pub(crate) fn stepped(result: Result<Stepped, sinew::StepError>) -> Seen {
    match result {
        Ok(Stepped::Advanced) => HARMLESS,
        Ok(Stepped::Held) => "held",
        Err(error) => error.code(),
    }
}

/// A valid step.
pub(crate) fn good_step(character: &mut Character<'_>, i: u8) {
    let joints = pose(i);
    let stepped = character.step(Pose { root: root(i), root_from_joint: &joints }, 0.02);
    assert_eq!(stepped, Ok(Stepped::Advanced), "a valid frame");
}

/// Bits of everything that a character shows and keeps.
fn shown(character: &Character<'_>) -> Vec<u32> {
    let arrays = [character.raw_offsets(), character.offsets(), character.positions(), character.normals()];
    arrays.into_iter().flat_map(bits).collect()
}

fn start_again(character: &mut Character<'_>, tunables: &Tunables) {
    character.set_tunables(tunables).expect("valid tunables");
    character.freeze(false);
    character.set_rate_divisor(1);
    character.reset();
}

/// Does `disturb` in the midst of valid frames: a refusal must leave no trace, anything else none after a reset.
pub(crate) fn mid_run(disturb: impl FnOnce(&mut Character<'_>) -> Seen) -> Seen {
    with_character(|character| {
        with_character(|fresh| {
            for i in 0..3 {
                good_step(character, i);
                good_step(fresh, i);
            }
            let (seen, allocated) = allocations(|| disturb(character));
            assert_eq!(allocated, 0, "{seen}: allocates");
            assert_finite(character);
            if seen == HARMLESS || seen == "held" {
                let tunables = *fresh.tunables();
                start_again(character, &tunables);
                start_again(fresh, &tunables);
            }
            for i in 3..6 {
                good_step(character, i);
                good_step(fresh, i);
                assert_eq!(shown(character), shown(fresh), "{seen}: frame {i} is not that of a fresh run");
            }
            seen
        })
    })
}
