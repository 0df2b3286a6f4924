//! `cargo xtask targets`: one program on every machine there is to be had, and one hash.

mod configuration;
mod machine;

use std::path::PathBuf;

use anyhow::{Result, bail};
use serde_json::json;

use crate::{process, report, workspace};
use configuration::{ALL, Configuration};

/// What came of a configuration.
struct Row {
    title: String,
    /// The golden hash, where the program came that far.
    hash: String,
    result: Verdict,
}

/// How a configuration compares with the first.
enum Verdict {
    Same(usize),
    Different(String),
    Skipped(String),
}

/// Runs the configurations whose name contains `filter`; how many agree and how many differ.
///
/// # Errors
///
/// If there is no such configuration, or the golden files cannot be made.
pub(crate) fn run(json: bool, filter: &str) -> Result<(u32, u32)> {
    let chosen: Vec<Configuration> = ALL
        .into_iter()
        .enumerate()
        .filter(|(i, c)| *i == 0 || c.title().contains(filter))
        .map(|(_, c)| c)
        .collect();
    if chosen.len() == 1 && !chosen[0].title().contains(filter) {
        bail!("no target is called {filter:?}; there are: {}", ALL.map(|c| c.title()).join("; "));
    }
    let folder = golden()?;
    // What cannot be installed is told by the configuration that needs it.
    let _ = machine::ready(&chosen);
    let mut reference = Vec::new();
    let mut rows = Vec::new();
    for configuration in &chosen {
        let came = machine::run(configuration, &folder).and_then(|text| lines(&text));
        if reference.is_empty() {
            reference
                .clone_from(came.as_ref().map_err(|e| anyhow::anyhow!("{}: {e:#}", configuration.title()))?);
        }
        rows.push(judge(configuration.title(), came, &reference));
    }
    let count = |f: fn(&Row) -> bool| u32::try_from(rows.iter().filter(|r| f(r)).count()).unwrap_or(u32::MAX);
    let ok = count(|row| matches!(row.result, Verdict::Same(_)));
    let failed = count(|row| matches!(row.result, Verdict::Different(_)));
    tell(&rows, json);
    Ok((ok, failed))
}

/// The asset and the recording that all of them get, made here.
fn golden() -> Result<PathBuf> {
    let folder = workspace::target_dir().join("golden");
    let mut cargo = process::cargo();
    cargo.args(["run", "--release", "--package", "sinew-tests", "--bin", "golden", "--"]).arg(&folder);
    process::run("the golden frames", &mut cargo)?;
    Ok(folder)
}

/// `(name, digest)` of each line of the program.
///
/// # Errors
///
/// What it says instead.
fn lines(text: &str) -> Result<Vec<(String, String)>> {
    let is_digest = |word: &str| word.len() == 16 && word.bytes().all(|b| b.is_ascii_hexdigit());
    let pairs = text.lines().filter_map(|line| line.split_once(' ')).filter(|(digest, _)| is_digest(digest));
    let pairs: Vec<_> = pairs.map(|(digest, name)| (name.to_owned(), digest.to_owned())).collect();
    if pairs.is_empty() { bail!("{}", text.trim()) } else { Ok(pairs) }
}

/// Compares a configuration with the first.
fn judge(title: String, came: Result<Vec<(String, String)>>, reference: &[(String, String)]) -> Row {
    let golden =
        |lines: &[(String, String)]| lines.iter().find(|(name, _)| name == "golden").map(|(_, d)| d.clone());
    let (hash, result) = match came {
        // A person may lack an emulator; where nobody waits nothing may be skipped.
        Err(reason) if workspace::ci() || !is_missing(&reason) => {
            (None, Verdict::Different(format!("{reason:#}")))
        }
        Err(reason) => (None, Verdict::Skipped(format!("{reason:#}"))),
        Ok(found) => (golden(&found), compare(&found, reference)),
    };
    Row { title, hash: hash.unwrap_or_default(), result }
}

/// Whether a failure is that of something to install.
fn is_missing(reason: &anyhow::Error) -> bool {
    let text = format!("{reason:#}");
    ["install", "needs ", "no compiler for", "alone"].iter().any(|word| text.contains(word))
}

/// The first digest that differs. Threads may be missing at the end.
fn compare(found: &[(String, String)], reference: &[(String, String)]) -> Verdict {
    if let Some(((name, found), _)) = found.iter().zip(reference).find(|(a, b)| a != b) {
        return Verdict::Different(format!("first difference: {name} ({found})"));
    }
    match reference.get(found.len()) {
        Some((name, _)) if !name.starts_with("crowd on") => Verdict::Different(format!("{name} is missing")),
        _ if found.len() > reference.len() => Verdict::Different("more digests than there are".to_owned()),
        _ => Verdict::Same(found.len()),
    }
}

fn tell(rows: &[Row], json: bool) {
    if json {
        let targets: Vec<_> = rows
            .iter()
            .filter(|row| !matches!(row.result, Verdict::Skipped(_)))
            .map(|row| json!({"name": row.title, "hash": row.hash, "ok": matches!(row.result, Verdict::Same(_))}))
            .collect();
        report::say(json!({ "targets": targets }).to_string());
        return;
    }
    let mut table = vec![["target", "golden hash", "digests", "result"].map(str::to_owned).to_vec()];
    for row in rows {
        let (digests, result) = match &row.result {
            Verdict::Same(digests) => (digests.to_string(), "ok".to_owned()),
            Verdict::Different(why) => (String::new(), format!("DIFFERENT: {why}")),
            Verdict::Skipped(why) => (String::new(), format!("skipped: {why}")),
        };
        table.push(vec![row.title.clone(), row.hash.clone(), digests, result]);
    }
    report::say(report::table(&table, &[2]));
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pairs(text: &str) -> Vec<(String, String)> {
        lines(text).expect("digests")
    }

    #[test]
    fn the_first_difference_is_named() {
        let a =
            pairs("0000000000000001 add\n0000000000000002 exp in f64\n0000000000000003 crowd on 2 threads\n");
        let b = pairs("0000000000000001 add\n0000000000000009 exp in f64\n");
        assert!(matches!(compare(&a, &a), Verdict::Same(3)), "equal");
        assert!(matches!(compare(&a[..2], &a), Verdict::Same(2)), "without threads");
        assert!(matches!(compare(&b, &a), Verdict::Different(why) if why.contains("exp in f64")), "named");
        assert!(
            matches!(compare(&a[..1], &a), Verdict::Different(why) if why.contains("exp in f64")),
            "missing"
        );
    }

    #[test]
    fn what_the_program_says_instead_of_digests_is_told() {
        let reason = lines("replay: frame 7 differs in stage skin\n").expect_err("no digest").to_string();
        assert_eq!(reason, "replay: frame 7 differs in stage skin", "in its words");
    }
}
