//! `sinew bench`: speed, as the least time of many rounds, with a plain loop as the peer in the same run.

mod character;
mod fem;
mod mlp;
mod springs;

use super::{Outcome, load};
use serde_json::{Value, json};
use sinew_bake::Error;
use std::path::Path;
use std::time::Instant;

/// Rounds; the best counts, because machines are shared.
const ROUNDS: u32 = 60;
/// Names that can be asked for.
const NAMES: [&str; 11] = [
    "springs",
    "skin",
    "character-frame",
    "batch",
    "mlp-small",
    "mlp-int8",
    "fem-quasistatic",
    "fem-dynamic",
    "fem-assembly",
    "fem-linear",
    "fem-prisms",
];

pub(super) fn run(name: Option<&str>, input: Option<&Path>) -> Result<Outcome, Error> {
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
        results.push(springs::springs());
    }
    if wanted("skin") || wanted("character-frame") {
        results.extend(character::character(&wanted)?);
    }
    if wanted("batch") {
        results.extend(character::batches()?);
    }
    if wanted("mlp-small") {
        results.push(mlp::small());
    }
    if wanted("mlp-int8") {
        results.push(mlp::large());
    }
    if NAMES[6..10].iter().any(|n| wanted(n)) {
        let model = load::character(input.unwrap_or_else(|| Path::new("builtin")))?;
        results.extend(fem::character(&model, &wanted)?);
    }
    if wanted("fem-prisms") {
        results.push(fem::prisms(input)?);
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
