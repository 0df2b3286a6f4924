//! `sinew simulate`.

use super::{Outcome, load, progress};
use glam::DVec3;
use serde_json::{Value, json};
use sinew_bake::cage::{Options, Resolution, Shape};
use sinew_bake::dataset::{Reader, Shard, Writer};
use sinew_bake::film::{Film, Look, Survey};
use sinew_bake::play::Frame;
use sinew_bake::render::{gif_stride, write_png};
use sinew_bake::simulate::job::{Job, Made, Work};
use sinew_bake::simulate::source::Source;
use sinew_bake::simulate::{Settings, preview};
use sinew_bake::{Error, Model, export};
use std::path::{Path, PathBuf};
use std::thread;

#[derive(Debug, clap::Args)]
pub(super) struct Arguments {
    /// A rigged .glb, .gltf or .vrm; `builtin` is the character that comes with sinew
    input: PathBuf,
    /// The dataset; one that was begun is gone on with
    #[arg(short, long)]
    out: PathBuf,
    /// Number of poses in equilibrium
    #[arg(long, default_value_t = 100, conflicts_with = "motion", value_parser = clap::value_parser!(u32).range(1..=1_000_000))]
    samples: u32,
    /// Flesh in motion instead: each clip in pieces of --frames
    #[arg(long)]
    motion: bool,
    /// Frames of a piece of motion
    #[arg(long, default_value_t = 100)]
    frames: usize,
    /// Recordings (.bvh) of people to take poses from, besides the clips of the file
    #[arg(long, num_args = 1..)]
    bvh: Vec<PathBuf>,
    /// Poses a second that are taken from motions; 10 for equilibria, 60 for motion
    #[arg(long)]
    rate: Option<f64>,
    /// Steps of simulation from frame to frame
    #[arg(long, default_value_t = 2)]
    substeps: u32,
    /// Seed of what is random
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Make share i of n alone, into a file with its number in its name
    #[arg(long, value_name = "I/N", default_value = "0/1")]
    shard: Shard,
    /// Most nodes of the cage
    #[arg(long, default_value_t = 2000)]
    vertices: usize,
    /// Fit the cage to the skin instead of filling cubes
    #[arg(long)]
    fit: bool,
    /// Young's modulus, Pa, of a character 1.5 m large
    #[arg(long, default_value_t = 15_000.0)]
    young: f64,
    /// Poisson's ratio
    #[arg(long, default_value_t = 0.45)]
    ratio: f64,
    /// Downward acceleration, m/s²
    #[arg(long, default_value_t = 0.0, allow_hyphen_values = true)]
    gravity: f64,
    /// Leave deformation gradients out
    #[arg(long)]
    no_gradients: bool,
    /// Threads; as many as there are processors without it
    #[arg(long)]
    threads: Option<usize>,
    /// Write a GIF of the samples here, and a contact sheet (.png) beside it
    #[arg(long, value_name = "GIF")]
    preview: Option<PathBuf>,
}

pub(super) fn run(arguments: &Arguments) -> Result<Outcome, Error> {
    let model = load::character(&arguments.input)?;
    let job = Job::new(&model, settings(arguments), work(arguments, &model)?, !arguments.no_gradients)?;
    let header = job.header(arguments.seed, arguments.shard, &source(arguments))?;
    let path = shard_path(&arguments.out, arguments.shard);
    let mut writer = Writer::open(&path, &header)?;
    let resumed = writer.resumed();
    let all = arguments.shard.indices(header.samples).count();
    let bar = progress::bar("simulate", all as u64);
    bar.inc(resumed.kept as u64);
    let threads = arguments.threads.unwrap_or_else(|| thread::available_parallelism().map_or(1, usize::from));
    let made = job.run(&mut writer, &header, threads, |_| bar.inc(1))?;
    bar.finish_and_clear();
    drop(writer);
    if let Some(gif) = &arguments.preview {
        show(&job, &path, gif)?;
    }
    Ok(outcome(&job, &path, resumed.kept, made))
}

fn settings(arguments: &Arguments) -> Settings {
    let shape = if arguments.fit { Shape::Fitted } else { Shape::Cubes };
    Settings {
        cage: Options { shape, resolution: Resolution::Vertices(arguments.vertices), ..Options::default() },
        young: arguments.young,
        ratio: arguments.ratio,
        gravity: DVec3::new(0.0, -arguments.gravity, 0.0),
        ..Settings::default()
    }
}

