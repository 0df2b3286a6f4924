//! Sweeps the elementary functions over all 2³² inputs: `cargo run --release -p sinew-sweep -- --help`.

mod functions;
mod sweep;

use std::process::ExitCode;

use anyhow::{Result, bail};
use clap::Parser;
use indicatif::{ProgressBar, ProgressStyle};

use functions::{FUNCTIONS, Function};
use sweep::Swept;

/// Compares the elementary functions with the nearest `f32` to their real values.
#[derive(Debug, Parser)]
struct Arguments {
    /// Try every 2^STRIDE-th bit pattern and all special ones; 0 is every one.
    #[arg(long, default_value_t = 0)]
    stride: u32,
    /// Only functions with this in their name.
    #[arg(long, default_value = "")]
    function: String,
    /// One JSON object on standard output.
    #[arg(long)]
    json: bool,
    /// Print the inputs that are rounded wrongly in `f64`, as the lists in `core/src/math/hard.rs`.
    #[arg(long)]
    hard: bool,
}

fn main() -> ExitCode {
    match run(&Arguments::parse()) {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::FAILURE,
        Err(error) => {
            eprintln!("error: {error:#}");
            ExitCode::from(2)
        }
    }
}

/// Sweeps; false if a promise is broken.
#[allow(clippy::print_stdout, reason = "results")]
fn run(arguments: &Arguments) -> Result<bool> {
    if cfg!(debug_assertions) {
        bail!("an unoptimized sweep takes days: run it with --release");
    }
    let chosen: Vec<&Function> = FUNCTIONS.iter().filter(|f| f.name.contains(&arguments.function)).collect();
    if chosen.is_empty() {
        bail!("no function is called {:?}", arguments.function);
    }
    let mut results = Vec::new();
    for function in chosen {
        let swept = measure(function, arguments.stride)?;
        if !arguments.json {
            println!("{}", line(function, &swept));
        }
        if arguments.hard {
            print_hard(function, &swept);
        }
        results.push((function, swept));
    }
    if arguments.json {
        println!("{}", json(&results));
    }
    Ok(results.iter().all(|(_, swept)| swept.bodies.iter().all(|body| body.wrong == 0)))
}

/// One sweep under a progress bar.
fn measure(function: &Function, stride: u32) -> Result<Swept> {
    let bar = ProgressBar::new(1 << 32);
    if let Ok(style) = ProgressStyle::with_template("{msg:9} {wide_bar} {percent}% {eta}") {
        bar.set_style(style);
    }
    bar.set_message(function.name);
    let swept = sweep::sweep(function, stride, &bar);
    bar.finish_and_clear();
    let promised = sweep::promised(function, stride);
    if swept.inputs < promised {
        bail!("{}: {} inputs were tried, {promised} were promised", function.name, swept.inputs);
    }
    Ok(swept)
}

#[allow(clippy::cast_precision_loss, reason = "a mean for people")]
fn line(function: &Function, swept: &Swept) -> String {
    let mut text = format!("{:9} {:28} inputs {:10}", function.name, function.domain, swept.inputs);
    for (name, body) in ["f64", "f32 pairs"].iter().zip(&swept.bodies) {
        let (worst, at) = body.worst;
        let mean = body.sum / swept.inputs as f64;
        text += &format!(
            " | {name}: worst {worst:.9} ulp at {:e} mean {mean:.4} wrong {}",
            f32::from_bits(at),
            body.wrong
        );
    }
    text + &format!(" | by MPFR {} | {:.1} s", swept.undecided, swept.seconds)
}

#[allow(clippy::cast_precision_loss, reason = "a mean for people")]
fn json(results: &[(&Function, Swept)]) -> serde_json::Value {
    let functions = results.iter().map(|(function, swept)| {
        let worst = swept.bodies.iter().max_by(|a, b| a.worst.0.total_cmp(&b.worst.0)).expect("two bodies");
        serde_json::json!({
            "name": function.name,
            "domain": function.domain,
            "inputs": swept.inputs,
            "worst_ulp": worst.worst.0,
            "worst_at": format!("{:e}", f32::from_bits(worst.worst.1)),
            "mean_ulp": worst.sum / swept.inputs as f64,
            "not_correctly_rounded": swept.bodies.iter().map(|b| b.wrong).max(),
            "by_mpfr": swept.undecided,
            "seconds": swept.seconds,
        })
    });
    serde_json::json!({ "functions": functions.collect::<Vec<_>>() })
}

/// The list of a function for the source.
#[allow(clippy::print_stdout, reason = "results")]
fn print_hard(function: &Function, swept: &Swept) {
    let found = &swept.bodies[0].examples;
    println!("pub(crate) const {}: [(u32, u32); {}] = [", function.name.to_uppercase(), found.len());
    for (x, y) in found {
        let halves = |b: u32| format!("0x{:04x}_{:04x}", b >> 16, b & 0xffff);
        println!("    ({}, {}),", halves(*x), halves(*y));
    }
    println!("];");
}
