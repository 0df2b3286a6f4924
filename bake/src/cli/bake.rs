//! `sinew bake`.

use super::{Outcome, kilobytes, load, progress};
use serde_json::json;
use sinew_bake::recipe::{Recipe, flesh};
use sinew_bake::tunables::TunablesFile;
use sinew_bake::{Error, export, pack};
use std::fs;
use std::path::{Path, PathBuf};

#[derive(Debug, clap::Args)]
pub(super) struct Arguments {
    /// A rigged .glb, .gltf or .vrm; `builtin` is the character that comes with sinew
    input: PathBuf,
    /// The asset to write
    #[arg(short, long)]
    out: PathBuf,
    /// Knobs and rules over the automatic choice, TOML
    #[arg(long)]
    recipe: Option<PathBuf>,
    /// Folder for a page with pictures
    #[arg(long)]
    report: Option<PathBuf>,
}

pub(super) fn run(arguments: &Arguments) -> Result<Outcome, Error> {
    let bar = progress::bar("bake", 4);
    let model = load::character(&arguments.input)?;
    bar.inc(1);
    let recipe = match &arguments.recipe {
        None => Recipe::default(),
        Some(path) => {
            let text = String::from_utf8_lossy(&load::read(path)?).into_owned();
            Recipe::from_toml(&path.display().to_string(), &text)?
        }
    };
    let flesh = flesh(&model, &recipe)?;
    bar.inc(1);
    let bytes = pack::pack(&model, &flesh, load::source(&arguments.input))?;
    export::write_bytes(&arguments.out, &bytes)?;
    let aligned = pack::align(&bytes);
    let asset = load::parse(&arguments.out, &aligned)?;
    let mut notes = flesh.notes.clone();
    notes.extend(write_tunables(&arguments.out, &asset)?);
    bar.inc(1);
    if let Some(folder) = &arguments.report {
        sinew_bake::report::character(&model, &flesh, &aligned, folder)?;
    }
    bar.finish_and_clear();
    let m = &asset.meta;
    let regions: Vec<&str> = flesh.regions.iter().map(|r| r.name.as_str()).collect();
    let mut lines = vec![format!(
        "{}: {} vertices, {} of {} points with flesh, {} joints, {} clips, {} ({:016x})",
        arguments.out.display(),
        m.vertices,
        m.active,
        m.points,
        m.joints,
        m.clips,
        kilobytes(bytes.len()),
        asset.hash
    )];
    lines.push(format!("regions: {}", regions.join(", ")));
    lines.extend(notes.iter().map(|n| format!("note: {n}")));
    Ok(Outcome {
        json: json!({
            "asset": arguments.out, "hash": format!("{:016x}", asset.hash), "bytes": bytes.len(),
            "vertices": m.vertices, "points": m.points, "active": m.active, "joints": m.joints,
            "clips": m.clips, "regions": flesh.regions, "symmetric": flesh.mirror.is_some(), "notes": notes,
        }),
        lines,
        ok: true,
    })
}

/// Writes the knobs beside the asset; knobs for another asset are kept aside, not lost.
fn write_tunables(out: &Path, asset: &sinew::Asset<'_>) -> Result<Option<String>, Error> {
    let path = load::tunables_path(out);
    let file = TunablesFile::of(asset);
    let mut note = None;
    if let Ok(old) = fs::read_to_string(&path) {
        if TunablesFile::read("", &old, asset).is_ok() {
            return Ok(Some(format!("{} is kept", path.display())));
        }
        let aside = path.with_extension("json.old");
        export::write_bytes(&aside, old.as_bytes())?;
        note = Some(format!("tunables of another asset are kept as {}", aside.display()));
    }
    let text = serde_json::to_string_pretty(&file)
        .map_err(|e| Error::unusable("tunables", "JSON", e.to_string(), "please report this"))?;
    export::write_bytes(&path, format!("{text}\n").as_bytes())?;
    Ok(note)
}
