//! Node and the packages of `wasm/` and `www/`.

use std::fs;
use std::path::Path;
use std::process::Command;

use anyhow::{Context, Result, bail};

use crate::{process, report, workspace};

/// Where the hash of the installed lock file is kept.
const STAMP: &str = "node_modules/.sinew-stamp";

/// Checks that Node is there and new enough for the packages used.
///
/// # Errors
///
/// With where to get it.
pub(crate) fn check_node() -> Result<()> {
    const HOW: &str = "install it from https://nodejs.org, or with an older npm: \
                       `npm install --prefix ~/.local node@22` and put ~/.local/node_modules/.bin on PATH";
    let found = process::output(process::command("node", &workspace::root()).arg("--version"));
    let Some(found) = found else {
        bail!("Node >= 20.19 is needed and there is none on PATH: {HOW}");
    };
    if !new_enough(&found) {
        bail!("Node >= 20.19 or >= 22.12 is needed, found {found}: {HOW}");
    }
    if process::output(process::command("npm", &workspace::root()).arg("--version")).is_none() {
        bail!("npm is needed and is not on PATH: it comes with Node, or as the package `npm`");
    }
    Ok(())
}

/// Vite's condition: 20.19 and later 20s, 22.12 and later.
fn new_enough(version: &str) -> bool {
    let mut numbers = version.trim_start_matches('v').split('.').map_while(|n| n.parse::<u32>().ok());
    match (numbers.next(), numbers.next()) {
        (Some(20), Some(minor)) => minor >= 19,
        (Some(22), Some(minor)) => minor >= 12,
        (Some(major), Some(_)) => major > 22,
        _ => false,
    }
}

/// Makes `node_modules` of `folder` what its lock file says; does nothing when it is.
///
/// # Errors
///
/// If Node is missing or `npm ci` fails twice.
pub(crate) fn ready(folder: &str) -> Result<()> {
    check_node()?;
    let dir = workspace::root().join(folder);
    let lock = dir.join("package-lock.json");
    let wanted = fs::read_to_string(&lock).with_context(|| format!("cannot read {}", lock.display()))?;
    if fs::read_to_string(dir.join(STAMP)).is_ok_and(|installed| installed == wanted) {
        return Ok(());
    }
    let attempt = || process::run(&format!("npm ci in {folder}/"), npm(&dir).arg("ci"));
    if let Err(error) = attempt() {
        report::note(format!("   once more: {}", error.to_string().lines().next().unwrap_or_default()));
        attempt()?;
    }
    fs::write(dir.join(STAMP), wanted).with_context(|| format!("cannot write {STAMP} in {folder}/"))
}

/// npm in a folder; quiet about itself.
pub(crate) fn npm(dir: &Path) -> Command {
    let mut npm = process::command("npm", dir);
    npm.args(["--no-audit", "--no-fund", "--no-update-notifier"]);
    npm
}

/// `node SCRIPT ARGS...` in a folder of the workspace.
pub(crate) fn node(folder: &str, script: &str) -> Command {
    let mut node = process::command("node", &workspace::root().join(folder));
    node.arg(script);
    node
}

#[cfg(test)]
mod tests {
    use super::new_enough;

    #[test]
    fn node_versions_are_those_vite_takes() {
        for good in ["v20.19.0", "v20.20.2", "v22.12.0", "v23.0.0", "v24.1.0"] {
            assert!(new_enough(good), "{good}");
        }
        for bad in ["v18.20.4", "v20.18.3", "v21.7.0", "v22.11.0", "", "nonsense"] {
            assert!(!new_enough(bad), "{bad}");
        }
    }
}
