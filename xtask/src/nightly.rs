//! Tools of the nightly compiler: libFuzzer and Miri. They are asked for, and done without where they cannot be had.

use std::process::Command;

use crate::report::Step;
use crate::{process, workspace};

/// Variables by which one toolchain's proxy would confuse another.
const PROXY: [&str; 5] = ["RUSTUP_TOOLCHAIN", "LD_LIBRARY_PATH", "RUSTC", "RUSTDOC", "CARGO"];

/// A program for the person's toolchains, not this one's.
fn rustup(arguments: &[&str]) -> Command {
    let mut command = process::command("rustup", &workspace::root());
    for name in PROXY {
        command.env_remove(name);
    }
    command.args(arguments);
    command
}

/// `cargo SUBCOMMAND` of the nightly toolchain, building apart from the others.
pub(crate) fn cargo(subcommand: &[&str]) -> Command {
    let mut command = rustup(&["run", "nightly", "cargo"]);
    command.args(subcommand).env("CARGO_TARGET_DIR", workspace::target_dir().join("nightly"));
    command
}

/// Whether a command succeeds; it may take a while.
fn succeeds(name: &str, mut command: Command) -> bool {
    let step = Step::start(name);
    let done = process::stream(&step, &mut command).is_ok_and(|(status, _)| status.success());
    step.end(if done { "ok" } else { "no" });
    done
}

/// Whether the toolchain is there, or could be installed.
fn toolchain() -> bool {
    process::output(&mut rustup(&["run", "nightly", "rustc", "--version"])).is_some()
        || succeeds(
            "rustup toolchain install nightly",
            rustup(&["toolchain", "install", "nightly", "--profile", "minimal"]),
        )
}

/// Whether `cargo miri` is there, or could be installed.
pub(crate) fn has_miri() -> bool {
    let ready = || process::output(&mut cargo(&["miri", "--version"])).is_some();
    let add = ["component", "add", "--toolchain", "nightly", "miri", "rust-src"];
    toolchain() && (ready() || (succeeds("rustup component add miri", rustup(&add)) && ready()))
}

/// Whether `cargo fuzz` is there, or could be installed.
pub(crate) fn has_fuzz() -> bool {
    let ready = || process::output(&mut cargo(&["fuzz", "--version"])).is_some();
    let install = || succeeds("cargo install cargo-fuzz", cargo(&["install", "--locked", "cargo-fuzz"]));
    toolchain() && (ready() || (install() && ready()))
}
