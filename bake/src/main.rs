//! The command line `sinew`: bake, play, verify, inspect, bench.

#![allow(clippy::print_stdout, reason = "a command line prints")]

mod cli;

use std::process::ExitCode;

fn main() -> ExitCode {
    cli::main()
}
