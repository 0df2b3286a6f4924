//! `cargo xtask test`: everything, in order of cost; no failure hides another.

use std::process::Command;
use std::time::Instant;

use anyhow::{Context, Result, bail};

use crate::count::Count;
use crate::report::Step;
use crate::toolchain::Toolchain;
use crate::{cache, exhaustive, fuzz, mcu, nightly, npm, page, process, report, targets, wasm, workspace};

/// A microcontroller without an operating system: what compiles for it needs no `std`.
const BARE_METAL: &str = "thumbv7em-none-eabihf";

/// Time for each of the fuzzer's targets.
const FUZZ_SECONDS: u64 = 10;
/// What Miri runs of the runtime's own tests. `math` is left out: sweeps of thousands of evaluations, without a line
/// that touches memory by other means than the language.
const UNDER_MIRI: [&str; 6] = ["asset::", "kernel::", "lanes::", "replay::tests", "state::", "tunables::"];
/// Tests among them that take Miri over a quarter of a minute and show it nothing new.
const SLOW_UNDER_MIRI: [&str; 4] = ["gravity_sags", "exhaustive", "every_", "whole_domain"];

/// How a check ended that could be run.
enum Outcome {
    /// It passed.
    Passed(Count),
    /// It failed; the text says how.
    Failed(Count, String),
    /// It could not be run here; the text says why.
    Skipped(String),
}

/// A named check.
struct Check {
    name: &'static str,
    run: fn(&str) -> Result<Outcome>,
}

const CHECKS: [Check; 17] = [
    Check { name: "format", run: |name| cargo(name, &["fmt", "--all", "--check"], &[]) },
    Check { name: "clippy", run: clippy },
    Check { name: "rustdoc", run: rustdoc },
    Check { name: "tests, debug", run: tests_debug },
    Check { name: "tests of xtask", run: tests_of_xtask },
    Check { name: "tests, release", run: tests_release },
    Check { name: "golden tests, native CPU", run: tests_native },
    Check { name: "accuracy, strided", run: accuracy },
    Check { name: "one hash on every target", run: every_target },
    Check { name: "no_std on bare metal", run: bare_metal },
    Check { name: "microcontrollers", run: |_| microcontrollers() },
    Check { name: "fuzzing, briefly", run: |_| done(fuzz::run(FUZZ_SECONDS, None)) },
    Check { name: "core under Miri", run: miri },
    Check { name: "wasm package", run: |_| done(wasm::run()) },
    Check { name: "npm tests", run: npm_tests },
    Check { name: "page bundle", run: |_| done(page::build()) },
    Check { name: "page in a browser", run: page_test },
];

/// Runs the checks whose name contains `filter`, all when it is empty; true if none failed.
///
/// # Errors
///
/// If no check has such a name.
pub(crate) fn run(filter: &str) -> Result<bool> {
    let chosen: Vec<&Check> = CHECKS.iter().filter(|check| check.name.contains(filter)).collect();
    if chosen.is_empty() {
        let names: Vec<&str> = CHECKS.iter().map(|check| check.name).collect();
        bail!("no check is called {filter:?}; there are: {}", names.join("; "));
    }
    if workspace::ci() {
        cache::prepare()?;
    }
    exhaustive::ready()?;
    let whole = Step::start("all checks");
    let mut rows = vec![["check", "seconds", "passed", "failed", "result"].map(str::to_owned).to_vec()];
    let mut total = Count::default();
    for (index, check) in chosen.iter().enumerate() {
        report::note(format!("[{}/{}] {}", index + 1, chosen.len(), check.name));
        let (count, row) = carry_out(check);
        total += count;
        rows.push(row);
    }
    report::say(report::table(&rows, &[1, 2, 3]));
    report::say(format!("{:.0} s in all", whole.seconds()));
    report::say(format!("{} passed, {} failed", total.passed, total.failed));
    Ok(total.failed == 0)
}

/// Runs one check, tells of its failure, and sums it up as a row of the table.
fn carry_out(check: &Check) -> (Count, Vec<String>) {
    let start = Instant::now();
    let outcome =
        (check.run)(check.name).unwrap_or_else(|e| Outcome::Failed(Count::FAILED, format!("{e:#}")));
    let (count, result) = match outcome {
        Outcome::Passed(count) => (count, "ok".to_owned()),
        Outcome::Failed(count, why) => {
            report::note(format!("{why}\n"));
            (count, "FAILED".to_owned())
        }
        Outcome::Skipped(why) => (Count::default(), format!("skipped: {why}")),
    };
    let seconds = format!("{:.1}", start.elapsed().as_secs_f64());
    let word = result.split(':').next().unwrap_or(&result);
    report::note(format!("{word:>7} {} ({seconds} s)", check.name));
    let row =
        vec![check.name.to_owned(), seconds, count.passed.to_string(), count.failed.to_string(), result];
    (count, row)
}

/// A check without tests to count.
fn done(result: Result<()>) -> Result<Outcome> {
    result.map(|()| Outcome::Passed(Count::PASSED))
}

