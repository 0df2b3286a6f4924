//! Building and running the program on each machine.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context, Result, bail};

use super::configuration::{Configuration, Machine, Processor};
use crate::report::Step;
use crate::server::Running;
use crate::toolchain::Toolchain;
use crate::{apt, browser, npm, process, wasm, workspace};

/// Packages of the emulators, with the libraries of another processor.
const QEMU: &str = "qemu-user";

/// Installs what the configurations need, in one go.
///
/// # Errors
///
/// With what to install.
pub(super) fn ready(configurations: &[Configuration]) -> Result<()> {
    let processors = configurations.iter().filter_map(|c| match c.machine {
        Machine::Emulated(processor) => Some(processor),
        _ => None,
    });
    let missing: Vec<&str> = processors
        .filter(|p| !emulator(p).is_file() || !Path::new("/usr").join(p.gnu).is_dir() || !linker(p).is_file())
        .flat_map(|p| p.packages)
        .collect();
    if missing.is_empty() {
        return Ok(());
    }
    apt::install(&[&[QEMU], &*missing].concat())
}

fn emulator(processor: &Processor) -> PathBuf {
    Path::new("/usr/bin").join(format!("qemu-{}", processor.qemu))
}

fn linker(processor: &Processor) -> PathBuf {
    Path::new("/usr/bin").join(format!("{}-gcc", processor.gnu))
}

/// Builds and runs the program on the files of `folder`; what it prints.
///
/// # Errors
///
/// If a tool is missing, or the program cannot be built, or fails.
pub(super) fn run(configuration: &Configuration, folder: &Path) -> Result<String> {
    let title = configuration.title();
    let build = build_folder(configuration);
    let files = ["golden.sinew", "golden.replay"].map(|name| folder.join(name));
    let name = if configuration.debug { "debug" } else { "release" };
    match configuration.machine {
        Machine::Here => {
            process::run(
                &format!("build for {title}"),
                &mut cargo(configuration, process::cargo(), "build"),
            )?;
            finish(&title, process::command(build.join(name).join("sinew-target"), folder).args(files))
        }
        Machine::Emulated(processor) => {
            if !cfg!(target_os = "linux") {
                bail!("QEMU emulates other processors under Linux alone");
            }
            if !emulator(&processor).is_file() {
                bail!(
                    "needs {}; install `{QEMU} {}`",
                    emulator(&processor).display(),
                    processor.packages.join(" ")
                );
            }
            compile(configuration, processor.triple, Some(&processor))?;
            let program = build.join(processor.triple).join(name).join("sinew-target");
            let mut qemu = process::command(emulator(&processor), folder);
            finish(&title, qemu.arg("-L").arg(Path::new("/usr").join(processor.gnu)).arg(program).args(files))
        }
        Machine::Node | Machine::Chromium => {
            compile(configuration, wasm::TARGET, None)?;
            let program = build.join(wasm::TARGET).join(name).join("sinew-target.wasm");
            fs::copy(&program, folder.join("target.wasm"))
                .with_context(|| format!("{}", program.display()))?;
            in_javascript(configuration, folder)
        }
    }
}

/// The page and Node run the same few lines.
fn in_javascript(configuration: &Configuration, folder: &Path) -> Result<String> {
    let scripts = workspace::root().join("tests/target/js");
    for script in ["run.mjs", "node.mjs", "index.html"] {
        fs::copy(scripts.join(script), folder.join(script))
            .with_context(|| format!("cannot copy {script}"))?;
    }
    let title = configuration.title();
    if matches!(configuration.machine, Machine::Node) {
        npm::check_node()?;
        return finish(&title, process::command("node", folder).arg("node.mjs"));
    }
    npm::ready("www")?;
    let (chromium, server) = (browser::ready()?, Running::start(folder, 0)?);
    finish(&title, npm::node("www", "text.mjs").arg(server.url()).env("CHROMIUM", chromium))
}

/// Configurations differ in flags, by which cargo does not tell builds apart.
fn build_folder(configuration: &Configuration) -> PathBuf {
    let folder = configuration.title().replace(|c: char| !c.is_ascii_alphanumeric(), "-");
    // Node and Chromium run the same module.
    let folder = folder.replace("Chromium", "Node");
    workspace::target_dir().join("targets").join(folder)
}

fn compile(configuration: &Configuration, triple: &str, processor: Option<&Processor>) -> Result<()> {
    let compiler = Toolchain::for_target(triple)?.cargo("build", triple);
    let mut cargo = cargo(configuration, compiler, "");
    if let Some(processor) = processor {
        let variable = triple.replace('-', "_").to_uppercase();
        cargo.env(format!("CARGO_TARGET_{variable}_LINKER"), linker(processor));
    }
    process::run(&format!("build for {}", configuration.title()), &mut cargo)?;
    Ok(())
}

fn cargo(configuration: &Configuration, mut cargo: Command, subcommand: &str) -> Command {
    cargo.args(Some(subcommand).filter(|s| !s.is_empty()));
    cargo.args(["--package", "sinew-target", "--bin", "sinew-target", "--target-dir"]);
    cargo.arg(build_folder(configuration)).env("RUSTFLAGS", configuration.flags);
    cargo.args((!configuration.debug).then_some("--release"));
    cargo
}

/// Runs the program; its failure is told in its own words.
fn finish(title: &str, command: &mut Command) -> Result<String> {
    let step = Step::start(format!("run on {title}"));
    let (status, text) = process::stream(&step, command)?;
    if !status.success() {
        bail!("{}", process::tail(&text));
    }
    step.done();
    Ok(text)
}
