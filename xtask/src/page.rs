//! The demo page: built with Vite, served, tried in a browser.

use std::path::PathBuf;
use std::process::Command;

use anyhow::Result;

use crate::server::Running;
use crate::{browser, npm, process, report, wasm, workspace};

/// Where Vite leaves the page.
#[must_use]
pub(crate) fn dist() -> PathBuf {
    workspace::root().join("www/dist")
}

/// Builds the npm package and the page around it.
///
/// # Errors
///
/// If either build fails.
pub(crate) fn build() -> Result<()> {
    wasm::build()?;
    bundle().map(|_| ())
}

/// Bundles the page around the npm package as it is; returns what Vite said.
///
/// # Errors
///
/// If Vite fails or is not to be had.
pub(crate) fn bundle() -> Result<String> {
    npm::ready("www")?;
    process::run("bundle the page", npm::npm(&workspace::root().join("www")).args(["run", "build"]))
}

/// Loads the page once in a browser.
///
/// # Errors
///
/// If it is not ready without an error, or there is no page or no browser.
pub(crate) fn smoke() -> Result<String> {
    let (server, mut command) = in_browser(npm::node("www", "smoke.mjs"))?;
    process::run("load the page in Chromium", command.arg(server.url()))
}

/// The page's own test, ready to run; the server lasts as long as it is kept.
///
/// # Errors
///
/// If there is no page or no browser.
pub(crate) fn test_command() -> Result<(Running, Command)> {
    let mut npm = npm::npm(&workspace::root().join("www"));
    npm.arg("test");
    in_browser(npm)
}

/// Serves the built page on a free port for a program that opens a browser.
fn in_browser(mut program: Command) -> Result<(Running, Command)> {
    npm::ready("www")?;
    let chromium = browser::ready()?;
    let server = Running::start(&dist(), 0)?;
    program.env("SINEW_URL", server.url()).env("CHROMIUM", chromium);
    Ok((server, program))
}

/// `cargo xtask serve`: builds the page and serves it until stopped.
///
/// # Errors
///
/// If a build fails or the port is taken.
pub(crate) fn serve(port: u16) -> Result<()> {
    build()?;
    let server = Running::start(&dist(), port)?;
    report::say(format!("{} (Ctrl-C ends)", server.url()));
    server.wait();
    Ok(())
}
