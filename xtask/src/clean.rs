//! `cargo xtask clean`: removes what chores made. Installed programs stay.

use std::fs;

use anyhow::{Context, Result};

use crate::{process, report, workspace};

/// Everything made in the checkout that is not in the repository.
const MADE: [&str; 9] = [
    "wasm/pkg",
    "wasm/pkg-bench",
    "wasm/pkg.new",
    "wasm/node_modules",
    "www/baked",
    "www/dist",
    "www/artifacts",
    "www/node_modules",
    "out",
];

/// Removes build products, npm packages and outputs.
///
/// # Errors
///
/// If a folder cannot be removed.
pub(crate) fn run() -> Result<()> {
    for dir in MADE.iter().map(|name| workspace::root().join(name)).filter(|dir| dir.exists()) {
        report::note(format!("removing {}", workspace::shown(&dir)));
        fs::remove_dir_all(&dir).with_context(|| format!("cannot remove {}", dir.display()))?;
    }
    report::note(format!("cleaning {}", workspace::shown(&workspace::target_dir())));
    process::run("cargo clean", process::cargo().arg("clean"))?;
    Ok(())
}
