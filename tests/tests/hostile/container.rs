//! Classes 1 to 23: the file as a whole, its header, its section table.

use crate::offer::{Seen, asset, asset_in_place, edited, replay, state};
use sinew::asset::layout::{ENTRY_LEN, HASH_OFFSET, HEADER_LEN, Section};
use sinew::replay::Recorder;
use sinew::{Pose, Stepped};
use sinew_tests::asset_bytes::{aligned, place_of, seal, tube};
use sinew_tests::recording::{pose, root, with_character};

/// A short recording of the tube: every bit of it is flipped.
pub(crate) fn recording() -> Vec<u8> {
    with_character(|c| {
        let mut recorder = Recorder::new(c, 2, Vec::new()).expect("memory");
        for i in 0..3 {
            let joints = pose(i);
            let taken = recorder.step(Pose { root: root(i), root_from_joint: &joints }, 0.02);
            assert_eq!(taken, Ok(Stepped::Advanced), "a valid frame");
        }
        recorder.step_clip(0, 0.3, root(3), 0.02).expect("a valid frame");
        recorder.settle().expect("memory");
        recorder.finish().expect("memory").0
    })
}

/// A saved state of the tube.
pub(crate) fn saved() -> Vec<u8> {
    with_character(|c| {
        let mut state = vec![0; c.state_len()];
        c.save_state(&mut state).expect("its length");
        state
    })
}

pub(crate) fn empty() -> Vec<Seen> {
    vec![asset(&[]), replay(&[]), state(&[])]
}

pub(crate) fn truncated() -> Vec<Seen> {
    let (whole, film) = (tube(), recording());
    let plain = (0..whole.len()).map(|len| asset(&whole[..len]));
    // Cut by someone who knows the format: length and hash fit.
    let resealed = (HEADER_LEN..whole.len()).map(|len| {
        let mut cut = whole[..len].to_vec();
        cut[8..12].copy_from_slice(&u32::try_from(len).expect("small").to_le_bytes());
        seal(&mut cut);
        asset(&cut)
    });
    let films = (0..film.len()).map(|len| replay(&film[..len]));
    plain.chain(resealed).chain(films).collect()
}

/// The three formats with `edit` done to their bytes.
fn all_three(edit: impl Fn(&mut Vec<u8>)) -> Vec<Seen> {
    let changed = |mut bytes: Vec<u8>| {
        edit(&mut bytes);
        bytes
    };
    vec![asset(&changed(tube())), replay(&changed(recording())), state(&changed(saved()))]
}

pub(crate) fn magic() -> Vec<Seen> {
    all_three(|bytes| bytes[..4].copy_from_slice(b"RIFF"))
}

pub(crate) fn version() -> Vec<Seen> {
    let mut seen = Vec::new();
    for version in [0_u16, 2, 0x0100, u16::MAX] {
        seen.push(edited(|bytes| bytes[4..6].copy_from_slice(&version.to_le_bytes())));
        let mut bytes = saved();
        bytes[4..6].copy_from_slice(&version.to_le_bytes());
        seen.push(state(&bytes));
        seen.push(crate::replays::with_header(0, version.into()));
    }
    seen
}

pub(crate) fn trailing() -> Vec<Seen> {
    let mut seen = all_three(|bytes| bytes.push(0));
    seen.extend(all_three(|bytes| bytes.extend([0; 16])));
    seen.push(edited(|bytes| {
        bytes.extend([0; 4]);
        let len = u32::try_from(bytes.len()).expect("small");
        bytes[8..12].copy_from_slice(&len.to_le_bytes());
    }));
    seen
}

pub(crate) fn swapped() -> Vec<Seen> {
    all_three(|bytes| bytes[..4].reverse())[..2].to_vec()
}

pub(crate) fn misaligned() -> Vec<Seen> {
    let bytes = tube();
    let mut room = aligned(&vec![0; bytes.len() + 4]);
    let room: &mut [u8] = bytemuck::cast_slice_mut(&mut room);
    let offers = (1..4).map(|shift| {
        room[shift..shift + bytes.len()].copy_from_slice(&bytes);
        asset_in_place(&room[shift..shift + bytes.len()])
    });
    offers.collect()
}

pub(crate) fn headless() -> Vec<Seen> {
    let (whole, film) = (tube(), recording());
    (1..HEADER_LEN).flat_map(|len| [asset(&whole[..len]), replay(&film[..len])]).collect()
}

