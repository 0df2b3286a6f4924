//! `cargo xtask fuzz`: every target for a while, by libFuzzer where it can be had, else by a seeded mutator.

use std::process::Command;

use anyhow::{Result, bail};

use crate::report::Step;
use crate::{nightly, process, report, workspace};

/// The targets of `tests/fuzz`.
const TARGETS: [&str; 8] = ["asset", "replay", "gltf", "recipe", "tunables", "bvh", "dataset", "setters"];

/// Tries each target for `seconds` s; `only` names one of them.
///
/// # Errors
///
/// Where a promise is broken, with the input that breaks it; for a name that is no target.
pub(crate) fn run(seconds: u64, only: Option<&str>) -> Result<()> {
    let chosen: Vec<&str> = TARGETS.into_iter().filter(|t| only.is_none_or(|name| name == *t)).collect();
    if chosen.is_empty() {
        bail!("there is no such target; there are: {}", TARGETS.join(", "));
    }
    if nightly::has_fuzz() {
        return guided(seconds, &chosen);
    }
    report::note("   no libFuzzer here: the seeded mutator takes over");
    seeded(seconds, only)
}

/// By libFuzzer with `AddressSanitizer`, guided by coverage.
fn guided(seconds: u64, targets: &[&str]) -> Result<()> {
    let mut rows = vec![["target", "inputs", "seconds", "edges covered"].map(str::to_owned).to_vec()];
    for target in targets {
        let step = Step::start(format!("fuzz {target}"));
        let mut fuzz = nightly::cargo(&["fuzz", "run", "--fuzz-dir", "tests/fuzz", target, "--"]);
        fuzz.arg(format!("-max_total_time={seconds}"));
        fuzz.args(["-timeout=10", "-rss_limit_mb=4096", "-max_len=65536", "-print_final_stats=1"]);
        let text = finish(&step, &mut fuzz, "fuzz")?;
        step.done();
        let inputs = after(&text, "stat::number_of_executed_units:").unwrap_or_default();
        let edges = text.lines().rev().find_map(|line| after(line, " cov: ")).unwrap_or_default();
        rows.push(vec![(*target).to_owned(), inputs, seconds.to_string(), edges]);
    }
    report::say(report::table(&rows, &[1, 2, 3]));
    Ok(())
}

/// By the mutator of `sinew_tests::fuzz`: the same inputs from run to run.
fn seeded(seconds: u64, only: Option<&str>) -> Result<()> {
    let step = Step::start("fuzz");
    let mut fuzz = process::cargo();
    fuzz.args(["run", "--release", "--package", "sinew-tests", "--bin", "fuzz", "--", "run", "--seconds"]);
    fuzz.arg(seconds.to_string()).args(only);
    let text = finish(&step, &mut fuzz, "fuzz")?;
    step.done();
    let told: Vec<&str> = text.lines().filter(|line| line.contains(" inputs in ")).collect();
    report::say(told.join("\n"));
    Ok(())
}

/// Runs a fuzzer to its end.
fn finish(step: &Step, command: &mut Command, name: &str) -> Result<String> {
    let (status, text) = process::stream(step, command)?;
    if status.success() {
        return Ok(text);
    }
    bail!(
        "{}\n`cargo run -p sinew-tests --bin fuzz -- try TARGET FILE` runs the input again",
        process::failure(name, command, status, &text)
    )
}

/// The number after `mark`.
fn after(text: &str, mark: &str) -> Option<String> {
    let rest = text.split(mark).nth(1)?.trim_start();
    let digits: String = rest.chars().take_while(char::is_ascii_digit).collect();
    (!digits.is_empty()).then_some(digits)
}

/// Writes the seeds of every target into `tests/fuzz/corpus`.
///
/// # Errors
///
/// If they cannot be made or written.
pub(crate) fn seeds() -> Result<()> {
    let folder = workspace::root().join("tests/fuzz/corpus");
    let mut fuzz = process::cargo();
    fuzz.args(["run", "--package", "sinew-tests", "--bin", "fuzz", "--", "seeds"]).arg(&folder);
    process::run("seeds of the fuzzer", &mut fuzz)?;
    report::say(format!("seeds: {}", workspace::shown(&folder)));
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_found_in_libfuzzers_report() {
        let line = "#4194304\tpulse  cov: 1234 ft: 77 corp: 8/90b exec/s: 99";
        assert_eq!(after(line, " cov: ").as_deref(), Some("1234"), "as it prints it");
        assert_eq!(after(line, "no such"), None, "not there");
    }

    #[test]
    fn the_targets_are_those_of_the_fuzz_crate() {
        let manifest = include_str!("../../tests/fuzz/Cargo.toml");
        let named = manifest.lines().filter(|line| line.starts_with("path = \"fuzz_targets/")).count();
        assert_eq!(named, TARGETS.len(), "as many there as here");
        for target in TARGETS {
            assert!(manifest.contains(&format!("fuzz_targets/{target}.rs")), "{target} is there");
        }
    }
}
