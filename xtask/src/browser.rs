//! A Chromium for the page's tests.

use std::env;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail};

use crate::apt;

/// Where Chromium and its relatives usually lie.
const CANDIDATES: [&str; 5] = [
    "/usr/bin/chromium",
    "/usr/bin/chromium-browser",
    "/usr/bin/google-chrome",
    "/usr/bin/google-chrome-stable",
    "/Applications/Google Chrome.app/Contents/MacOS/Google Chrome",
];

/// The browser, installed first where that is possible.
///
/// # Errors
///
/// With what to install.
pub(crate) fn ready() -> Result<PathBuf> {
    const HOW: &str = "install Chromium or Google Chrome, or set CHROMIUM to the path of one";
    if let Some(set) = env::var_os("CHROMIUM").map(PathBuf::from) {
        if set.exists() {
            return Ok(set);
        }
        bail!("CHROMIUM is set to {}, which does not exist", set.display());
    }
    if let Some(found) = find() {
        return Ok(found);
    }
    if !apt::available() {
        bail!("no Chromium for the page's tests: {HOW}");
    }
    // Without a font of known measures, screenshots show boxes.
    apt::install(&["chromium", "fonts-dejavu-core"])?;
    find().context(HOW)
}

fn find() -> Option<PathBuf> {
    CANDIDATES.iter().map(Path::new).find(|path| path.exists()).map(Path::to_path_buf)
}
