//! `sinew cage`.

use super::{Outcome, load, progress};
use serde_json::json;
use sinew_bake::cage::embed::packing_error;
use sinew_bake::cage::{Body, Joining, Options, Resolution, Shape};
use sinew_bake::{Error, export, report};
use std::path::PathBuf;

#[derive(Debug, clap::Args)]
pub(super) struct Arguments {
    /// A rigged .glb, .gltf or .vrm; `builtin` is the character that comes with sinew
    input: PathBuf,
    /// The .glb to write: the skin, and the edges of the cage as lines
    #[arg(short, long)]
    out: PathBuf,
    /// Edge of a cube in the file's units
    #[arg(long, conflicts_with = "vertices")]
    size: Option<f64>,
    /// Most nodes that the cage may have
    #[arg(long, default_value_t = 2000)]
    vertices: usize,
    /// Fit the cage to the skin instead of filling cubes; parts that touch nowhere stay apart
    #[arg(long)]
    fit: bool,
    /// Leave parts that touch nowhere apart instead of bridging them
    #[arg(long)]
    apart: bool,
    /// Folder for a page with pictures
    #[arg(long)]
    report: Option<PathBuf>,
}

pub(super) fn run(arguments: &Arguments) -> Result<Outcome, Error> {
    let bar = progress::bar("cage", 3);
    let model = load::character(&arguments.input)?;
    bar.inc(1);
    let options = Options {
        shape: if arguments.fit { Shape::Fitted } else { Shape::Cubes },
        resolution: arguments.size.map_or(Resolution::Vertices(arguments.vertices), Resolution::Size),
        joining: if arguments.apart { Joining::Apart } else { Joining::Bridged },
        ..Options::default()
    };
    let body = Body::new(&model, &options)?;
    export::write_bytes(&arguments.out, &export::cage::to_glb(&body)?)?;
    bar.inc(1);
    if let Some(folder) = &arguments.report {
        report::cage(&model, &body, folder)?;
    }
    bar.finish_and_clear();
    let (cage, binding) = (&body.cage, &body.binding);
    let [nodes, fixed, springs] = [cage.rest.len(), binding.fixed.len(), binding.springs.len()];
    let notes: Vec<&str> = body.notes().collect();
    let mut lines = vec![format!(
        "{}: {nodes} nodes, {} tetrahedra in cubes of an edge of {:.3}, {} part{}; {fixed} nodes fixed, {springs} pulled, {} free",
        arguments.out.display(),
        cage.tets.len(),
        cage.edge,
        cage.components,
        if cage.components == 1 { "" } else { "s" },
        nodes - fixed - springs,
    )];
    lines.extend(notes.iter().map(|n| format!("note: {n}")));
    Ok(Outcome {
        json: json!({
            "cage": arguments.out, "nodes": nodes, "tets": cage.tets.len(), "edge": cage.edge,
            "components": cage.components, "volume": cage.volume(), "vertices": body.embedded(),
            "fixed": fixed, "springs": springs, "free": nodes - fixed - springs,
            "packing_error": packing_error(cage, &body.places, &cage.rest), "notes": notes,
        }),
        lines,
        ok: true,
    })
}
