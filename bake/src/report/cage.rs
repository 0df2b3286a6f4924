//! The page about a cage: what it looks like, what follows the bones, whose weights its nodes have.

use super::character::{PALETTE, Rest, SIZE, VIEWS, grouped};
use super::{Block, Fact, Image, Picture, Report, Section};
use crate::cage::Body;
use crate::cage::embed::packing_error;
use crate::film::front;
use crate::pack::narrow;
use crate::render::{Camera, Paint, Show, Surface, heat_color, linear, render};
use crate::{Error, Model};
use glam::DVec3;
use std::fs;
use std::path::Path;

/// Share of a triangle's corners that is given to its middle, so that the edges show.
const INSET: f64 = 0.07;
/// What is seen between triangles lies this share of an edge deeper.
const DEPTH: f64 = 0.02;
/// Linear color of the edges.
const EDGE: [f32; 3] = [0.03, 0.03, 0.035];

/// Writes `index.html` into `folder`: the cage from three sides and cut open, what holds it, skin weights.
///
/// # Errors
///
/// [`Error::Write`] when the folder cannot be written.
pub fn cage(model: &Model, body: &Body, folder: &Path) -> Result<(), Error> {
    fs::create_dir_all(folder).map_err(|source| Error::Write { path: folder.to_owned(), source })?;
    let notes: Vec<String> = body.notes().map(str::to_owned).collect();
    let mut sections = vec![looks(model, body), holds(model, body), weights(model, body)];
    if !notes.is_empty() {
        sections.push(Section { heading: "Notes".to_owned(), blocks: vec![Block::List(notes)] });
    }
    let report = Report {
        title: format!("The cage of {}", model.name),
        summary: "Tetrahedra around the skin, and what holds them to the bones.".to_owned(),
        facts: facts(body),
        sections,
    };
    report.write(&folder.join("index.html"))
}

fn facts(body: &Body) -> Vec<Fact> {
    let cage = &body.cage;
    let error = packing_error(cage, &body.places, &cage.rest) / cage.edge;
    let free = cage.rest.len() - body.binding.fixed.len() - body.binding.springs.len();
    [
        ("nodes", grouped(cage.rest.len() as u64)),
        ("tetrahedra", grouped(cage.tets.len() as u64)),
        ("edge, % of the body", format!("{:.2}", 100.0 * cage.edge / body.surface.size)),
        ("parts", cage.components.to_string()),
        ("fixed nodes", grouped(body.binding.fixed.len() as u64)),
        ("pulled nodes", grouped(body.binding.springs.len() as u64)),
        ("free nodes", grouped(free as u64)),
        ("packing error, edges", format!("{error:.1e}")),
    ]
    .map(|(name, value)| Fact { name: name.to_owned(), value })
    .into()
}

fn looks(model: &Model, body: &Body) -> Section {
    let rest = Rest::new(model);
    let skin = |(name, azimuth): (&str, f32)| Picture {
        image: Image::Still(rest.draw(front(model) + azimuth, Show::Materials)),
        caption: format!("Skin, {name}"),
    };
    let gray = vec![[0.60, 0.58, 0.55]; body.cage.rest.len()];
    Section {
        heading: "Skin and cage".to_owned(),
        blocks: vec![
            Block::Views(VIEWS.map(skin).into()),
            views(model, body, "Cage", &gray, false),
            views(model, body, "Cage, cut open", &gray, true),
        ],
    }
}

fn holds(model: &Model, body: &Body) -> Section {
    let color = |hold: f64| match hold {
        h if h >= 1.0 => PALETTE[0].map(linear),
        h if h > 0.0 => heat_color(narrow(0.15 + 0.5 * h)).map(linear),
        _ => [0.74, 0.72, 0.68],
    };
    let colors: Vec<[f32; 3]> = body.holds().into_iter().map(color).collect();
    Section {
        heading: "What follows the bones".to_owned(),
        blocks: vec![
            Block::Text(
                "Blue nodes are fixed to the bones, yellow to red ones are pulled, pale ones are free."
                    .into(),
            ),
            views(model, body, "Held from outside", &colors, false),
            views(model, body, "Held, cut open", &colors, true),
        ],
    }
}

