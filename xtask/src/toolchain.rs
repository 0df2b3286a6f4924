//! A compiler for a target that may not be installed.

use std::env;
use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Result, bail};

use crate::report::{self, Step};
use crate::{apt, process, workspace};

/// Debian's compiler, and where its library's source lies.
const SYSTEM_RUSTC: &str = "/usr/bin/rustc";
const SYSTEM_CARGO: &str = "/usr/bin/cargo";
const SYSTEM_STD: &str = "/usr/lib/rustlib/src/rust/library/std";
/// Debian's packages: compiler, library source, and the linker for targets without an operating system.
const PACKAGES: [&str; 4] = ["rustc-web", "cargo-web", "rust-web-src", "rust-web-llvm"];

/// How a target is reached.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Toolchain {
    /// The compiler in use has the target.
    Current,
    /// The distribution's compiler has it.
    System,
    /// The distribution's compiler builds the standard library along.
    SystemBuildStd,
}

impl Toolchain {
    /// The first way that leads to `target`, installing what may be installed.
    ///
    /// # Errors
    ///
    /// With what to install, when there is none.
    pub(crate) fn for_target(target: &str) -> Result<Self> {
        if has_target(&current_rustc(), target)
            || (rustup_add(target) && has_target(&current_rustc(), target))
        {
            return Ok(Self::Current);
        }
        if let Some(system) = Self::system(target) {
            return Ok(system);
        }
        let minimum = env!("CARGO_PKG_RUST_VERSION");
        if apt::available() {
            report::note(format!("   rustup cannot add {target}: Debian's compiler takes over"));
            apt::update()?; // an old list offers a compiler older than ours
            install_system()?;
            if let Some(system) = Self::system(target) {
                return Ok(system);
            }
        }
        bail!(
            "no compiler for {target}: run `rustup target add {target}`, or on Debian (Rust >= {minimum}) \
             `apt-get update && apt-get install --no-install-recommends {} lld`",
            PACKAGES.join(" ")
        )
    }

    /// What the distribution's compiler can do, if there is one and it is new enough.
    fn system(target: &str) -> Option<Self> {
        let rustc = Path::new(SYSTEM_RUSTC);
        let version = process::output(system_command(rustc).arg("--version"))?;
        if rust_version(&version)? < rust_version(concat!("rustc ", env!("CARGO_PKG_RUST_VERSION")))? {
            return None;
        }
        if has_target(rustc, target) {
            return Some(Self::System);
        }
        Path::new(SYSTEM_STD).exists().then_some(Self::SystemBuildStd)
    }

    /// `cargo SUBCOMMAND --target TARGET`, ready for further arguments.
    pub(crate) fn cargo(self, subcommand: &str, target: &str) -> Command {
        let mut cargo = match self {
            Self::Current => process::cargo(),
            Self::System | Self::SystemBuildStd => {
                let mut cargo = system_command(Path::new(SYSTEM_CARGO));
                cargo.env("RUSTC", SYSTEM_RUSTC).env("RUSTDOC", "/usr/bin/rustdoc");
                cargo.env("CARGO_TARGET_DIR", workspace::target_dir());
                cargo
            }
        };
        cargo.args([subcommand, "--target", target]);
        if self == Self::SystemBuildStd {
            let bare = target.contains("-none");
            let crates = if bare { "core,alloc,compiler_builtins" } else { "std,panic_abort" };
            // The unstable flag of a stable compiler: the library is its own, so they fit.
            cargo.env("RUSTC_BOOTSTRAP", "1").arg(format!("-Zbuild-std={crates}"));
        }
        cargo
    }
}

/// Installs Debian's compiler with the newest linker there is beside it.
fn install_system() -> Result<()> {
    let names = process::output(process::command("apt-cache", Path::new("/")).args(["pkgnames", "lld-"]));
    let newest = names
        .as_deref()
        .unwrap_or_default()
        .lines()
        .filter_map(|n| n.strip_prefix("lld-")?.parse().ok())
        .max();
    let lld = newest.map_or_else(|| "lld".to_owned(), |n: u32| format!("lld-{n}"));
    let mut packages = PACKAGES.to_vec();
    packages.push(&lld);
    apt::install(&packages)
}

/// The compiler that cargo would take.
fn current_rustc() -> PathBuf {
    env::var_os("RUSTC").map_or_else(|| PathBuf::from("rustc"), PathBuf::from)
}

/// A program of the distribution, without what a rustup proxy set for its own.
fn system_command(program: &Path) -> Command {
    let mut command = process::command(program, &workspace::root());
    for name in ["RUSTUP_TOOLCHAIN", "LD_LIBRARY_PATH", "RUSTC", "RUSTDOC", "CARGO"] {
        command.env_remove(name);
    }
    command
}

/// True if the target's core library is installed with this compiler.
fn has_target(rustc: &Path, target: &str) -> bool {
    let mut command = if rustc == Path::new(SYSTEM_RUSTC) {
        system_command(rustc)
    } else {
        process::command(rustc, &workspace::root())
    };
    let Some(dir) = process::output(command.args(["--print", "target-libdir", "--target", target])) else {
        return false;
    };
    // The path is printed even when nothing is there.
    Path::new(&dir).read_dir().is_ok_and(|mut entries| {
        entries.any(|e| e.is_ok_and(|e| e.file_name().to_string_lossy().starts_with("libcore-")))
    })
}

/// Asks rustup for the target; often it can be had even where little else is reachable.
fn rustup_add(target: &str) -> bool {
    let step = Step::start(format!("rustup target add {target}"));
    let mut rustup = process::command("rustup", &workspace::root());
    let added =
        process::stream(&step, rustup.args(["target", "add", target])).is_ok_and(|(s, _)| s.success());
    // Not a failure yet: there are other ways.
    step.end(if added { "ok" } else { "no" });
    added
}

/// Major and minor version from `rustc 1.96.0 (...)`.
fn rust_version(text: &str) -> Option<(u32, u32)> {
    let mut numbers = text.strip_prefix("rustc ")?.split(['.', ' ', '-']);
    Some((numbers.next()?.parse().ok()?, numbers.next()?.parse().ok()?))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn versions_compare_as_numbers() {
        assert_eq!(rust_version("rustc 1.96.0 (abc 2026-01-01)"), Some((1, 96)), "the usual form");
        assert!(rust_version("rustc 1.100.0") > rust_version("rustc 1.89"), "not as text");
        assert_eq!(rust_version("clang 17"), None, "another program");
    }
}
