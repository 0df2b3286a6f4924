//! Sweeps the elementary functions over all 2³² inputs: `cargo run --release -p sinew-sweep -- --help`.

mod functions;
mod plane;
mod sweep;
mod table;

use std::path::PathBuf;
use std::process::ExitCode;

use anyhow::{Result, bail};
use clap::Parser;
use indicatif::{ProgressBar, ProgressStyle};

use functions::{FUNCTIONS, Function};
use sweep::Swept;
use table::Row;

/// Compares the elementary functions with the nearest `f32` to their real values.
#[derive(Debug, Parser)]
#[allow(clippy::struct_excessive_bools, reason = "flags of a command")]
struct Arguments {
    /// Try every 2^STRIDE-th bit pattern and all special ones; 0 is every one.
    #[arg(long, default_value_t = 0, value_parser = clap::value_parser!(u32).range(0..=20))]
    stride: u32,
    /// Only functions with this in their name; `plane` is that of Psi and Theta.
    #[arg(long, default_value = "")]
    function: String,
    /// One JSON object on standard output, nothing else there.
    #[arg(long)]
    json: bool,
    /// Write the table, with what it was measured on, to this Markdown file.
    #[arg(long)]
    table: Option<PathBuf>,
    /// Print the inputs that are rounded wrongly in `f64`, as the lists in `core/src/math/hard.rs`.
    #[arg(long)]
    hard: bool,
}

#[allow(clippy::print_stderr, reason = "the one place for errors")]
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
fn run(arguments: &Arguments) -> Result<bool> {
    if cfg!(debug_assertions) {
        bail!("an unoptimized sweep takes days: run it with --release");
    }
    let mut rows = Vec::new();
    for function in FUNCTIONS.iter().filter(|f| f.name.contains(&arguments.function)) {
        let swept = measure(function, arguments.stride)?;
        let row = Row::of_function(function, &swept);
        tell(arguments, &row.to_string());
        if arguments.hard {
            tell(arguments, &table::hard(function, &swept));
        }
        rows.push(row);
    }
    if "plane".contains(&arguments.function) {
        let bar = progress("plane");
        let swept = plane::sweep(1 << arguments.stride.clamp(6, 12), &bar)?;
        bar.finish_and_clear();
        for row in Row::of_plane(&swept) {
            tell(arguments, &row.to_string());
            rows.push(row);
        }
    }
    if rows.is_empty() {
        bail!("no function is called {:?}", arguments.function);
    }
    if let Some(path) = &arguments.table {
        table::write(path, &rows, arguments.stride)?;
    }
    if arguments.json {
        print(&table::json(&rows));
    }
    Ok(rows.iter().all(Row::holds))
}

/// Prints for people.
fn tell(arguments: &Arguments, text: &str) {
    if !arguments.json {
        print(text);
    }
}

#[allow(clippy::print_stdout, reason = "results")]
fn print(text: &str) {
    println!("{text}");
}

/// One sweep under a progress bar.
fn measure(function: &Function, stride: u32) -> Result<Swept> {
    let bar = progress(function.name);
    let swept = sweep::sweep(function, stride, &bar);
    bar.finish_and_clear();
    let promised = sweep::promised(function, stride);
    if swept.inputs < promised {
        bail!("{}: {} inputs were tried, {promised} were promised", function.name, swept.inputs);
    }
    Ok(swept)
}

/// A bar over all bit patterns.
fn progress(name: &'static str) -> ProgressBar {
    let bar = ProgressBar::new(1 << 32);
    if let Ok(style) = ProgressStyle::with_template("{msg:9} {wide_bar} {percent}% {eta}") {
        bar.set_style(style);
    }
    bar.with_message(name)
}
