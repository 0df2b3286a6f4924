//! `sinew play`.

use super::{Outcome, load, pictures, progress};
use serde_json::json;
use sinew::{Asset, Character};
use sinew_bake::export::morph::{self, MorphFrame};
use sinew_bake::export::{self, npy};
use sinew_bake::play::{Frame, Player, Settings};
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
    pub(super) no_flesh: bool,
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
    pub(super) alone: bool,
    /// Height of pictures, pixels
    #[arg(long, default_value_t = 360, value_parser = clap::value_parser!(u16).range(64..=2000))]
    pub(super) height: u16,
    /// What to write: .png (contact sheet), .gif, .glb (morph animation), .npy (frames × vertices × 3), .replay, .json
    #[arg(short, long)]
    pub(super) out: PathBuf,
}

pub(super) fn run(arguments: &Arguments) -> Result<Outcome, Error> {
    let write = writer(&arguments.out)?;
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
    let memory = vec![0.0; Character::required_len(&asset)];
    let mut run = Run { model: &model, asset, settings, memory };
    let summary = write(arguments, &mut run)?;
    let player = run.player()?;
    let line = format!(
        "{}: {}, largest offset {:.1} % of the body",
        arguments.out.display(),
        player.describe(),
        100.0 * summary.largest
    );
    Ok(Outcome {
        json: json!({
            "out": arguments.out, "clip": player.motion.name(), "frames": player.frames, "fps": player.fps,
            "vertices": model.vertex_count(), "largest_offset": summary.largest,
            "mean_offset": summary.mean,
        }),
        lines: vec![line],
        ok: true,
    })
}

/// A character and a motion, to be played as often as is needed.
pub(super) struct Run<'a> {
    pub(super) model: &'a Model,
    asset: Asset<'a>,
    settings: Settings,
    memory: Vec<f32>,
}

impl Run<'_> {
    /// A player at the first frame.
    pub(super) fn player(&mut self) -> Result<Player<'_>, Error> {
        Player::new(self.model, self.asset, &mut self.memory, &self.settings)
    }
}

/// Offsets over a run, body sizes.
#[derive(Default)]
pub(super) struct Summary {
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

type Writer = fn(&Arguments, &mut Run<'_>) -> Result<Summary, Error>;

/// What the ending of the output asks for.
fn writer(out: &Path) -> Result<Writer, Error> {
    let ending = out.extension().unwrap_or_default().to_string_lossy().to_lowercase();
    Ok(match ending.as_str() {
        "npy" => array,
        "glb" => animation,
        "json" => figures,
        "replay" => replay,
        "png" => pictures::sheet,
        "gif" => pictures::gif,
        _ => {
            return Err(Error::unusable(
                out.display().to_string(),
                "--out",
                format!("the ending `.{ending}` is not known"),
                "choose .png, .gif, .glb, .npy, .replay or .json",
            ));
        }
    })
}

/// Calls `f` with every frame.
pub(super) fn every(
    what: &'static str,
    player: &mut Player<'_>,
    mut f: impl FnMut(&Frame) -> Result<(), Error>,
) -> Result<Summary, Error> {
    let (mut summary, frames) = (Summary::default(), player.frames);
    let bar = progress::bar(what, u64::from(frames));
    while let Some(frame) = player.next()? {
        summary.add(frame, frames);
        f(frame)?;
        bar.inc(1);
    }
    bar.finish_and_clear();
    Ok(summary)
}

fn shown(frame: &Frame, flesh: bool) -> (&[[f32; 3]], &[[f32; 3]]) {
    if flesh { (&frame.flesh, &frame.flesh_normals) } else { (&frame.skinned, &frame.skinned_normals) }
}

fn array(arguments: &Arguments, run: &mut Run<'_>) -> Result<Summary, Error> {
    let (out, flesh) = (arguments.out.as_path(), !arguments.no_flesh);
    let unwritten = |source| Error::Write { path: out.to_owned(), source };
    let vertices = run.model.vertex_count();
    let mut player = run.player()?;
    export::write_atomic(out, |file| {
        npy::header(file, player.frames, vertices)?;
        let write = |frame: &Frame| npy::frame(file, shown(frame, flesh).0).map_err(unwritten);
        every("play", &mut player, write).map_err(io::Error::other)
    })
}

fn animation(arguments: &Arguments, run: &mut Run<'_>) -> Result<Summary, Error> {
    let (model, mut player) = (run.model, run.player()?);
    let (kept, fps) = (morph::kept(player.frames as usize), player.fps);
    let mut frames = Vec::new();
    let summary = every("play", &mut player, |frame| {
        if kept.contains(&(frame.index as usize)) {
            let (positions, normals) = shown(frame, !arguments.no_flesh);
            #[allow(clippy::cast_precision_loss, reason = "frames")]
            let time = frame.index as f32 / fps;
            frames.push(MorphFrame { time, positions: positions.to_vec(), normals: normals.to_vec() });
        }
        Ok(())
    })?;
    export::write_bytes(&arguments.out, &morph::to_glb(model, player.motion.name(), &frames)?)?;
    Ok(summary)
}

fn replay(arguments: &Arguments, run: &mut Run<'_>) -> Result<Summary, Error> {
    let mut player = run.player()?;
    player.record()?;
    let summary = every("play", &mut player, |_| Ok(()))?;
    let (bytes, _) = player.recorded()?;
    export::write_bytes(&arguments.out, &bytes)?;
    Ok(summary)
}

fn figures(arguments: &Arguments, run: &mut Run<'_>) -> Result<Summary, Error> {
    let (model, mut player) = (run.model, run.player()?);
    let mut rows = Vec::new();
    let summary = every("play", &mut player, |frame| {
        let largest = frame.heat.iter().copied().fold(0.0, f32::max);
        rows.push(json!({"frame": frame.index, "time": frame.time, "largest_offset": largest}));
        Ok(())
    })?;
    let text = json!({
        "character": model.name, "clip": player.motion.name(), "fps": player.fps,
        "largest_offset": summary.largest, "mean_offset": summary.mean, "frames": rows,
    })
    .to_string();
    export::write_atomic(&arguments.out, |file| writeln!(file, "{text}"))?;
    Ok(summary)
}