/// Runs a program and counts the tests it reports; one that reports none is itself the test.
fn program(name: &str, command: &mut Command) -> Result<Outcome> {
    let step = Step::start(name);
    let (status, text) = process::stream(&step, command)?;
    drop(step);
    let reported = Count::of(&text);
    if !status.success() || reported.is_some_and(|count| count.failed > 0) {
        let count = reported.unwrap_or_default();
        let count = Count { failed: count.failed.max(1), ..count };
        return Ok(Outcome::Failed(count, process::failure(name, command, status, &text)));
    }
    match reported {
        // Nothing was shown to be right.
        Some(count) if count == Count::default() && workspace::ci() => bail!("not one test was run"),
        Some(count) if count == Count::default() => {
            Ok(Outcome::Skipped("there are no such tests".to_owned()))
        }
        count => Ok(Outcome::Passed(count.unwrap_or(Count::PASSED))),
    }
}

/// [`program`], for cargo with further variables set.
fn cargo(name: &str, arguments: &[&str], variables: &[(&str, &str)]) -> Result<Outcome> {
    program(name, process::cargo().args(arguments).envs(variables.iter().copied()))
}

fn clippy(name: &str) -> Result<Outcome> {
    cargo(name, &["clippy", "--workspace", "--all-targets", "--", "-D", "warnings"], &[])
}

fn rustdoc(name: &str) -> Result<Outcome> {
    // Private items are documented for those who work here; links to them are thus no mistake.
    cargo(
        name,
        &["doc", "--workspace", "--no-deps", "--document-private-items"],
        &[("RUSTDOCFLAGS", "-D warnings -A rustdoc::private-intra-doc-links")],
    )
}

fn tests_debug(name: &str) -> Result<Outcome> {
    // Elsewhere xtask's dependencies would be compiled, and optimized, a second time.
    cargo(name, &["test", "--workspace", "--exclude", "xtask", "--no-fail-fast"], &[])
}

fn tests_of_xtask(name: &str) -> Result<Outcome> {
    cargo(name, &["test", "--package", "xtask", "--profile", "xtask", "--no-fail-fast"], &[])
}

fn tests_release(name: &str) -> Result<Outcome> {
    cargo(name, &["test", "--package", "sinew-tests", "--release", "--no-fail-fast"], &[])
}

/// The hashes again with every instruction this machine has, among them fused multiply-add.
fn tests_native(name: &str) -> Result<Outcome> {
    let mut cargo = process::cargo();
    cargo
        .args(["test", "--package", "sinew-tests", "--release", "--no-fail-fast"])
        .arg("--target-dir")
        .arg(workspace::target_dir().join("native"))
        .args(["--", "golden"])
        .env("RUSTFLAGS", "-Ctarget-cpu=native");
    program(name, &mut cargo)
}

/// Every 2¹⁰-th input of each elementary function, and all special ones.
fn accuracy(name: &str) -> Result<Outcome> {
    program(name, &mut exhaustive::strided())
}

fn every_target(_: &str) -> Result<Outcome> {
    let (passed, failed) = targets::run(false, "")?;
    let count = Count { passed, failed };
    Ok(if failed == 0 { Outcome::Passed(count) } else { Outcome::Failed(count, "targets differ".to_owned()) })
}

fn microcontrollers() -> Result<Outcome> {
    match mcu::run(false) {
        Ok(true) => Ok(Outcome::Passed(Count::PASSED)),
        Ok(false) => {
            Ok(Outcome::Failed(Count::FAILED, "digests differ, or symbols that must not be".to_owned()))
        }
        // A person may lack the emulator.
        Err(error) if !workspace::ci() => Ok(Outcome::Skipped(format!("{error:#}"))),
        Err(error) => Err(error),
    }
}

fn bare_metal(name: &str) -> Result<Outcome> {
    match Toolchain::for_target(BARE_METAL) {
        Ok(toolchain) => {
            let mut cargo = toolchain.cargo("build", BARE_METAL);
            program(name, cargo.args(["--package", "sinew", "--lib", "--no-default-features"]))
        }
        Err(error) => Ok(Outcome::Skipped(format!("{error:#}"))),
    }
}

/// The runtime's own tests in an interpreter that sees undefined behavior, also in the crates it uses.
fn miri(name: &str) -> Result<Outcome> {
    if !nightly::has_miri() {
        return Ok(Outcome::Skipped("Miri cannot be had here".to_owned()));
    }
    // Its stand-ins for programs name the checkout that built them, which a kept build folder may outlive.
    let stale = workspace::target_dir().join("nightly/miri");
    if stale.exists() {
        std::fs::remove_dir_all(&stale).with_context(|| format!("cannot remove {}", stale.display()))?;
    }
    let mut miri =
        nightly::cargo(&["miri", "test", "--package", "sinew", "--features", "std", "--lib", "--"]);
    miri.args(UNDER_MIRI).args(SLOW_UNDER_MIRI.iter().flat_map(|test| ["--skip", test]));
    program(name, miri.env("MIRIFLAGS", "-Zmiri-strict-provenance"))
}

fn npm_tests(name: &str) -> Result<Outcome> {
    wasm::build()?;
    npm::ready("wasm")?;
    program(name, npm::npm(&workspace::root().join("wasm")).arg("test"))
}

fn page_test(name: &str) -> Result<Outcome> {
    if !page::dist().exists() {
        page::build()?;
    }
    let (_server, mut npm) = page::test_command()?;
    program(name, &mut npm)
}
