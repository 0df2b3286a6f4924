//! `sinew play`.

use super::pictures::Pictures;
use super::{Outcome, load, progress};
use serde_json::json;
use sinew::Character;
use sinew_bake::export::morph::{self, MorphFrame};
use sinew_bake::export::{self, npy};
use sinew_bake::play::{Frame, Motion, Player, Settings};
use sinew_bake::{Error, Model};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

#[derive(Debug, clap::Args)]
pub(super) struct Arguments {
    /// A rigged .glb, .gltf or .vrm; `builtin` is the character that comes with sinew
    input: PathBuf,
    /// The asset; without it the character is baked by the auto recipe
    #[arg(long)]
    asset: Option<PathBuf>,
    /// Skinning alone
    #[arg(long)]
    no_flesh: bool,
    /// Name of the clip; the first without it, a built-in shake where there is none
    #[arg(long)]
    clip: Option<String>,
    /// Frames a second
    #[arg(long, default_value_t = 60.0)]
    fps: f32,
    /// Length in seconds; one round of the clip without it
    #[arg(long)]
    seconds: Option<f32>,
    /// Draw only the fleshed character in a GIF, without skinning beside it
    #[arg(long)]
    alone: bool,
    /// Height of pictures, pixels
    #[arg(long, default_value_t = 360)]
    height: u16,
    /// What to write: .png (contact sheet), .gif, .glb (morph animation), .npy (frames × vertices × 3), .replay, .json
    #[arg(short, long)]
    out: PathBuf,
}

pub(super) fn run(arguments: &Arguments) -> Result<Outcome, Error> {
    let model = load::character(&arguments.input)?;
    let aligned = load::asset(&model, arguments.asset.as_deref())?;
    let name = arguments.asset.as_deref().unwrap_or(&arguments.input);
    let asset = load::parse(name, &aligned)?;
    let settings = Settings {
        clip: arguments.clip.clone(),
        fps: arguments.fps,
        seconds: arguments.seconds,
        tunables: load::tunables(arguments.asset.as_deref(), &asset)?,
    };
    let mut memory = vec![0.0; Character::required_len(&asset)];
    let mut player = Player::new(&model, asset, &mut memory, &settings)?;
    let summary = write(arguments, &model, &mut player)?;
    let (clip, frames) = (clip_name(&player.motion), player.frames);
    let line = format!(
        "{}: {clip}, {frames} frames at {} Hz, largest offset {:.1} % of the body",
        arguments.out.display(),
        player.fps,
        100.0 * summary.largest
    );
    Ok(Outcome {
        json: json!({
            "out": arguments.out, "clip": clip, "frames": frames, "fps": player.fps,
            "vertices": model.vertex_count(), "largest_offset": summary.largest,
            "mean_offset": summary.mean,
        }),
        lines: vec![line],
        ok: true,
    })
}

fn clip_name(motion: &Motion) -> &str {
    match motion {
        Motion::Clip { name, .. } => name,
        Motion::Shake => "built-in shake",
    }
}

/// Offsets over a run, body sizes.
#[derive(Default)]
struct Summary {
    largest: f32,
    mean: f64,
}

impl Summary {
    fn add(&mut self, frame: &Frame, frames: u32) {
        self.largest = frame.heat.iter().copied().fold(self.largest, f32::max);
        let sum: f64 = frame.heat.iter().map(|h| f64::from(*h)).sum();
        #[allow(clippy::cast_precision_loss, reason = "counts")]
        let count = frame.heat.len().max(1) as f64 * f64::from(frames);
        self.mean += sum / count;
    }
}

/// Runs the player and writes what the ending of the output asks for.
fn write(arguments: &Arguments, model: &Model, player: &mut Player<'_>) -> Result<Summary, Error> {
    let (out, flesh) = (arguments.out.as_path(), !arguments.no_flesh);
    let ending = out.extension().unwrap_or_default().to_string_lossy().to_lowercase();
    let pictures = Pictures::new(model, usize::from(arguments.height), flesh, !arguments.alone && flesh);
    match ending.as_str() {
        "npy" => array(out, player, flesh),
        "glb" => animation(out, model, player, flesh),
        "json" => figures(out, model, player),
        "replay" => replay(out, player),
        "png" => each_twice(player, |player| pictures.sheet(out, player)),
        "gif" => each_twice(player, |player| pictures.gif(out, player)),
        _ => Err(Error::unusable(
            out.display().to_string(),
            "--out",
            format!("the ending `.{ending}` is not known"),
            "choose .png, .gif, .glb, .npy, .replay or .json",
        )),
    }
}