fn weights(model: &Model, body: &Body) -> Section {
    let blend = |row: &Vec<(u32, f64)>| {
        let of = |k: usize| {
            row.iter()
                .map(|(node, w)| f64::from(linear(PALETTE[*node as usize % PALETTE.len()][k])) * w)
                .sum()
        };
        [0, 1, 2].map(|k| narrow(of(k)))
    };
    let colors: Vec<[f32; 3]> = body.binding.weights.iter().map(blend).collect();
    Section {
        heading: "Skin weights".to_owned(),
        blocks: vec![
            Block::Text("A color a joint, mixed by weight; joints share eight colors.".to_owned()),
            views(model, body, "Weights", &colors, false),
            views(model, body, "Weights, cut open", &colors, true),
        ],
    }
}

/// Three views of the cage in the colors of its nodes; what is cut is the half that is nearer.
fn views(model: &Model, body: &Body, what: &str, colors: &[[f32; 3]], cut: bool) -> Block {
    let picture = |(name, azimuth): (&str, f32)| Picture {
        image: Image::Still(draw(body, colors, front(model) + azimuth, cut)),
        caption: format!("{what}, {name}"),
    };
    Block::Views(VIEWS.map(picture).into())
}

fn draw(body: &Body, colors: &[[f32; 3]], azimuth: f32, cut: bool) -> image::RgbImage {
    let cage = &body.cage;
    let (sin, cos) = libm::sincos(f64::from(azimuth));
    let near = DVec3::new(sin, 0.0, cos);
    let (low, high) = body.surface.bounds();
    let depth = |p: &DVec3| (*p - 0.5 * (low + high)).dot(near);
    // Through nodes, so that cubes stay whole.
    let middle = cage.rest.iter().map(depth).min_by(|a, b| a.abs().total_cmp(&b.abs())).unwrap_or(0.0);
    let behind = |i: &u32| depth(&cage.rest[*i as usize]) <= middle + 1e-6 * cage.edge;
    let kept: Vec<[u32; 4]> = cage.tets.iter().filter(|t| !cut || t.iter().all(behind)).copied().collect();
    let [faces, gaps] = [INSET, 0.0].map(|inset| Faces::new(body, &cage.boundary(&kept), colors, inset));
    let [width, height] = SIZE;
    #[allow(clippy::cast_precision_loss, reason = "pixels")]
    let aspect = width as f32 / height as f32;
    let all = cage.rest.iter().map(|p| p.to_array().map(narrow));
    let camera = Camera::framing(all, aspect, azimuth, 0.12);
    render(
        &[faces.surface(Paint::Colors(&faces.colors)), gaps.surface(Paint::Flat(EDGE))],
        &camera,
        width,
        height,
    )
}

/// Triangles of a cage, each with corners of its own.
struct Faces {
    positions: Vec<[f32; 3]>,
    normals: Vec<[f32; 3]>,
    colors: Vec<[f32; 3]>,
    triangles: Vec<[u32; 3]>,
}

impl Faces {
    /// Triangles drawn to their middles; those that are not are drawn a little deeper.
    fn new(body: &Body, faces: &[[u32; 3]], colors: &[[f32; 3]], inset: f64) -> Self {
        let mut out =
            Self { positions: Vec::new(), normals: Vec::new(), colors: Vec::new(), triangles: Vec::new() };
        let deeper = if inset > 0.0 { 0.0 } else { DEPTH * body.cage.edge };
        for (number, face) in (0_u32..).zip(faces) {
            let [a, b, c] = face.map(|i| body.cage.rest[i as usize]);
            let normal = (b - a).cross(c - a).normalize_or(DVec3::Y);
            let middle = (a + b + c) / 3.0;
            for (i, p) in face.iter().zip([a, b, c]) {
                out.positions.push((p.lerp(middle, inset) - normal * deeper).to_array().map(narrow));
                out.normals.push(normal.to_array().map(narrow));
                out.colors.push(colors[*i as usize]);
            }
            out.triangles.push([0, 1, 2].map(|k| 3 * number + k));
        }
        out
    }

    fn surface<'a>(&'a self, paint: Paint<'a>) -> Surface<'a> {
        Surface {
            positions: &self.positions,
            normals: &self.normals,
            uvs: &[],
            triangles: &self.triangles,
            paint,
            double_sided: true,
        }
    }
}
