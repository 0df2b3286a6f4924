//! Arguments, exit codes and progress.

mod bake;
mod bench;
mod cage;
mod inspect;
mod load;
mod pictures;
mod play;
mod progress;
mod simulate;
mod verify;

use clap::{Parser, Subcommand};
use serde_json::{Value, json};
use sinew_bake::Error;
use std::io::{self, Write};
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
        /// Name of a benchmark, such as springs or fem-prisms; all without it
        name: Option<String>,
        /// A character for those of finite elements; the built-in one without it
        #[arg(long)]
        input: Option<PathBuf>,
    },
    /// Put tetrahedra around a character for simulation
    Cage(cage::Arguments),
    /// Make a dataset of a character's flesh in equilibrium or in motion
    Simulate(simulate::Arguments),
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
        Command::Bench { name, input } => bench::run(name.as_deref(), input.as_deref()),
        Command::Cage(a) => cage::run(a),
        Command::Simulate(a) => simulate::run(a),
        Command::Inspect { file } => inspect::run(file),
    };
    let (json, lines, code) = match outcome {
        Ok(Outcome { json, lines, ok }) => (json, lines, u8::from(!ok)),
        Err(error) => {
            let reason = one_line(&error);
            eprintln!("sinew: {reason}");
            (json!({ "error": reason, "code": error.code() }), Vec::new(), 2)
        }
    };
    let text = if arguments.json { vec![json.to_string()] } else { lines };
    match print(&text) {
        // A reader that has seen enough (`| head`) is no failure.
        Err(error) if error.kind() != io::ErrorKind::BrokenPipe => {
            eprintln!("sinew: standard output: cannot be written: {error}");
            ExitCode::from(2)
        }
        _ => ExitCode::from(code),
    }
}

fn print(lines: &[String]) -> io::Result<()> {
    let mut out = io::stdout().lock();
    lines.iter().try_for_each(|line| writeln!(out, "{line}"))?;
    out.flush()
}

/// An error in one line: what parsers say may have several, and names in files anything.
fn one_line(error: &Error) -> String {
    let text = error.to_string();
    let words: Vec<&str> =
        text.split(|c: char| c.is_control() || c == ' ').filter(|w| !w.is_empty()).collect();
    words.join(" ")
}

/// Bytes in a unit that people read.
fn kilobytes(n: usize) -> String {
    #[allow(clippy::cast_precision_loss, reason = "for people")]
    let k = n as f64 / 1000.0;
    if k < 1000.0 { format!("{k:.1} kB") } else { format!("{:.2} MB", k / 1000.0) }
}