/// Pictures need the extent of the whole motion first: all frames are kept, then drawn.
fn each_twice(
    player: &mut Player<'_>,
    draw: impl FnOnce(&[Frame]) -> Result<(), Error>,
) -> Result<Summary, Error> {
    let mut frames = Vec::new();
    let summary = every(player, |frame| {
        frames.push(frame.clone());
        Ok(())
    })?;
    draw(&frames)?;
    Ok(summary)
}

/// Calls `f` with every frame.
fn every(player: &mut Player<'_>, mut f: impl FnMut(&Frame) -> io::Result<()>) -> Result<Summary, Error> {
    let (mut summary, frames) = (Summary::default(), player.frames);
    let bar = progress("play", u64::from(frames));
    while let Some(frame) = player.next()? {
        summary.add(frame, frames);
        f(frame).map_err(|source| Error::Write { path: PathBuf::from("output"), source })?;
        bar.inc(1);
    }
    bar.finish_and_clear();
    Ok(summary)
}

fn shown(frame: &Frame, flesh: bool) -> (&[[f32; 3]], &[[f32; 3]]) {
    if flesh { (&frame.flesh, &frame.flesh_normals) } else { (&frame.skinned, &frame.skinned_normals) }
}

fn array(out: &Path, player: &mut Player<'_>, flesh: bool) -> Result<Summary, Error> {
    let mut result = Ok(Summary::default());
    export::write_atomic(out, |file| {
        let vertices = player.character().asset().meta.vertices as usize;
        npy::header(file, player.frames, vertices)?;
        let mut failed = None;
        result = every(player, |frame| {
            npy::frame(file, shown(frame, flesh).0).inspect_err(|e| {
                failed = Some(e.kind());
            })
        });
        failed.map_or(Ok(()), |kind| Err(io::Error::from(kind)))
    })?;
    result
}

fn animation(out: &Path, model: &Model, player: &mut Player<'_>, flesh: bool) -> Result<Summary, Error> {
    let (kept, fps) = (morph::kept(player.frames as usize), player.fps);
    let mut frames = Vec::new();
    let summary = every(player, |frame| {
        if kept.contains(&(frame.index as usize)) {
            let (positions, normals) = shown(frame, flesh);
            #[allow(clippy::cast_precision_loss, reason = "frames")]
            let time = frame.index as f32 / fps;
            frames.push(MorphFrame { time, positions: positions.to_vec(), normals: normals.to_vec() });
        }
        Ok(())
    })?;
    export::write_bytes(out, &morph::to_glb(model, clip_name(&player.motion), &frames)?)?;
    Ok(summary)
}

fn replay(out: &Path, player: &mut Player<'_>) -> Result<Summary, Error> {
    player.record()?;
    let summary = every(player, |_| Ok(()))?;
    let (bytes, _) = player.recorded()?;
    export::write_bytes(out, &bytes)?;
    Ok(summary)
}

fn figures(out: &Path, model: &Model, player: &mut Player<'_>) -> Result<Summary, Error> {
    let mut rows = Vec::new();
    let summary = every(player, |frame| {
        let largest = frame.heat.iter().copied().fold(0.0, f32::max);
        rows.push(json!({"frame": frame.index, "time": frame.time, "largest_offset": largest}));
        Ok(())
    })?;
    let text = json!({
        "character": model.name, "clip": clip_name(&player.motion), "fps": player.fps,
        "largest_offset": summary.largest, "mean_offset": summary.mean, "frames": rows,
    })
    .to_string();
    export::write_atomic(out, |file| writeln!(file, "{text}"))?;
    Ok(summary)
}
