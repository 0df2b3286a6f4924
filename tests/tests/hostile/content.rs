//! Classes 24 to 40: counts, memory, the graph of joints, names.

use crate::offer::{HARMLESS, Seen, asset, edited};
use sinew::asset::layout::{Meta, NO_PARENT, Section};
use sinew::replay::{Cursor, Recorder};
use sinew::{Asset, Character};
use sinew_tests::asset_bytes::{
    aligned, floats, pack, place_of, seal, text, tube, tube_meta, tube_section, words,
};
use sinew_tests::recording::with_character;

/// The bytes of a section whose content does not matter.
fn zeros(section: Section, meta: &Meta) -> Vec<u8> {
    if section == Section::Meta {
        return words(meta.to_words());
    }
    vec![0; usize::try_from(section.byte_len(meta)).expect("small")]
}

/// The tube with a word of a section changed.
pub(crate) fn with_word(section: Section, index: usize, word: u32) -> Seen {
    edited(|bytes| {
        let at = place_of(bytes, section).start + 4 * index;
        bytes[at..at + 4].copy_from_slice(&word.to_le_bytes());
    })
}

/// Words of [`Section::Meta`] that count something.
const COUNTS: [usize; 14] = [0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13];

fn meta_of(change: impl FnOnce(&mut [u32; 32])) -> Meta {
    let mut words = tube_meta().to_words();
    change(&mut words);
    Meta::from_words(&words)
}

pub(crate) fn counts_zero() -> Vec<Seen> {
    let none = meta_of(|w| w[..14].fill(0));
    // Each count alone too, the file being otherwise in order; a character may lack clips, or flesh.
    let fatal = [0, 2, 3, 4, 5, 8];
    let alone = fatal.map(|i| asset(&pack(&meta_of(|w| w[i] = 0), zeros)));
    [vec![asset(&pack(&none, zeros))], alone.to_vec()].concat()
}

/// Everything once: a point on a joint.
fn one(section: Section, meta: &Meta) -> Vec<u8> {
    match section {
        Section::JointFromBind => floats([1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0]),
        Section::InfluenceWeights => floats([1.0, 0.0, 0.0, 0.0]),
        Section::Normals => floats([0.0, 1.0, 0.0]),
        Section::Regions => floats([3.0, 0.3, 1.0, 0.1]),
        Section::Primitives => words([0, 0, 0, 0, 1, 0]),
        Section::Parents => words([NO_PARENT]),
        Section::NodeRest => floats([0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 1.0, 1.0, 1.0]),
        Section::Clips => words([0, 1, 0, 0]),
        // A translation of one key needs three values: a step of the scale of nothing is left out.
        Section::Channels => words([0, 0, 0, 1, 0, 0]),
        Section::Values => floats([0.5; 3]),
        other => zeros(other, meta),
    }
}

pub(crate) fn counts_one() -> Vec<Seen> {
    let meta = meta_of(|w| {
        w[..14].fill(1);
        w[4] = 4; // influences come in sets of four
        w[12] = 3; // values of the one key
    });
    vec![asset(&pack(&meta, one))]
}

pub(crate) fn counts_largest() -> Vec<Seen> {
    COUNTS.into_iter().map(|i| with_word(Section::Meta, i, u32::MAX)).collect()
}

pub(crate) fn counts_overflow() -> Vec<Seen> {
    let products = [0x8000_0000, 0x5555_5556, 0x1000_0000, 0xaaaa_aaab];
    let alone = COUNTS.into_iter().flat_map(|i| products.map(|n| with_word(Section::Meta, i, n)));
    let both = edited(|bytes| {
        let at = place_of(bytes, Section::Meta).start;
        bytes[at..at + 4].copy_from_slice(&u32::MAX.to_le_bytes());
        bytes[at + 16..at + 20].copy_from_slice(&u32::MAX.to_le_bytes());
    });
    alone.chain([both]).collect()
}

pub(crate) fn count_against_length() -> Vec<Seen> {
    let words = tube_meta().to_words();
    let near = |i: usize| [words[i] - 1, words[i] + 1].map(|n| with_word(Section::Meta, i, n));
    COUNTS.into_iter().flat_map(near).collect()
}

/// The tube's sections cut or filled up to what `meta` says.
fn fitted(meta: &Meta) -> Vec<u8> {
    pack(meta, |section, meta| {
        let mut bytes = tube_section(section, &if section == Section::Meta { *meta } else { tube_meta() });
        bytes.resize(usize::try_from(section.byte_len(meta)).expect("small"), 0);
        bytes
    })
}

pub(crate) fn counts_against_each_other() -> Vec<Seen> {
    let change: [fn(&mut Meta); 7] = [
        |m| m.active = m.points + 1,
        |m| m.vertices = m.points - 1,
        |m| m.joints -= 1,
        |m| m.nodes -= 1,
        |m| m.regions -= 1,
        |m| m.stride = 256,
        |m| m.stride = 6,
    ];
    let metas = change.map(|change| {
        let mut meta = tube_meta();
        change(&mut meta);
        meta
    });
    metas.iter().map(|meta| asset(&fitted(meta))).collect()
}

