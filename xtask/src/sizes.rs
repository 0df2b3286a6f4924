//! What the npm package weighs, against the limits in `wasm/limits.json`.

use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail};
use flate2::Compression;
use flate2::write::GzEncoder;
use serde_json::Value;

use crate::report;

/// Files that a browser loads.
const SHIPPED: [&str; 3] = ["js", "mjs", "wasm"];

/// Prints the sizes of the package in `wasm` and compares them with its `limits.json`.
///
/// # Errors
///
/// If a sum is above its limit, or files cannot be read.
pub(crate) fn check(wasm: &Path) -> Result<()> {
    let mut files = Vec::new();
    collect(&wasm.join("pkg"), &mut files)?;
    files.sort();
    let mut rows = vec![row("file", "bytes", "gzip -9")];
    for file in &files {
        let bytes = fs::read(file)?;
        let name = file.strip_prefix(wasm).unwrap_or(file).display().to_string();
        rows.push(row(&name, &bytes.len().to_string(), &gzip(&bytes)?.to_string()));
    }
    report::say(report::table(&rows, &[1, 2]));
    let path = wasm.join("limits.json");
    let text = fs::read_to_string(&path).with_context(|| format!("cannot read {}", path.display()))?;
    let limits: Value =
        serde_json::from_str(&text).with_context(|| format!("{} is not JSON", path.display()))?;
    let exceeded = exceeded(wasm, &limits)?;
    if !exceeded.is_empty() {
        bail!("too big: {}", exceeded.join("; "));
    }
    Ok(())
}

fn row(name: &str, raw: &str, gzip: &str) -> Vec<String> {
    [name, raw, gzip].map(str::to_owned).to_vec()
}

/// The limits that are exceeded, in words; all are printed.
fn exceeded(wasm: &Path, limits: &Value) -> Result<Vec<String>> {
    let mut exceeded = Vec::new();
    for limit in limits["limits"].as_array().context("limits.json: `limits` is not a list")? {
        let name = limit["name"].as_str().context("limits.json: a limit without `name`")?;
        let most =
            limit["gzip"].as_u64().with_context(|| format!("limits.json: {name}: no number `gzip`"))?;
        let files =
            limit["files"].as_array().with_context(|| format!("limits.json: {name}: no list `files`"))?;
        let mut sum = 0;
        for file in files.iter().filter_map(Value::as_str) {
            let bytes = fs::read(wasm.join(file))
                .with_context(|| format!("limits.json: {name}: cannot read {file}"))?;
            sum += gzip(&bytes)? as u64;
        }
        report::say(format!("{name}: {sum} of {most} bytes"));
        if sum > most {
            exceeded.push(format!("{name} has {sum} bytes gzip, the limit is {most}"));
        }
    }
    Ok(exceeded)
}

/// Shipped files below `dir`.
fn collect(dir: &Path, files: &mut Vec<PathBuf>) -> Result<()> {
    for entry in fs::read_dir(dir).with_context(|| format!("cannot read {}", dir.display()))? {
        let path = entry?.path();
        if path.is_dir() {
            collect(&path, files)?;
        } else if path.extension().is_some_and(|e| SHIPPED.iter().any(|s| *s == e)) {
            files.push(path);
        }
    }
    Ok(())
}

/// Length after gzip at its best, as a server sends files prepared once.
fn gzip(bytes: &[u8]) -> Result<usize> {
    let mut encoder = GzEncoder::new(Vec::new(), Compression::best());
    encoder.write_all(bytes)?;
    Ok(encoder.finish()?.len())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_limit_is_a_limit() {
        let dir = std::env::temp_dir().join(format!("sinew-sizes-{}", std::process::id()));
        fs::create_dir_all(&dir).unwrap();
        let noise: Vec<u8> = (0..4000_u32).map(|i| (i.wrapping_mul(2_654_435_761) >> 24) as u8).collect();
        fs::write(dir.join("a.wasm"), &noise).unwrap();
        let size = gzip(&noise).unwrap();
        let limits = |most: usize| serde_json::json!({ "limits": [{ "name": "all", "files": ["a.wasm"], "gzip": most }] });
        assert!(exceeded(&dir, &limits(size)).unwrap().is_empty(), "exactly the limit is allowed");
        assert_eq!(exceeded(&dir, &limits(size - 1)).unwrap().len(), 1, "one byte more is not");
        let absent = serde_json::json!({ "limits": [{ "name": "x", "files": ["b.wasm"], "gzip": 1 }] });
        assert!(exceeded(&dir, &absent).is_err(), "a file that is gone must not count as small");
        fs::remove_dir_all(&dir).unwrap();
    }
}