fn work(arguments: &Arguments, model: &Model) -> Result<Work, Error> {
    let rate = arguments.rate.unwrap_or(if arguments.motion { 60.0 } else { 10.0 });
    let mut source = Source::clips(model, rate)?;
    for path in &arguments.bvh {
        source.add_bvh(model, path, rate)?;
    }
    if arguments.motion {
        source.sequences(model, arguments.frames, rate, arguments.substeps)
    } else {
        source.equilibria(model, arguments.samples as usize, arguments.seed)
    }
}

fn source(arguments: &Arguments) -> Value {
    let digests: Vec<String> = arguments.bvh.iter().map(|p| format!("{:016x}", load::source(p))).collect();
    json!({ "rate": arguments.rate, "frames": arguments.frames, "bvh": digests })
}

/// `fox.set` of shard 2/8 is `fox.2-of-8.set`.
fn shard_path(out: &Path, shard: Shard) -> PathBuf {
    if shard == Shard::WHOLE {
        return out.to_owned();
    }
    let part = shard.to_string().replace('/', "-of-");
    let ending = out.extension().map(|e| format!(".{}", e.to_string_lossy())).unwrap_or_default();
    let stem = out.file_stem().unwrap_or_default().to_string_lossy();
    out.with_file_name(format!("{stem}.{part}{ending}"))
}

/// Columns of the contact sheet.
const COLUMNS: usize = 6;
/// Height of pictures, pixels.
const HEIGHT: u32 = 300;
/// Most frames of the GIF.
const MOST_FRAMES: usize = 240;
/// Poses in equilibrium a second in the GIF.
const POSES: f32 = 2.0;
/// Most frames a second of motion in the GIF.
const FPS: f32 = 30.0;

/// Writes the GIF and the contact sheet of what is in a file.
fn show(job: &Job<'_>, path: &Path, gif: &Path) -> Result<(), Error> {
    let (mut reader, flesh) = (Reader::open(&[path])?, job.flesh()?);
    let (rate, stride) = match &job.work {
        Work::Equilibria(_) => (POSES, 1),
        #[allow(clippy::cast_possible_truncation, reason = "frames a second")]
        Work::Motions { rate, .. } => (*rate as f32, gif_stride(*rate as f32, FPS)),
    };
    let (mut frames, mut captions) = (Vec::new(), Vec::new());
    let indices: Vec<u64> = reader.indices().collect();
    for index in indices {
        let first = u32::try_from(frames.len()).unwrap_or(u32::MAX);
        let of = preview::frames(job, &flesh, &reader.sample(index)?, first);
        captions.extend(of.iter().map(|f| match &job.work {
            Work::Equilibria(_) => format!("sample {index}"),
            Work::Motions { .. } => format!("sample {index}, {:.2} s", f.time),
        }));
        frames.extend(of);
        if frames.len() >= MOST_FRAMES * stride as usize {
            break;
        }
    }
    let count = frames.len();
    let wanted = (0..COLUMNS.min(count)).filter_map(|k| u32::try_from(k * count / COLUMNS.min(count)).ok());
    let mut survey = Survey::of(job.model, wanted.collect());
    frames.iter().for_each(|f| survey.add(job.model, f));
    frames.retain(|f| f.index % stride == 0);
    let film = Film::new(job.model, survey, HEIGHT);
    let looks = [("skinning", Look::Skinning), ("simulated", Look::Flesh), ("distance", Look::Heat)];
    let bar = progress::bar("draw", (frames.len() + looks.len()) as u64);
    #[allow(clippy::cast_precision_loss, reason = "a small number")]
    let fps = rate / stride as f32;
    export::write_atomic(gif, |out| film.gif_of(out, &frames, fps, &looks[..2], || bar.inc(1)).map(drop))?;
    let caption = |f: &Frame| captions[f.index as usize].clone();
    let page =
        film.sheet_of(&format!("{count} frames of {}", path.display()), &looks, caption, || bar.inc(1));
    bar.finish_and_clear();
    write_png(&gif.with_extension("png"), &page)
}

fn outcome(job: &Job<'_>, path: &Path, kept: usize, made: Made) -> Outcome {
    let Made { samples, failed } = made;
    let mut lines = vec![format!("{}: {samples} samples made, {kept} were there", path.display())];
    if failed > 0 {
        lines.push(format!("note: {failed} did not come to an end; their status is 0"));
    }
    Outcome {
        json: json!({
            "out": path, "made": samples, "kept": kept, "failed": failed, "samples": job.work.len(),
            "nodes": job.body.cage.rest.len(), "tets": job.body.cage.tets.len(),
        }),
        lines,
        ok: true,
    }
}
