//! A small asset written by hand, byte by byte, independent of the baker's writer: a soft tube on three joints.

use core::ops::Range;
use sinew::asset::content_hash;
use sinew::asset::layout::{ENTRY_LEN, HASH_OFFSET, HEADER_LEN, MAGIC, Meta, NO_PARENT, Section};

/// Points around the tube.
const AROUND: u32 = 4;
/// Rings along the tube; the upper three are flesh.
const RINGS: u32 = 5;
/// Points with flesh.
pub const ACTIVE: u32 = 3 * AROUND;
/// All points.
pub const POINTS: u32 = RINGS * AROUND;
/// Render vertices: a seam doubles the first point of each ring.
pub const VERTICES: u32 = POINTS + RINGS;
/// Joints.
pub const JOINTS: u32 = 3;

/// The tube as bytes of an asset: 3 joints, 20 points, 12 of them flesh in 2 regions, and the clip `sway` of one second.
#[must_use]
pub fn tube() -> Vec<u8> {
    pack(&tube_meta(), tube_section)
}

/// Counts and constants of [`tube`].
#[must_use]
pub fn tube_meta() -> Meta {
    Meta {
        points: POINTS,
        active: ACTIVE,
        vertices: VERTICES,
        joints: JOINTS,
        stride: 4,
        regions: 2,
        moved: moved().len().try_into().unwrap_or(0),
        lit: moved().len().try_into().unwrap_or(0),
        nodes: JOINTS,
        clips: 1,
        channels: 3,
        times: 3 + 2 + 1,
        values: 3 * 4 + 2 * 9 + 3,
        primitives: 1,
        body_size: 1.125,
        bind_down: [0.0, -1.0, 0.0],
        gravity: 5.0,
        source: 0x0123_4567_89ab_cdef,
    }
}

/// Bytes on a multiple of four, padded with zeros to whole words.
#[must_use]
pub fn aligned(bytes: &[u8]) -> Vec<u32> {
    let mut words = vec![0_u32; bytes.len().div_ceil(4)];
    bytemuck::cast_slice_mut::<u32, u8>(&mut words)[..bytes.len()].copy_from_slice(bytes);
    words
}

/// Writes the content hash of changed bytes, so that the change is not taken for damage.
pub fn seal(bytes: &mut [u8]) {
    let hash = content_hash(bytes);
    bytes[HASH_OFFSET..HASH_OFFSET + 8].copy_from_slice(&hash.to_le_bytes());
}

/// Where a section stands in a whole asset.
///
/// # Panics
///
/// If the bytes end before the section table.
#[must_use]
pub fn place_of(bytes: &[u8], section: Section) -> Range<usize> {
    let at = |entry: usize| {
        let word = bytes[entry..].first_chunk().expect("the table is there");
        u32::from_le_bytes(*word) as usize
    };
    let index = Section::ALL.iter().position(|s| *s == section).unwrap_or(0);
    let entry = HEADER_LEN + index * ENTRY_LEN;
    at(entry + 4)..at(entry + 4) + at(entry + 8)
}

/// Header, table and sections, whatever they hold: `section` writes each.
#[must_use]
pub fn pack(meta: &Meta, section: impl Fn(Section, &Meta) -> Vec<u8>) -> Vec<u8> {
    let start = HEADER_LEN + Section::ALL.len() * ENTRY_LEN;
    let (mut table, mut body) = (Vec::new(), Vec::new());
    for s in Section::ALL {
        while !(start + body.len()).is_multiple_of(16) {
            body.push(0);
        }
        let bytes = section(s, meta);
        table.extend(s.tag());
        table.extend(word(start + body.len()));
        table.extend(word(bytes.len()));
        table.extend([0; 4]);
        body.extend(bytes);
    }
    let mut out = Vec::from(MAGIC);
    out.extend([1, 0]);
    out.extend(&word(Section::ALL.len())[..2]);
    out.extend(word(start + body.len()));
    out.resize(HEADER_LEN, 0);
    out.extend(table);
    out.extend(body);
    seal(&mut out);
    out
}

fn word(n: usize) -> [u8; 4] {
    u32::try_from(n).unwrap_or(u32::MAX).to_le_bytes()
}

/// Little-endian words.
pub fn words(words: impl IntoIterator<Item = u32>) -> Vec<u8> {
    words.into_iter().flat_map(u32::to_le_bytes).collect()
}

/// Little-endian floats.
pub fn floats(x: impl IntoIterator<Item = f32>) -> Vec<u8> {
    x.into_iter().flat_map(f32::to_le_bytes).collect()
}

/// A name, padded with zeros.
#[must_use]
pub fn text<const N: usize>(name: &str) -> [u8; N] {
    core::array::from_fn(|i| name.as_bytes().get(i).copied().unwrap_or(0))
}

/// Ring of a point, from the top down, and its place on the ring.
fn place(point: u32) -> (u32, u32) {
    (RINGS - 1 - point / AROUND, point % AROUND)
}

