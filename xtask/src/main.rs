//! Set-up and chores: `cargo xtask --help`.

mod apt;
mod browser;
mod cache;
mod clean;
mod count;
mod demo;
mod exhaustive;
mod fuzz;
mod mcu;
mod nightly;
mod npm;
mod page;
mod process;
mod report;
mod server;
mod setup;
mod sizes;
mod targets;
mod test;
mod toolchain;
mod wasm;
mod workspace;

use std::process::ExitCode;

use anyhow::Result;
use clap::{Parser, Subcommand};

/// Set-up and chores of the workspace.
#[derive(Debug, Parser)]
#[command(name = "cargo xtask", bin_name = "cargo xtask")]
struct Arguments {
    #[command(subcommand)]
    chore: Chore,
}

#[derive(Debug, Subcommand)]
enum Chore {
    /// Install what a fresh machine lacks, or say how; the other chores do it as they need it.
    Setup,
    /// Bake and play the built-in character, natively and in wasm, and show the page.
    Demo {
        /// Load the page once in headless Chromium instead of serving it.
        #[arg(long)]
        headless: bool,
        /// Port of the page on 127.0.0.1; 0 takes a free one.
        #[arg(long, default_value_t = 8080)]
        port: u16,
    },
    /// Run every check and test.
    Test {
        /// Only checks with this in their name.
        #[arg(long, default_value = "")]
        filter: String,
    },
    /// Run one program on every target there is to be had, emulated ones too, and compare the bits.
    Targets {
        /// One JSON object on standard output, nothing else there.
        #[arg(long)]
        json: bool,
        /// Only targets with this in their name, beside the first.
        #[arg(long, default_value = "")]
        filter: String,
    },
    /// Try all 2³² inputs of every elementary function and write `docs/accuracy.md`; takes an hour.
    Exhaustive {
        /// One JSON object on standard output, nothing else there.
        #[arg(long)]
        json: bool,
        /// Only functions with this in their name; the table is left alone.
        #[arg(long, default_value = "")]
        function: String,
    },
    /// Run the firmware on emulated microcontrollers, compare the bits, and count bytes and instructions.
    Mcu {
        /// One JSON object on standard output, nothing else there.
        #[arg(long)]
        json: bool,
    },
    /// Build the npm package into `wasm/pkg` and check its size.
    Wasm,
    /// Build the page and serve it.
    Serve {
        /// Port on 127.0.0.1; 0 takes a free one.
        #[arg(long, default_value_t = 8080)]
        port: u16,
    },
    /// Measure, natively and under wasm.
    Bench {
        /// Passed on to `sinew bench`; without any, wasm is measured too.
        #[arg(trailing_var_arg = true, allow_hyphen_values = true)]
        arguments: Vec<String>,
    },
    /// Look for inputs that break a promise, by libFuzzer where it can be had.
    Fuzz {
        /// Time for each target, s.
        #[arg(long, default_value_t = 60)]
        seconds: u64,
        /// Write the seeds that the search begins with anew, and search nothing.
        #[arg(long)]
        seeds: bool,
        /// One target instead of all.
        target: Option<String>,
    },
    /// Remove what chores made.
    Clean,
}

fn main() -> ExitCode {
    match run(Arguments::parse().chore) {
        Ok(true) => ExitCode::SUCCESS,
        // Told already, as a table.
        Ok(false) => ExitCode::FAILURE,
        Err(error) => {
            report::note(format!("error: {error:#}"));
            ExitCode::FAILURE
        }
    }
}

/// Carries out a chore; false if checks failed.
fn run(chore: Chore) -> Result<bool> {
    let result = match chore {
        Chore::Test { filter } => return test::run(&filter),
        Chore::Exhaustive { json, function } => return exhaustive::run(json, &function),
        Chore::Targets { json, filter } => return targets::run(json, &filter).map(|(_, failed)| failed == 0),
        Chore::Mcu { json } => return mcu::run(json),
        Chore::Setup => setup::run(),
        Chore::Demo { headless, port } => demo::run(headless, port),
        Chore::Wasm => wasm::run(),
        Chore::Serve { port } => page::serve(port),
        Chore::Bench { arguments } => demo::bench(&arguments),
        Chore::Fuzz { seeds: true, .. } => fuzz::seeds(),
        Chore::Fuzz { seconds, target, .. } => fuzz::run(seconds, target.as_deref()),
        Chore::Clean => clean::run(),
    };
    result.map(|()| true)
}