pub(crate) fn memory() -> Vec<Seen> {
    let bytes = tube();
    let words = aligned(&bytes);
    let parsed = Asset::parse(bytemuck::cast_slice(&words)).expect("the tube");
    let right = Character::required_len(&parsed);
    let mut memory = vec![0.0; right + 1];
    let mut seen: Vec<Seen> = [0, 1, right - 1, right + 1]
        .map(|len| Character::new(parsed, &mut memory[..len]).map_or_else(|e| e.code(), |_| HARMLESS))
        .to_vec();
    with_character(|c| {
        let right = c.state_len();
        let mut state = vec![0; right + 1];
        for len in [0, 8, right - 1, right + 1] {
            seen.push(c.save_state(&mut state[..len]).map_or_else(|e| e.code(), |()| HARMLESS));
            seen.push(c.load_state(&state[..len]).map_or_else(|e| e.code(), |()| HARMLESS));
        }
        seen.push(Recorder::new(c, 0, Cursor::new(&mut state)).map_or_else(|e| e.code(), |_| HARMLESS));
    });
    seen
}

fn parents(parents: [u32; 3]) -> Seen {
    edited(|bytes| {
        let place = place_of(bytes, Section::Parents);
        bytes[place].copy_from_slice(&words(parents));
    })
}

pub(crate) fn cycle() -> Vec<Seen> {
    vec![parents([2, 0, 1]), parents([1, 0, 1]), parents([NO_PARENT, 2, 1])]
}

pub(crate) fn own_parent() -> Vec<Seen> {
    (0..3)
        .map(|i| {
            parents(core::array::from_fn(
                |k| if k == i { u32::try_from(i).expect("small") } else { NO_PARENT },
            ))
        })
        .collect()
}

pub(crate) fn late_parent() -> Vec<Seen> {
    vec![parents([1, NO_PARENT, 1]), parents([NO_PARENT, 2, NO_PARENT]), parents([2, 0, NO_PARENT])]
}

pub(crate) fn roots() -> Vec<Seen> {
    // None has no parent: the first would need one before it.
    vec![parents([NO_PARENT, NO_PARENT, 1]), parents([NO_PARENT; 3]), parents([0, 0, 1]), parents([3, 0, 1])]
}

pub(crate) fn deep() -> Vec<Seen> {
    let deep = 4096;
    let mut meta = tube_meta();
    meta.nodes = deep;
    let bytes = pack(&meta, |section, meta| match section {
        Section::Parents => words((0..deep).map(|i| i.checked_sub(1).unwrap_or(NO_PARENT))),
        Section::NodeIndex => words(0..deep),
        Section::NodeRest => {
            let node = [0.0, 1e-3, 0.0, 0.0, 0.0, 0.0, 1.0, 1.0, 1.0, 1.0];
            floats((0..deep).flat_map(|_| node))
        }
        Section::JointNode => words([0, deep / 2, deep - 1]),
        other => tube_section(other, meta),
    });
    vec![asset(&bytes)]
}

/// Every word or letter that is an index, out of its range.
pub(crate) fn indices() -> Vec<Seen> {
    let whole = tube();
    let mut seen = Vec::new();
    for section in [
        Section::JointNode,
        Section::PointOfVertex,
        Section::Moved,
        Section::Lit,
        Section::StencilPoints,
        Section::Parents,
    ] {
        for i in 0..place_of(&whole, section).len() / 4 {
            for word in [tube_meta().vertices, 1 << 31, u32::MAX - 1] {
                seen.push(with_word(section, i, word));
            }
        }
    }
    for (section, fields) in [(Section::Clips, [0, 1].as_slice()), (Section::Channels, &[0, 1, 2, 3, 4])] {
        for field in fields {
            for word in [64, 1 << 31, u32::MAX] {
                seen.push(with_word(section, *field, word));
            }
        }
    }
    for field in [3, 4] {
        seen.push(with_word(Section::Primitives, field, u32::MAX));
    }
    for (section, width, least) in [(Section::InfluenceJoints, 2, 3_u16), (Section::RegionOfPoint, 1, 2)] {
        let place = place_of(&whole, section);
        for at in place.step_by(width) {
            for value in [least, 255] {
                seen.push(edited(|bytes| {
                    bytes[at..at + width].copy_from_slice(&value.to_le_bytes()[..width]);
                }));
            }
        }
    }
    seen
}

pub(crate) fn shared_node() -> Vec<Seen> {
    (0..3).map(|i| with_word(Section::JointNode, i, 1)).collect()
}

pub(crate) fn no_length() -> Vec<Seen> {
    (0..3).map(|node| with_word(Section::NodeRest, 10 * node + 1, 0)).collect()
}

/// Two of a name are told apart by their index; what is not text is refused.
pub(crate) fn names() -> Vec<Seen> {
    let named = |section, name: [u8; 16]| {
        edited(|bytes| {
            let start = place_of(bytes, section).start;
            bytes[start..start + 16].copy_from_slice(&name);
        })
    };
    vec![
        named(Section::RegionNames, text("middle")),
        named(Section::RegionNames, [0; 16]),
        named(Section::RegionNames, [b'x'; 16]),
        named(Section::RegionNames, [0xff; 16]),
        named(Section::ClipNames, [0x80; 16]),
        named(Section::ClipNames, text("\u{202e}\n\"'<")),
    ]
}

/// The tube whose every `each` of a section's floats is `value`.
pub(crate) fn with_all(sections: &[Section], value: f32) -> Seen {
    let mut bytes = tube();
    for section in sections {
        let place = place_of(&bytes, *section);
        let len = place.len() / 4;
        bytes[place].copy_from_slice(&floats((0..len).map(|_| value)));
    }
    seal(&mut bytes);
    asset(&bytes)
}
