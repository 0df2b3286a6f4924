//! Where things are.

use std::env;
use std::path::{Path, PathBuf};

/// The root of the checkout.
#[must_use]
pub(crate) fn root() -> PathBuf {
    // Set by `cargo run`; the compiled-in folder serves a binary started by hand.
    let xtask = env::var_os("CARGO_MANIFEST_DIR").unwrap_or_else(|| env!("CARGO_MANIFEST_DIR").into());
    Path::new(&xtask).parent().map_or_else(|| PathBuf::from("."), Path::to_path_buf)
}

/// True where no person waits and nothing may be skipped.
#[must_use]
pub(crate) fn ci() -> bool {
    env::var_os("CI").is_some_and(|value| value == "true" || value == "1")
}

/// cargo's folder for build products: `CARGO_TARGET_DIR`, or the user's cache under CI so that a fresh
/// checkout need not compile its dependencies again, or `target`.
#[must_use]
pub(crate) fn target_dir() -> PathBuf {
    match (env::var_os("CARGO_TARGET_DIR"), ci().then(cache_dir).flatten()) {
        (Some(dir), _) => root().join(dir),
        (None, Some(cache)) => cache.join("sinew-ci/target"),
        (None, None) => root().join("target"),
    }
}

/// The user's cache folder, if there is a home.
fn cache_dir() -> Option<PathBuf> {
    let set = |name| env::var_os(name).filter(|value| !value.is_empty()).map(PathBuf::from);
    set("XDG_CACHE_HOME").or_else(|| set("HOME").map(|home| home.join(".cache")))
}

/// A path as a person would type it from the root.
#[must_use]
pub(crate) fn shown(path: &Path) -> String {
    path.strip_prefix(root()).unwrap_or(path).display().to_string()
}
