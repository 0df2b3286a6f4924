//! The page about a baked character: its motion, where its flesh is, and what the asset holds.

use super::{Bar, Block, COLORS, Fact, Histogram, Image, Picture, Report, Section, motion};
use crate::film::front;
use crate::recipe::Flesh;
use crate::render::{Camera, Figure, Pose, Show};
use crate::{Error, Model, pack};
use core::f32::consts::PI;
use glam::DVec3;
use sinew::asset::Section as Part;
use sinew::{Asset, Character};
use std::fs;
use std::path::Path;

/// Pixels of a picture of the rest pose.
pub(super) const SIZE: [u32; 2] = [360, 420];
/// Views: name and azimuth from the front, radians.
pub(super) const VIEWS: [(&str, f32); 3] = [("front", 0.0), ("side", 0.5 * PI), ("back", PI)];
/// sRGB of the style sheet's colors, for pictures.
pub(super) const PALETTE: [[u8; 3]; COLORS] = [
    [0x2f, 0x6f, 0xd0],
    [0xd9, 0x62, 0x2b],
    [0x2b, 0x9a, 0x66],
    [0x8a, 0x4f, 0xc4],
    [0xc2, 0x3a, 0x72],
    [0x1d, 0x97, 0xab],
    [0x94, 0x80, 0x1b],
    [0x6b, 0x6f, 0x7a],
];

/// Writes `index.html` into `folder`: the liveliest clip, where the flesh is from three sides, regions, sizes.
///
/// # Errors
///
/// [`Error::Write`] when the folder cannot be written, [`Error::Unusable`] for an asset of another version or a clip
/// that cannot be played.
pub fn character(model: &Model, flesh: &Flesh, asset: &[u32], folder: &Path) -> Result<(), Error> {
    let asset = Asset::parse(bytemuck::cast_slice(asset)).map_err(|e| {
        Error::unusable(model.name.as_str(), "report", e.to_string(), "bake the character again")
    })?;
    fs::create_dir_all(folder).map_err(|source| Error::Write { path: folder.to_owned(), source })?;
    let mut sections = vec![motion::section(model, flesh, asset)?];
    sections.push(places(model, flesh));
    if has_flesh(flesh) {
        sections.push(regions(flesh));
    }
    sections.push(contents(&asset));
    if !flesh.notes.is_empty() {
        sections
            .push(Section { heading: "Notes".to_owned(), blocks: vec![Block::List(flesh.notes.clone())] });
    }
    let report =
        Report { title: model.name.clone(), summary: summary(model, flesh), facts: facts(&asset), sections };
    report.write(&folder.join("index.html"))
}

fn has_flesh(flesh: &Flesh) -> bool {
    flesh.softness.iter().any(|s| *s > 0.0)
}

fn summary(model: &Model, flesh: &Flesh) -> String {
    let names: Vec<&str> = flesh.regions.iter().map(|r| r.name.as_str()).collect();
    let symmetric = if flesh.mirror.is_some() { ", the same at the left and at the right" } else { "" };
    let count = |n: usize, what: &str| match n {
        0 => format!("no {what}s"),
        1 => format!("one {what}"),
        _ => format!("{n} {what}s"),
    };
    let clips = count(model.clips.len(), "clip");
    if !has_flesh(flesh) {
        return format!("No flesh was found: this character follows its bones. It has {clips}.");
    }
    let regions = count(names.len(), "region");
    format!("Flesh was found in {regions} ({}){symmetric}. It has {clips}.", names.join(", "))
}

fn facts(asset: &Asset<'_>) -> Vec<Fact> {
    let m = &asset.meta;
    let bytes: u64 = Part::ALL.iter().map(|s| s.byte_len(m)).sum();
    let memory = 4 * Character::required_len(asset) as u64;
    [
        ("vertices", grouped(m.vertices.into())),
        ("points with flesh", grouped(m.active.into())),
        ("joints", grouped(m.joints.into())),
        ("asset", kilobytes(bytes)),
        ("memory of a character", kilobytes(memory)),
    ]
    .map(|(name, value)| Fact { name: name.to_owned(), value })
    .into()
}

