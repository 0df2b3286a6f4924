//! A firmware on an emulated board, its instructions counted.

use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail};

use super::image::Image;
use super::trace::{self, Span};
use crate::report::Step;
use crate::toolchain::Toolchain;
use crate::{apt, process, workspace};

const QEMU: &str = "/usr/bin/qemu-system-arm";
const PLUGIN: &str = include_str!("count.c");

/// Where the firmware's files go.
fn folder() -> PathBuf {
    workspace::target_dir().join("targets/mcu")
}

/// Installs the emulator where it is missing, and makes the plugin.
///
/// # Errors
///
/// With what to install.
pub(crate) fn ready() -> Result<PathBuf> {
    if !Path::new(QEMU).exists() {
        apt::install(&["qemu-system-arm"]).context("the microcontroller is emulated by `qemu-system-arm`")?;
    }
    let version = process::output(process::command(QEMU, &workspace::root()).arg("--version"));
    let (source, plugin) = (folder().join("count.c"), folder().join("libcount.so"));
    fs::create_dir_all(folder())?;
    fs::write(&source, PLUGIN)?;
    let mut cc = process::command("cc", &workspace::root());
    cc.args([
        "-O2",
        "-shared",
        "-fPIC",
        &format!("-DAPI={}", plugin_api(&version.unwrap_or_default())),
        "-o",
    ]);
    process::run("plugin that counts instructions", cc.arg(&plugin).arg(&source))
        .context("a C compiler makes the plugin that counts instructions: install `gcc`")?;
    Ok(plugin)
}

/// The version of plugins that an emulator takes.
fn plugin_api(version: &str) -> u32 {
    let major = version.rsplit("version ").next().and_then(|v| v.split('.').next()?.parse().ok());
    if major.unwrap_or(0_u32) >= 9 { 2 } else { 1 }
}

/// Builds both firmwares; their files.
///
/// # Errors
///
/// If there is no compiler for the target, or they do not build.
pub(crate) fn build(triple: &str) -> Result<[PathBuf; 2]> {
    let mut cargo = Toolchain::for_target(triple)?.cargo("build", triple);
    cargo.args(["--profile", "mcu", "--package", "sinew-mcu", "--bins", "--target-dir"]).arg(folder());
    process::run(&format!("firmware for {triple}"), &mut cargo)?;
    Ok(["sinew-mcu", "figures"].map(|name| folder().join(triple).join("mcu").join(name)))
}

/// Runs a firmware on a board.
///
/// # Errors
///
/// If it fails, or prints what it should not.
pub(crate) fn run(board: &str, plugin: &Path, file: &Path, image: &Image) -> Result<Vec<Span>> {
    let mut options = plugin.as_os_str().to_owned();
    for (option, function) in [(",mark=", "sinew_mcu::mark"), (",list=", "sinew_mcu::detail")] {
        // A firmware that never calls one has none.
        if let Ok(address) = image.address(function) {
            options.push(format!("{option}{address:x}"));
        }
    }
    let mut qemu = process::command("timeout", &workspace::root());
    // Not `-nographic`: it makes writing non-blocking, and lines would be lost where they come fast.
    qemu.args(["120", QEMU, "-machine", board, "-display", "none", "-monitor", "none", "-serial", "none"]);
    qemu.args(["-semihosting-config", "enable=on,target=native", "-plugin"]).arg(options);
    qemu.arg("-kernel").arg(file);
    let name = file.file_name().unwrap_or_default().display();
    let step = Step::start(format!("{name} on {board}"));
    let (status, text) = process::stream(&step, &mut qemu)?;
    if !status.success() {
        bail!("{name} failed on {board}: {status}\n{}", process::tail(&text));
    }
    step.done();
    trace::spans(&text)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_plugin_fits_the_emulator() {
        assert_eq!(plugin_api("QEMU emulator version 7.2.22 (Debian 1:7.2)\nCopyright"), 1, "before 9");
        assert_eq!(plugin_api("QEMU emulator version 10.0.2"), 2, "since 9");
    }
}
