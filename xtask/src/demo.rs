//! `cargo xtask demo`: the built-in character, from bake to page.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use anyhow::{Context, Result, bail};

use crate::server::Running;
use crate::{npm, page, process, report, wasm, workspace};

const ASSET: &str = "out/mascot.sinew";
const REPORT: &str = "out/report";
const REPLAY: &str = "out/mascot.replay";
/// Contact sheet, moving picture, vertices; the replay is what the other targets repeat.
const PLAYED: [&str; 4] = ["out/mascot.png", "out/mascot.gif", "out/mascot.npy", REPLAY];

/// Bakes, plays and verifies natively; verifies under wasm; builds and serves the page.
/// `headless`: loads the page once in a browser instead of serving it to a person.
///
/// # Errors
///
/// If a step fails or leaves no output.
pub(crate) fn run(headless: bool, port: u16) -> Result<()> {
    npm::check_node()?; // before minutes of building
    let sinew = build_cli()?;
    native(&sinew)?;
    wasm::run()?;
    verify_in_wasm()?;
    page::bundle()?;
    summary();
    if headless {
        report::say(page::smoke()?.trim());
        return Ok(());
    }
    let server = Running::start(&page::dist(), port)?;
    report::say(format!("the page: {} (Ctrl-C ends)", server.url()));
    server.wait();
    Ok(())
}

/// `cargo xtask bench`: `sinew bench`, optimized; without arguments also `wasm/bench.mjs`.
///
/// # Errors
///
/// If it cannot be built, or fails.
pub(crate) fn bench(arguments: &[String]) -> Result<()> {
    let mut sinew = process::command(build_cli()?, &workspace::root());
    // Its progress and its tables are for the person who asked.
    let status = sinew.arg("bench").args(arguments).stdin(Stdio::inherit()).status()?;
    if !status.success() {
        bail!("`sinew bench`: {status}");
    }
    if !arguments.is_empty() {
        return Ok(());
    }
    wasm::build_bench()?;
    let mut node = process::command("node", &workspace::root().join("wasm"));
    let status = node.arg("bench.mjs").stdin(Stdio::inherit()).status()?;
    if !status.success() {
        bail!("`node bench.mjs`: {status}");
    }
    Ok(())
}

/// Builds the command line and returns where it lies.
fn build_cli() -> Result<PathBuf> {
    let mut cargo = process::cargo();
    process::run(
        "build sinew",
        cargo.args(["build", "--release", "--package", "sinew-bake", "--bin", "sinew"]),
    )?;
    Ok(workspace::target_dir().join("release").join(format!("sinew{}", std::env::consts::EXE_SUFFIX)))
}

/// Everything that runs on this machine's processor.
fn native(sinew: &Path) -> Result<()> {
    let out = workspace::root().join("out");
    fs::create_dir_all(&out).with_context(|| format!("cannot create {}", out.display()))?;
    let call = |name: &str, arguments: &[&str], made: &[&str]| {
        produce(name, process::command(sinew, &workspace::root()).args(arguments), made)
    };
    call(
        "bake the built-in character",
        &["bake", "builtin", "-o", ASSET, "--report", REPORT],
        &[ASSET, REPORT],
    )?;
    for played in PLAYED {
        call(&format!("play to {played}"), &["play", "builtin", "--asset", ASSET, "-o", played], &[played])?;
    }
    call("verify the replay natively", &["verify", REPLAY, "--asset", ASSET], &[])?;
    call("what it costs", &["bench"], &[])
}

/// The same replay, in the module that browsers load.
fn verify_in_wasm() -> Result<()> {
    let root = workspace::root();
    let mut node = npm::node("wasm", "verify.mjs");
    produce("verify the replay in wasm", node.arg(root.join(REPLAY)).arg(root.join(ASSET)), &[])
}

/// Runs a program, passes on what it says, and checks that it made what it should.
fn produce(name: &str, command: &mut Command, made: &[&str]) -> Result<()> {
    let paths: Vec<PathBuf> = made.iter().map(|path| workspace::root().join(path)).collect();
    for path in &paths {
        // What an earlier run left must not pass for a result.
        let remove: fn(_) -> _ = if path.is_dir() { fs::remove_dir_all } else { fs::remove_file };
        if path.exists() {
            remove(path).with_context(|| format!("cannot remove {}", path.display()))?;
        }
    }
    let text = process::run(name, command)?;
    if !text.trim().is_empty() {
        report::say(format!("{name}:\n{}", text.trim_end()));
    }
    match paths.iter().find(|path| size(path) == 0) {
        Some(absent) => {
            bail!("`{}` succeeded but left no {}", process::shown(command), workspace::shown(absent))
        }
        None => Ok(()),
    }
}

/// Lists what was made.
fn summary() {
    let mut rows = vec![vec!["made".to_owned(), "bytes".to_owned()]];
    for path in [ASSET, REPORT].iter().chain(&PLAYED) {
        rows.push(vec![(*path).to_owned(), size(&workspace::root().join(path)).to_string()]);
    }
    report::say(report::table(&rows, &[1]));
}

/// Bytes of a file, or of the files in a folder.
fn size(path: &Path) -> u64 {
    let in_folder = fs::read_dir(path).into_iter().flatten().flatten().filter_map(|e| e.metadata().ok());
    let folder: u64 = in_folder.map(|data| data.len()).sum();
    if path.is_dir() { folder } else { fs::metadata(path).map_or(0, |data| data.len()) }
}
