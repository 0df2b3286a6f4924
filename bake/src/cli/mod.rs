//! Arguments, exit codes and progress.

mod bake;
mod bench;
mod inspect;
mod load;
mod pictures;
mod play;
mod verify;

use clap::{Parser, Subcommand};
use indicatif::{ProgressBar, ProgressStyle};
use serde_json::Value;
use std::path::PathBuf;
use std::process::ExitCode;

/// Flesh for rigged characters: bellies, ears and tails that follow through.
#[derive(Debug, Parser)]
#[command(name = "sinew", version)]
struct Arguments {
    /// Print one JSON object on stdout and nothing else there
    #[arg(long, global = true)]
    json: bool,
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Make a runtime asset from a rigged character
    Bake(bake::Arguments),
    /// Run the runtime on a clip; the ending of OUT says what comes out
    Play(play::Arguments),
    /// Replay a recording and compare every frame, bit for bit
    Verify(verify::Arguments),
    /// Measure the runtime on this machine, with peers in the same run
    Bench {
        /// springs, skin or character-frame; all without it
        name: Option<String>,
    },
    /// Say what is in a .glb, .vrm, .sinew or .replay
    Inspect {
        /// The file
        file: PathBuf,
    },
}

/// What a command found: a value for `--json`, lines for people, and whether its check held.
struct Outcome {
    json: Value,
    lines: Vec<String>,
    ok: bool,
}

/// Runs the command of this process.
pub(super) fn main() -> ExitCode {
    let arguments = Arguments::parse();
    let outcome = match &arguments.command {
        Command::Bake(a) => bake::run(a),
        Command::Play(a) => play::run(a),
        Command::Verify(a) => verify::run(a),
        Command::Bench { name } => bench::run(name.as_deref()),
        Command::Inspect { file } => inspect::run(file),
    };
    match outcome {
        Ok(Outcome { json, lines, ok }) => {
            if arguments.json {
                println!("{json}");
            } else {
                lines.iter().for_each(|l| println!("{l}"));
            }
            if ok { ExitCode::SUCCESS } else { ExitCode::from(1) }
        }
        Err(error) => {
            eprintln!("sinew: {error}");
            ExitCode::from(2)
        }
    }
}

/// A progress bar on a terminal, nothing elsewhere.
fn progress(what: &str, length: u64) -> ProgressBar {
    let style = ProgressStyle::with_template("{msg:10} {wide_bar} {pos}/{len} {eta}");
    let bar = ProgressBar::new(length).with_message(what.to_owned());
    if let Ok(style) = style {
        bar.set_style(style);
    }
    bar
}

/// Bytes in a unit that people read.
fn kilobytes(n: usize) -> String {
    #[allow(clippy::cast_precision_loss, reason = "for people")]
    let k = n as f64 / 1000.0;
    if k < 1000.0 { format!("{k:.1} kB") } else { format!("{:.2} MB", k / 1000.0) }
}