/// Where the flesh is, seen from three sides: by softness and by region.
fn places(model: &Model, flesh: &Flesh) -> Section {
    let rest = Rest::new(model);
    let colors: Vec<[f32; 3]> =
        flesh.softness.iter().zip(&flesh.region).map(|(s, r)| color(*s, *r)).collect();
    let row = |what: &str, show: Show<'_>| {
        let picture = |(name, azimuth): (&str, f32)| Picture {
            image: Image::Still(rest.draw(front(model) + azimuth, show)),
            caption: format!("{what}, {name}"),
        };
        Block::Views(VIEWS.map(picture).into())
    };
    let soft = flesh.softness.iter().filter(|s| **s > 0.0).map(|s| f64::from(*s));
    Section {
        heading: "Where the flesh is".to_owned(),
        blocks: vec![
            Block::Text("Grey follows the bones exactly; the darker, the softer.".to_owned()),
            row("Softness", Show::Heat(&flesh.softness)),
            row("Regions", Show::Colors(&colors)),
            Block::Histogram(Histogram::of("Softness of the vertices with flesh", "softness", soft, 20)),
        ],
    }
}

/// Linear color of a vertex on the map of regions: clay where it is rigid.
fn color(softness: f32, region: u8) -> [f32; 3] {
    const CLAY: [f32; 3] = [0.72, 0.70, 0.67];
    let share = (softness * 3.0).clamp(0.0, 1.0);
    let full = PALETTE[usize::from(region) % COLORS].map(crate::render::linear);
    core::array::from_fn(|i| CLAY[i] + (full[i] - CLAY[i]) * share)
}

fn regions(flesh: &Flesh) -> Section {
    let columns = [
        "region",
        "vertices",
        "mean softness",
        "frequency, Hz",
        "damping ratio",
        "gain",
        "at most, % of the body",
    ];
    let row = |(i, r): (usize, &crate::recipe::Region)| {
        let soft =
            flesh.softness.iter().zip(&flesh.region).filter(|(s, k)| **s > 0.0 && usize::from(**k) == i);
        let (count, sum) = soft.fold((0_u32, 0.0), |(n, sum), (s, _)| (n + 1, sum + f64::from(*s)));
        let cells = vec![
            r.name.clone(),
            grouped(count.into()),
            format!("{:.2}", sum / f64::from(count.max(1))),
            format!("{:.2}", r.frequency),
            format!("{:.2}", r.damping),
            format!("{:.2}", r.gain),
            format!("{:.0}", 100.0 * r.max_offset),
        ];
        (Some(i), cells)
    };
    let rows = flesh.regions.iter().enumerate().map(row).collect();
    Section {
        heading: "Regions".to_owned(),
        blocks: vec![
            Block::Table { columns: columns.map(str::to_owned).into(), rows },
            Block::Plot(motion::response(&flesh.regions)),
        ],
    }
}

/// What takes room in the asset.
fn contents(asset: &Asset<'_>) -> Section {
    let m = &asset.meta;
    let kinds = ["points", "skin weights", "flesh", "normals", "skeleton", "clips"];
    let mut sizes = [0_u64; 6];
    for part in Part::ALL {
        sizes[kind(part)] += part.byte_len(m);
    }
    let most = sizes.iter().copied().max().unwrap_or(1).max(1);
    #[allow(clippy::cast_precision_loss, reason = "lengths of bars")]
    let bar = |(name, size): (&str, u64)| Bar {
        name: name.to_owned(),
        value: kilobytes(size),
        share: size as f64 / most as f64,
    };
    let rows = [
        ("content hash", format!("{:016x}", asset.hash)),
        ("points, equal vertices counted once", grouped(m.points.into())),
        ("vertices whose normals turn with the flesh", grouped(m.lit.into())),
        ("influences a point", m.stride.to_string()),
        ("clips", m.clips.to_string()),
    ]
    .map(|(name, value)| [name.to_owned(), value]);
    let bars = kinds.into_iter().zip(sizes).map(bar).collect();
    Section {
        heading: "What the asset holds".to_owned(),
        blocks: vec![Block::Bars(bars), Block::Rows(rows.into())],
    }
}

