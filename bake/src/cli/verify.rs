//! `sinew verify`.

use super::{Outcome, kilobytes, load, progress};
use serde_json::{Value, json};
use sinew::Character;
use sinew::replay::{Extent, HeaderField, Replay, Verdict, verify};
use sinew_bake::{Error, pack};
use std::fs;
use std::path::{Path, PathBuf};

#[derive(Debug, clap::Args)]
pub(super) struct Arguments {
    /// The recording
    file: PathBuf,
    /// The asset; without it, the one in the recording's folder that has the recorded hash
    #[arg(long)]
    asset: Option<PathBuf>,
}

pub(super) fn run(arguments: &Arguments) -> Result<Outcome, Error> {
    let bytes = load::read(&arguments.file)?;
    let replay = parse(&arguments.file, &bytes)?;
    let path = match &arguments.asset {
        Some(path) => path.clone(),
        None => find(&arguments.file, replay.header(HeaderField::AssetHash))?,
    };
    let aligned = pack::align(&load::read(&path)?);
    let asset = load::parse(&path, &aligned)?;
    let mut memory = vec![0.0; Character::required_len(&asset)];
    let refuse = |problem: String, code| {
        let file = arguments.file.display().to_string();
        Error::unusable(file, "replay", problem, "record it again").coded(code)
    };
    let mut character = Character::new(asset, &mut memory).map_err(|e| refuse(e.to_string(), e.code()))?;
    let bar = progress::bar("verify", replay.finished().frames);
    let verdict = verify(&mut character, &replay, Extent::FirstDifference, |done, _| bar.set_position(done));
    bar.finish_and_clear();
    let name = arguments.file.display();
    Ok(match verdict.map_err(|e| refuse(e.to_string(), e.code()))? {
        Verdict::Same { frames } => Outcome {
            json: json!({"replay": arguments.file, "same": true, "frames": frames,
                "digest": format!("{:016x}", replay.finished().digest)}),
            lines: vec![format!("{name}: {frames} frames, identical ({:016x})", replay.finished().digest)],
            ok: true,
        },
        Verdict::Different(difference) => Outcome {
            json: json!({"replay": arguments.file, "same": false, "frame": difference.frame,
                "stage": difference.stage.map(|s| s.to_string()), "difference": difference.to_string()}),
            lines: vec![format!("{name}: {difference}")],
            ok: false,
        },
    })
}

fn parse<'a>(file: &Path, bytes: &'a [u8]) -> Result<Replay<'a>, Error> {
    Replay::parse(bytes).map_err(|e| {
        let file = file.display().to_string();
        Error::unusable(file, "replay", e.to_string(), "record it again").coded(e.code())
    })
}

/// The asset with the hash `hash` beside `file`.
fn find(file: &Path, hash: u64) -> Result<PathBuf, Error> {
    let folder = file.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let mut entries: Vec<PathBuf> =
        fs::read_dir(folder).into_iter().flatten().flatten().map(|e| e.path()).collect();
    entries.sort();
    let fits = |path: &PathBuf| {
        let aligned = pack::align(&fs::read(path).unwrap_or_default());
        load::parse(path, &aligned).is_ok_and(|asset| asset.hash == hash)
    };
    let asset = entries.into_iter().filter(|p| p.extension().is_some_and(|e| e == "sinew")).find(fits);
    asset.ok_or_else(|| {
        let problem = format!("its asset {hash:016x} is not in the same folder");
        Error::unusable(file.display().to_string(), "asset", problem, "name it with --asset")
    })
}

/// What `sinew inspect` says of a recording.
pub(super) fn inspect(file: &Path, bytes: &[u8]) -> Result<Value, Error> {
    let replay = parse(file, bytes)?;
    let finished = replay.finished();
    let snapshots = replay.header(HeaderField::SnapshotEvery);
    Ok(json!({
        "kind": "replay", "size": kilobytes(bytes.len()), "frames": finished.frames,
        "digest": format!("{:016x}", finished.digest), "asset": format!("{:016x}", replay.header(HeaderField::AssetHash)),
        "joints": replay.header(HeaderField::Joints), "snapshot_every": snapshots,
    }))
}
