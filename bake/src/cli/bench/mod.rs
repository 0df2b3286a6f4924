//! `sinew bench`: speed, as the least time of many rounds, with a plain loop as the peer in the same run.

use super::{Outcome, load};
use core::hint::black_box;
use serde_json::{Value, json};
use sinew::kernel::spring::{Knots, Spring, Step, advance};
use sinew::{Character, Pose, Root, step_batch};
use sinew_bake::Error;
use std::path::Path;
use std::time::Instant;

/// Rounds; the best counts, because machines are shared.
const ROUNDS: u32 = 60;
/// Points of the spring benchmark.
const POINTS: usize = 10_000;
/// Names that can be asked for.
const NAMES: [&str; 4] = ["springs", "skin", "character-frame", "batch"];
/// Sizes of the batches.
const CROWDS: [usize; 3] = [1, 16, 128];

pub(super) fn run(name: Option<&str>) -> Result<Outcome, Error> {
    if let Some(name) = name.filter(|n| !NAMES.contains(n)) {
        let problem = format!("there is no benchmark `{name}`");
        return Err(Error::unusable(
            "bench",
            "NAME",
            problem,
            format!("choose one of: {}", NAMES.join(", ")),
        ));
    }
    let wanted = |n: &str| name.is_none_or(|name| name == n);
    let mut results = Vec::new();
    if wanted("springs") {
        results.push(springs());
    }
    if wanted("skin") || wanted("character-frame") {
        results.extend(character(&wanted)?);
    }
    if wanted("batch") {
        results.extend(batches()?);
    }
    let lines = results.iter().map(line).collect();
    let json = json!({"machine": machine(), "results": results});
    Ok(Outcome { json, lines, ok: true })
}

fn machine() -> String {
    let cores = std::thread::available_parallelism().map_or(1, core::num::NonZero::get);
    format!("{} {}, {cores} cores", std::env::consts::ARCH, std::env::consts::OS)
}

fn line(result: &Value) -> String {
    let peers = result["peers"].as_array().into_iter().flatten();
    let peers: String =
        peers.map(|p| format!(", {} {:.2}", p["name"].as_str().unwrap_or(""), number(&p["value"]))).collect();
    let text = |k: &str| result[k].as_str().unwrap_or("").to_owned();
    let value = number(&result["value"]);
    format!("{:16} {:15} {value:.2} {}{peers}", text("name"), text("case"), text("unit"))
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or(f64::NAN)
}

/// Least time of a round, divided by `items`, in ns.
fn best(items: usize, mut round: impl FnMut()) -> f64 {
    let mut least = f64::INFINITY;
    for _ in 0..ROUNDS {
        let start = Instant::now();
        round();
        least = least.min(start.elapsed().as_secs_f64());
    }
    #[allow(clippy::cast_precision_loss, reason = "counts")]
    let items = items as f64;
    1e9 * least / items
}

/// The spring stage against the same arithmetic in a plain loop over points.
fn springs() -> Value {
    let (n, dt) = (3 * POINTS, 1.0 / 60.0);
    let step = Step::new(Spring::new(2.5, 0.3), dt, 1e-7);
    #[allow(clippy::cast_precision_loss, reason = "small numbers")]
    let wave: Vec<f32> = (0..n).map(|i| (i % 97) as f32 * 0.01).collect();
    let f = vec![-9.0_f32; n];
    let mut state = [const { Vec::new() }; 5].map(|_: Vec<f32>| vec![0.0; n]);
    let ours = best(POINTS, || {
        let [x, y, v, slope, f0] = &mut state;
        advance(&step, black_box(&wave), black_box(&f), Knots { x, y, v, slope, f: f0 });
    });
    let mut state = vec![[0.0_f32; 5]; n];
    let weights = black_box([0.9_f32, 0.015, 0.4, 1e-4, 1e-4, -3.0, 0.8, 0.2, 0.01, 0.01]);
    let plain = best(POINTS, || {
        for (i, s) in state.iter_mut().enumerate() {
            let d = wave[i] - s[0];
            let (e, u) = (d - s[3] * dt, s[2] - s[3]);
            let y =
                weights[0] * s[1] + weights[1] * u + weights[2] * e + weights[3] * s[4] + weights[4] * f[i];
            let w =
                weights[5] * s[1] + weights[6] * u + weights[7] * e + weights[8] * s[4] + weights[9] * f[i];
            *s = [wave[i], y, w + d / dt, d / dt, f[i]];
        }
        black_box(&mut state);
    });
    json!({"name": "springs", "case": "10k points", "value": ours, "unit": "ns/vertex",
        "peers": [{"name": "plain loop", "value": plain}], "limit": 4.0})
}

