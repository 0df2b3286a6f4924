//! `cargo xtask mcu`: the tube on microcontrollers without an operating system, emulated.

use std::path::Path;

use anyhow::{Context, Result, bail};

use crate::report::Step;
use crate::toolchain::Toolchain;
use crate::{apt, process, report, workspace};

/// Where the frames' digest is a constant.
const GOLDEN: &str = include_str!("../../tests/mcu/src/lib.rs");
const QEMU: &str = "/usr/bin/qemu-system-arm";

/// Rust target, board, and what the processor has.
const BOARDS: [[&str; 3]; 2] = [
    ["thumbv7em-none-eabihf", "mps2-an386", "Cortex-M4F, f32 in hardware"],
    ["thumbv6m-none-eabi", "mps2-an385", "Cortex-M0's instructions, no floats in hardware"],
];

/// Runs the firmware on each board; false if a digest differs.
///
/// # Errors
///
/// With what to install, or if the firmware cannot be built or fails.
pub(crate) fn run() -> Result<bool> {
    if !Path::new(QEMU).exists() {
        apt::install(&["qemu-system-arm"]).context("the microcontroller is emulated by `qemu-system-arm`")?;
    }
    let golden = golden(GOLDEN).context("no constant GOLDEN in tests/mcu/src/lib.rs")?;
    let mut rows = vec![["target", "processor", "digest", "result"].map(str::to_owned).to_vec()];
    let mut same = true;
    for [triple, board, processor] in BOARDS {
        let digest = on_board(triple, board)?;
        let ok = digest == golden;
        same &= ok;
        let result = if ok { "ok".to_owned() } else { format!("DIFFERENT: {golden} elsewhere") };
        rows.push(vec![triple.to_owned(), processor.to_owned(), digest, result]);
    }
    report::say(report::table(&rows, &[]));
    Ok(same)
}

/// The digest that the firmware prints.
fn on_board(triple: &str, board: &str) -> Result<String> {
    let folder = workspace::target_dir().join("targets/mcu");
    let mut cargo = Toolchain::for_target(triple)?.cargo("build", triple);
    cargo.args(["--release", "--package", "sinew-mcu", "--target-dir"]).arg(&folder);
    process::run(&format!("firmware for {triple}"), &mut cargo)?;
    let mut qemu = process::command("timeout", &workspace::root());
    qemu.args(["120", QEMU, "-machine", board, "-nographic"]);
    qemu.args(["-semihosting-config", "enable=on,target=native", "-kernel"]);
    qemu.arg(folder.join(triple).join("release/sinew-mcu"));
    let step = Step::start(format!("run on {board}"));
    let (status, text) = process::stream(&step, &mut qemu)?;
    if !status.success() {
        bail!("the firmware failed on {board}: {status}\n{}", process::tail(&text));
    }
    step.done();
    Ok(text.trim().to_owned())
}

/// The hexadecimal digits of the constant `GOLDEN` in Rust source.
fn golden(source: &str) -> Option<String> {
    let (_, rest) = source.split_once("GOLDEN: u64 = 0x")?;
    Some(rest.split(';').next()?.replace('_', ""))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_constant_is_found() {
        assert_eq!(golden("pub const GOLDEN: u64 = 0x00ab_cdef;").as_deref(), Some("00abcdef"), "digits");
        assert_eq!(golden(GOLDEN).map(|digits| digits.len()), Some(16), "in the firmware");
    }
}
