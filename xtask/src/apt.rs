//! Packages of Debian, where we may install them.

use std::fs;
use std::path::Path;

use anyhow::{Result, bail};

use crate::{process, report, workspace};

/// True when packages can be installed without asking: root on Debian.
#[must_use]
pub(crate) fn available() -> bool {
    // Debian alone: in Ubuntu, for one, the package `chromium` is a stub for a snap.
    let debian =
        fs::read_to_string("/etc/os-release").is_ok_and(|text| text.lines().any(|l| l == "ID=debian"));
    let root =
        || process::output(process::command("id", Path::new("/")).arg("-u")).is_some_and(|id| id == "0");
    debian && root()
}

/// Brings the lists of packages up to date.
///
/// # Errors
///
/// If `apt-get` fails.
pub(crate) fn update() -> Result<()> {
    process::run("apt-get update", process::command("apt-get", &workspace::root()).arg("update"))?;
    Ok(())
}

/// Installs packages; once more with fresh lists if that fails.
///
/// # Errors
///
/// If it fails twice, or packages cannot be installed here.
pub(crate) fn install(packages: &[&str]) -> Result<()> {
    let names = packages.join(" ");
    if !available() {
        bail!("install these packages: {names}");
    }
    let attempt = || {
        let mut apt = process::command("apt-get", &workspace::root());
        apt.env("DEBIAN_FRONTEND", "noninteractive")
            .args(["-o", "DPkg::Lock::Timeout=120", "install", "-y", "--no-install-recommends"])
            .args(packages);
        process::run(&format!("apt-get install {names}"), &mut apt)
    };
    if attempt().is_err() {
        report::note("   once more, with fresh package lists");
        update()?;
        attempt()?;
    }
    Ok(())
}