/// CPU skinning with normals, and a whole frame, of the built-in character.
fn character(wanted: &impl Fn(&str) -> bool) -> Result<Vec<Value>, Error> {
    let path = Path::new("builtin");
    let model = load::character(path)?;
    let aligned = load::asset(&model, None)?;
    let asset = load::parse(path, &aligned)?;
    let mut memory = vec![0.0; Character::required_len(&asset)];
    let refuse = |e: String| Error::unusable("bench", "character", e, "please report this");
    let mut character = Character::new(asset, &mut memory).map_err(|e| refuse(e.to_string()))?;
    let mut out = Vec::new();
    let mut frame = 0.0_f32;
    let mut failed = None;
    let whole = best(1, || {
        frame += 1.0;
        let stepped = character.step_clip(0, frame / 60.0 % 1.0, Root::default(), 1.0 / 60.0);
        failed = stepped.err().or(failed);
    });
    if let Some(error) = failed {
        return Err(refuse(error.to_string()));
    }
    let vertices = asset.meta.vertices as usize;
    let (mut positions, mut normals) = (vec![[0.0; 3]; vertices], vec![[0.0; 3]; vertices]);
    if wanted("skin") {
        let value = best(vertices, || character.skin_surface(true, &mut positions, &mut normals));
        out.push(json!({"name": "skin", "case": "builtin", "value": value, "unit": "ns/vertex",
            "peers": [], "limit": 4.0}));
    }
    if wanted("character-frame") {
        out.push(json!({"name": "character-frame", "case": "builtin", "value": 1e-6 * whole, "unit": "ms",
            "peers": [], "limit": 0.25}));
    }
    Ok(out)
}

/// Batches of the built-in character: what a vertex costs must not depend on how many there are.
fn batches() -> Result<Vec<Value>, Error> {
    let path = Path::new("builtin");
    let model = load::character(path)?;
    let aligned = load::asset(&model, None)?;
    CROWDS.iter().map(|count| batch(path, &aligned, *count)).collect()
}

fn batch(path: &Path, aligned: &[u32], count: usize) -> Result<Value, Error> {
    let refuse = |e: String| Error::unusable("bench", "batch", e, "please report this");
    let asset = load::parse(path, aligned)?;
    let vertices = count * asset.meta.vertices as usize;
    let mut memories = vec![vec![0.0; Character::required_len(&asset)]; count];
    let crowd = memories
        .iter_mut()
        .map(|m| Character::new(load::parse(path, aligned)?, m).map_err(|e| refuse(e.to_string())));
    let mut crowd = crowd.collect::<Result<Vec<_>, Error>>()?;
    let mut bones = vec![sinew::math::affine::IDENTITY; asset.joint_from_bind.len()];
    let mut failed = None;
    let value = best(vertices, || {
        bones.iter_mut().for_each(|b| b[3][0] = 0.01 - b[3][0]);
        let poses = vec![Pose { root: Root::default(), root_from_joint: &bones }; count];
        let stepped = step_batch(&mut crowd, &poses, 1.0 / 60.0);
        failed = stepped.map_or_else(|e| Some(e.to_string()), |b| b.refusal.map(|(_, e)| e.to_string()));
    });
    if let Some(error) = failed {
        return Err(refuse(error));
    }
    Ok(json!({"name": "batch", "case": format!("{count} characters"), "value": value, "unit": "ns/vertex",
        "peers": []}))
}