fn kind(part: Part) -> usize {
    use Part::{
        Channels, ClipNames, Clips, InfluenceJoints, InfluenceWeights, JointFromBind, JointNode, Lit, Meta,
        Moved, NodeIndex, NodeRest, Normals, Parents, PointOfVertex, Primitives, RegionNames, RegionOfPoint,
        Regions, Rest, Softness, StencilPoints, StencilTangents, Times, Values,
    };
    match part {
        Rest | PointOfVertex | Moved | Primitives => 0,
        InfluenceJoints | InfluenceWeights => 1,
        RegionOfPoint | Softness | Regions | RegionNames => 2,
        Normals | Lit | StencilPoints | StencilTangents => 3,
        Meta | JointFromBind | JointNode | Parents | NodeIndex | NodeRest => 4,
        Clips | ClipNames | Channels | Times | Values => 5,
    }
}

/// A character as it was modelled.
pub(super) struct Rest<'a> {
    figure: Figure<'a>,
    positions: Vec<[f32; 3]>,
    normals: Vec<[f32; 3]>,
    rigid: Vec<glam::DMat4>,
    /// All points, those of rigid meshes too.
    points: Vec<[f32; 3]>,
}

impl<'a> Rest<'a> {
    pub(super) fn new(model: &'a Model) -> Self {
        let narrow = |p: DVec3| p.to_array().map(pack::narrow);
        let positions: Vec<[f32; 3]> = model.rest_positions().into_iter().map(narrow).collect();
        let mut normals = Vec::new();
        for p in &model.primitives {
            for (n, m) in p.normals.iter().zip(model.rest_blend(p)) {
                let turned = m.transform_vector3(DVec3::from_array(n.map(f64::from)));
                normals.push(narrow(turned.normalize_or(DVec3::Y)));
            }
        }
        let nodes = model.rest_transforms();
        let rigid: Vec<_> = model.rigid.iter().map(|r| nodes[r.node]).collect();
        let mut points = positions.clone();
        for (r, m) in model.rigid.iter().zip(&rigid) {
            points.extend(
                r.positions.iter().map(|p| narrow(m.transform_point3(DVec3::from_array(p.map(f64::from))))),
            );
        }
        Self { figure: Figure::new(model), positions, normals, rigid, points }
    }

    pub(super) fn draw(&self, azimuth: f32, show: Show<'_>) -> image::RgbImage {
        let [width, height] = SIZE;
        #[allow(clippy::cast_precision_loss, reason = "pixels")]
        let camera =
            Camera::framing(self.points.iter().copied(), width as f32 / height as f32, azimuth, 0.12);
        let pose = Pose { positions: &self.positions, normals: &self.normals, rigid: &self.rigid, show };
        self.figure.draw(&pose, &camera, width, height)
    }
}

/// A number with its thousands apart.
pub(super) fn grouped(n: u64) -> String {
    let digits = n.to_string();
    let mut out = String::new();
    for (i, c) in digits.chars().enumerate() {
        if i > 0 && (digits.len() - i).is_multiple_of(3) {
            out.push(',');
        }
        out.push(c);
    }
    out
}

fn kilobytes(n: u64) -> String {
    #[allow(clippy::cast_precision_loss, reason = "for people")]
    let k = n as f64 / 1000.0;
    if k < 1000.0 { format!("{k:.1} kB") } else { format!("{:.2} MB", k / 1000.0) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pictures_have_the_colors_of_the_page() {
        let style = include_str!("style.css");
        for (i, [r, g, b]) in PALETTE.into_iter().enumerate() {
            let rule = format!("--c{i}: #{r:02x}{g:02x}{b:02x};");
            assert!(style.contains(&rule), "{rule} is not in the style sheet");
        }
    }

    #[test]
    fn numbers_are_readable() {
        let shown = [0, 12, 999, 1000, 1_234_567].map(grouped);
        assert_eq!(shown, ["0", "12", "999", "1,000", "1,234,567"]);
        assert_eq!([kilobytes(1_500), kilobytes(2_340_000)], ["1.5 kB", "2.34 MB"]);
    }
}