pub(crate) fn checksum() -> Vec<Seen> {
    let mut bytes = tube();
    bytes[HASH_OFFSET] ^= 1;
    let (mut film, mut saved) = (recording(), saved());
    film[4 + 8] ^= 1;
    *saved.last_mut().expect("not empty") ^= 1;
    vec![asset(&bytes), replay(&film), state(&saved)]
}

/// Every bit of the tube flipped under a true hash: hostile, not damaged.
pub(crate) fn resealed() -> Vec<Seen> {
    let whole = tube();
    let bits = (0..whole.len() * 8).filter(|bit| !(HASH_OFFSET..HASH_OFFSET + 8).contains(&(bit / 8)));
    bits.map(|bit| edited(|bytes| bytes[bit / 8] ^= 1 << (bit % 8))).collect()
}

/// The tube with the word at `at` of the table's entry of each section changed.
fn entries(at: usize, change: impl Fn(&[u8], Section, u32) -> u32) -> Vec<Seen> {
    let whole = tube();
    let offers = Section::ALL.iter().enumerate().map(|(i, section)| {
        let place = HEADER_LEN + i * ENTRY_LEN + at;
        let word = u32::from_le_bytes(*whole[place..].first_chunk().expect("in the table"));
        let changed = change(&whole, *section, word);
        edited(|bytes| bytes[place..place + 4].copy_from_slice(&changed.to_le_bytes()))
    });
    offers.collect()
}

pub(crate) fn offset_past_the_end() -> Vec<Seen> {
    entries(4, |whole, _, _| u32::try_from(whole.len()).expect("small").next_multiple_of(16))
}

pub(crate) fn overflowing_extent() -> Vec<Seen> {
    let mut seen = entries(4, |_, _, _| u32::MAX - 15);
    seen.extend(entries(8, |_, _, _| u32::MAX));
    seen
}

pub(crate) fn overlap() -> Vec<Seen> {
    entries(4, |_, _, offset| offset - 16)
}

pub(crate) fn hole() -> Vec<Seen> {
    entries(4, |_, _, offset| offset + 16)
}

pub(crate) fn duplicate() -> Vec<Seen> {
    let whole = tube();
    let offers = (1..Section::ALL.len()).map(|i| {
        let entry = HEADER_LEN + i * ENTRY_LEN;
        let first = whole[HEADER_LEN..HEADER_LEN + ENTRY_LEN].to_vec();
        edited(|bytes| bytes[entry..entry + ENTRY_LEN].copy_from_slice(&first))
    });
    offers.collect()
}

pub(crate) fn unknown() -> Vec<Seen> {
    entries(0, |_, _, _| u32::from_le_bytes(*b"XTRA"))
}

pub(crate) fn reversed() -> Vec<Seen> {
    vec![edited(|bytes| {
        let table = &mut bytes[HEADER_LEN..HEADER_LEN + Section::ALL.len() * ENTRY_LEN];
        table.as_chunks_mut::<ENTRY_LEN>().0.reverse();
    })]
}

pub(crate) fn on_the_header() -> Vec<Seen> {
    entries(4, |_, _, _| 0)
}

pub(crate) fn zero_length() -> Vec<Seen> {
    entries(8, |_, _, _| 0)
}

pub(crate) fn on_itself() -> Vec<Seen> {
    entries(4, |_, section, _| {
        let i = Section::ALL.iter().position(|s| *s == section).expect("a section");
        u32::try_from(HEADER_LEN + i * ENTRY_LEN).expect("small")
    })
}

pub(crate) fn misaligned_offset() -> Vec<Seen> {
    (1..16).flat_map(|by| entries(4, move |_, _, offset| offset + by)).collect()
}

/// Gaps between sections, the reserved words of header, table and meta, and what stands behind a name.
pub(crate) fn padding() -> Vec<Seen> {
    let whole = tube();
    let places: Vec<_> = Section::ALL.iter().map(|s| place_of(&whole, *s)).collect();
    let mut at: Vec<usize> = places.windows(2).flat_map(|w| w[0].end..w[1].start).collect();
    assert!(!at.is_empty(), "the tube has gaps");
    at.extend(12..16);
    at.extend(HASH_OFFSET + 8..HEADER_LEN);
    at.extend((0..Section::ALL.len()).map(|i| HEADER_LEN + i * ENTRY_LEN + 12));
    at.push(places[0].end - 1);
    at.push(place_of(&whole, Section::RegionNames).start + 15);
    at.push(place_of(&whole, Section::ClipNames).start + 31);
    at.into_iter().map(|at| edited(|bytes| bytes[at] = 1)).collect()
}