fn direction(around: u32) -> [f32; 3] {
    [[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [-1.0, 0.0, 0.0], [0.0, 0.0, -1.0]][(around % AROUND) as usize]
}

fn small(x: u32) -> f32 {
    f32::from(u16::try_from(x).unwrap_or(u16::MAX))
}

fn rest(point: u32) -> [f32; 3] {
    let (ring, around) = place(point);
    let [x, _, z] = direction(around);
    [0.25 * x, 0.25 * small(ring), 0.25 * z]
}

/// Joint and weight, twice: rings on a joint's height belong to it, those between to both neighbours.
fn influences(point: u32) -> [(u16, f32); 4] {
    let [a, b] = match place(point).0 {
        0 => [(0, 1.0), (0, 0.0)],
        1 => [(0, 0.5), (1, 0.5)],
        2 => [(1, 1.0), (0, 0.0)],
        3 => [(1, 0.625), (2, 0.375)],
        _ => [(2, 1.0), (0, 0.0)],
    };
    [a, b, (0, 0.0), (0, 0.0)]
}

fn point_of_vertex(vertex: u32) -> u32 {
    if vertex < POINTS { vertex } else { (vertex - POINTS) * AROUND }
}

fn moved() -> Vec<u32> {
    (0..VERTICES).filter(|v| point_of_vertex(*v) < ACTIVE).collect()
}

/// The neighbours above and below, left and right; the own point at the end of the tube.
fn stencil(vertex: u32) -> [(u32, [f32; 3]); 4] {
    let point = point_of_vertex(vertex);
    let (ring, around) = place(point);
    let of = |ring: u32, around: u32| (RINGS - 1 - ring) * AROUND + around % AROUND;
    let [x, _, z] = direction(around + 1);
    let (turn, back) = ([2.0 * x, 0.0, 2.0 * z], [-2.0 * x, 0.0, -2.0 * z]);
    let above = if ring + 1 < RINGS { (of(ring + 1, around), [0.0, 2.0, 0.0]) } else { (point, [0.0; 3]) };
    [
        above,
        (of(ring - 1, around), [0.0, -2.0, 0.0]),
        (of(ring, around + 1), turn),
        (of(ring, around + AROUND - 1), back),
    ]
}

/// Bytes of a section of [`tube`].
#[must_use]
pub fn tube_section(section: Section, meta: &Meta) -> Vec<u8> {
    let points = 0..POINTS;
    match section {
        Section::Meta => words(meta.to_words()),
        Section::Rest => floats(points.flat_map(rest)),
        Section::InfluenceJoints => {
            points.flat_map(influences).flat_map(|(joint, _)| joint.to_le_bytes()).collect()
        }
        Section::InfluenceWeights => floats(points.flat_map(influences).map(|(_, w)| w)),
        Section::RegionOfPoint => (0..ACTIVE).map(|p| u8::from(p >= AROUND)).collect(),
        Section::Softness => floats((0..ACTIVE).map(|p| 1.0 - 0.25 * small(p / AROUND))),
        Section::PointOfVertex => words((0..VERTICES).map(point_of_vertex)),
        Section::Normals => floats((0..VERTICES).flat_map(|v| direction(place(point_of_vertex(v)).1))),
        Section::Moved | Section::Lit => words(moved()),
        Section::StencilPoints => words(moved().into_iter().flat_map(stencil).map(|(p, _)| p)),
        Section::StencilTangents => floats(moved().into_iter().flat_map(stencil).flat_map(|(_, g)| g)),
        Section::Regions => floats([2.5, 0.25, 1.0, 0.25, 4.0, 0.5, 0.75, 0.125]),
        Section::RegionNames => [text::<16>("tip"), text("middle")].concat(),
        Section::Primitives => words([0, 0, 0, 0, VERTICES, 0]),
        other => skeleton(other),
    }
}

fn skeleton(section: Section) -> Vec<u8> {
    let height = |i: u32| 0.5 * small(i);
    let rotation = [[0.0, 0.0, 0.0, 1.0], [0.0, 0.0, 0.28, 0.96], [0.28, 0.0, 0.0, 0.96]];
    let moves =
        [[0.0, 0.5, 0.0], [0.0, 0.0, 0.0], [0.1, 0.0, 0.0], [0.1, 0.0, 0.0], [0.0, 0.6, 0.1], [0.0; 3]];
    match section {
        Section::JointFromBind => floats(
            (0..JOINTS).flat_map(|i| [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, -height(i), 0.0]),
        ),
        Section::JointNode | Section::NodeIndex => words(0..JOINTS),
        Section::Parents => words([NO_PARENT, 0, 1]),
        Section::NodeRest => floats((0..JOINTS).flat_map(|i| {
            let up = if i == 0 { 0.0 } else { 0.5 };
            [0.0, up, 0.0, 0.0, 0.0, 0.0, 1.0, 1.0, 1.0, 1.0]
        })),
        Section::Clips => words([0, 3, 1.0_f32.to_bits(), 0]),
        Section::ClipNames => text::<32>("sway").to_vec(),
        // Rotation of node 1, linear; translation of node 2, cubic; scale of node 0, step.
        Section::Channels => words([1, 1 + 4, 0, 3, 0, 0, 2, 8, 3, 2, 12, 0, 0, 2, 5, 1, 30, 0]),
        Section::Times => floats([0.0, 0.5, 1.0, 0.0, 1.0, 0.0]),
        Section::Values => floats(rotation.concat().into_iter().chain(moves.concat()).chain([1.0, 1.0, 1.0])),
        other => unreachable!("section {other} is written above"),
    }
}
