//! Sweeps of the elementary functions: a part in every test, all of it by `cargo xtask exhaustive`.

use std::path::Path;
use std::process::Command;

use anyhow::{Context, Result};

use crate::{apt, process, report, workspace};

/// The committed table.
const TABLE: &str = "docs/accuracy.md";

/// Tries every input of every function and writes the table; false if a promise is broken.
///
/// # Errors
///
/// If the sweep cannot be built or run.
pub(crate) fn run(json: bool, function: &str) -> Result<bool> {
    ready()?;
    let mut sweep = sweep();
    sweep.args(["--function", function]);
    if json {
        sweep.arg("--json");
    }
    if function.is_empty() {
        sweep.args(["--table", TABLE]);
    }
    if function.is_empty() {
        process::run("every input of the quantiser", &mut quantiser())?;
    }
    // Its own bars and lines: it takes an hour.
    let status = sweep.status().with_context(|| format!("cannot start {}", process::shown(&sweep)))?;
    if function.is_empty() && status.success() {
        report::note(format!("   wrote {TABLE}"));
    }
    Ok(status.success())
}

/// The runtime's own exhaustive tests, which skip most inputs in a debug build.
fn quantiser() -> Command {
    let mut cargo = process::cargo();
    cargo.args(["test", "--release", "--package", "sinew", "--features", "std", "--lib", "exhaustive"]);
    cargo
}

/// The part for every test: every 2¹⁰-th input and all special ones.
pub(crate) fn strided() -> Command {
    let mut sweep = sweep();
    sweep.args(["--stride", "10"]);
    sweep
}

fn sweep() -> Command {
    let mut cargo = process::cargo();
    cargo.args(["run", "--quiet", "--release", "--package", "sinew-sweep", "--"]);
    cargo
}

/// MPFR is built from source, with a macro processor that is not everywhere.
///
/// # Errors
///
/// With what to install.
pub(crate) fn ready() -> Result<String> {
    let present = || process::output(process::command("m4", Path::new("/")).arg("--version")).is_some();
    if !present() {
        apt::install(&["m4"]).context("MPFR, the judge of accuracy, needs `m4` to build")?;
    }
    Ok(format!("m4 for MPFR, sources from the registry, in {}", workspace::target_dir().display()))
}
