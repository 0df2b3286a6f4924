//! Build products kept between CI runs of different checkouts.

use core::hash::{Hash, Hasher};
use std::collections::hash_map::DefaultHasher;
use std::fs::{self, File};
use std::path::{Path, PathBuf};
use std::time::SystemTime;

use anyhow::{Context, Result};

use crate::{report, workspace};

/// Above this the folder is begun anew: products of checkouts that are gone pile up there.
const LIMIT: u64 = 16 << 30;
/// Folders of the workspace whose files end up in build products.
const SOURCES: [&str; 5] = ["core", "bake", "wasm", "tests", "xtask"];
/// Folders in them which are not sources.
const MADE: [&str; 3] = ["node_modules", "pkg", "target"];

/// Makes the kept products safe to use with this checkout.
///
/// # Errors
///
/// If files cannot be read or written.
pub(crate) fn prepare() -> Result<()> {
    let target = workspace::target_dir();
    if size(&target) > LIMIT {
        report::note(format!("emptying {}", target.display()));
        fs::remove_dir_all(&target).with_context(|| format!("cannot remove {}", target.display()))?;
    }
    fs::create_dir_all(&target).with_context(|| format!("cannot create {}", target.display()))?;
    touch_if_changed(&workspace::root(), &target)
}

/// Marks all sources as new unless their content is what was last built from this folder.
///
/// cargo compares times, and a checkout made by copying may be older than products of other content.
fn touch_if_changed(root: &Path, target: &Path) -> Result<()> {
    let mut files = Vec::new();
    for folder in SOURCES {
        sources(&root.join(folder), &mut files);
    }
    files.sort();
    let mut content = DefaultHasher::new();
    for file in &files {
        file.hash(&mut content);
        fs::read(file).with_context(|| format!("cannot read {}", file.display()))?.hash(&mut content);
    }
    let mut place = DefaultHasher::new();
    root.hash(&mut place);
    let stamp = target.join(format!("sources-{:016x}", place.finish()));
    let hash = format!("{:016x}", content.finish());
    if fs::read_to_string(&stamp).is_ok_and(|old| old == hash) {
        return Ok(());
    }
    let now = SystemTime::now();
    for file in &files {
        let touched = File::options().append(true).open(file).and_then(|f| f.set_modified(now));
        touched.with_context(|| format!("cannot touch {}", file.display()))?;
    }
    fs::write(&stamp, hash).with_context(|| format!("cannot write {}", stamp.display()))
}

/// Plain files below `dir` that a build may read.
fn sources(dir: &Path, files: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(dir).into_iter().flatten().flatten() {
        let (path, name) = (entry.path(), entry.file_name());
        match entry.file_type() {
            Ok(kind) if kind.is_dir() && !MADE.iter().any(|made| *made == name) => sources(&path, files),
            Ok(kind) if kind.is_file() => files.push(path),
            _ => {}
        }
    }
}

/// Bytes below `dir`.
fn size(dir: &Path) -> u64 {
    let entries = fs::read_dir(dir).into_iter().flatten().flatten();
    let sizes = entries.filter_map(|entry| {
        let data = entry.metadata().ok()?;
        Some(if data.is_dir() { size(&entry.path()) } else { data.len() })
    });
    sizes.sum()
}

#[cfg(test)]
mod tests {
    use core::time::Duration;

    use super::*;

    #[test]
    fn changed_content_gets_a_new_time() {
        let dir = std::env::temp_dir().join(format!("sinew-cache-{}", std::process::id()));
        let (root, target, file) = (dir.join("root"), dir.join("target"), dir.join("root/core/src/lib.rs"));
        fs::create_dir_all(root.join("core/src")).unwrap();
        fs::create_dir_all(&target).unwrap();
        let old = SystemTime::now() - Duration::from_secs(1000);
        let write = |text: &str| {
            fs::write(&file, text).unwrap();
            File::options().append(true).open(&file).unwrap().set_modified(old).unwrap();
        };
        let is_old = || fs::metadata(&file).unwrap().modified().unwrap() == old;

        write("one");
        touch_if_changed(&root, &target).unwrap();
        assert!(!is_old(), "never seen: new");
        write("one");
        touch_if_changed(&root, &target).unwrap();
        assert!(is_old(), "same content: left alone");
        write("two");
        touch_if_changed(&root, &target).unwrap();
        assert!(!is_old(), "other content: new");
        fs::remove_dir_all(&dir).unwrap();
    }
}
