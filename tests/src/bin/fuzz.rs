//! Fuzzing without libFuzzer: `fuzz run [--seconds N] [TARGET]`, `fuzz seeds FOLDER`, `fuzz try TARGET FILE`.
//!
//! `cargo xtask fuzz` calls it. `run` mutates the seeds, the same way from run to run; an input that breaks a promise
//! is kept in `out/fuzz` and named, and `try` runs it again.

#![allow(clippy::print_stdout, reason = "a command line prints")]

use core::time::Duration;
use sinew_tests::fuzz::mutate::mutated;
use sinew_tests::fuzz::{TARGETS, Target, run, target};
use sinew_tests::random::Random;
use std::panic::catch_unwind;
use std::path::Path;
use std::process::ExitCode;
use std::time::Instant;
use std::{env, fs, io};

/// An input that takes longer is a finding: s.
const SLOWEST: f64 = 5.0;

fn main() -> ExitCode {
    let arguments: Vec<String> = env::args().skip(1).collect();
    let words: Vec<&str> = arguments.iter().map(String::as_str).collect();
    let done = match words.as_slice() {
        ["run"] => search(&TARGETS, 10),
        ["run", "--seconds", n] => n.parse().map_or(Err(usage()), |n| search(&TARGETS, n)),
        ["run", "--seconds", n, name] => match (n.parse(), target(name)) {
            (Ok(n), Some(target)) => search(&[target], n),
            _ => Err(usage()),
        },
        ["seeds", folder] => write_seeds(Path::new(folder)).map_err(|e| format!("{folder}: {e}")),
        ["try", name, file] if target(name).is_some() => {
            fs::read(file).map(|bytes| run(name, &bytes)).map_err(|e| format!("{file}: {e}"))
        }
        _ => Err(usage()),
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(reason) => {
            eprintln!("fuzz: {reason}");
            ExitCode::FAILURE
        }
    }
}

fn usage() -> String {
    let names: Vec<&str> = TARGETS.iter().map(|t| t.name).collect();
    let names = names.join(", ");
    format!("run [--seconds N [TARGET]], seeds FOLDER, or try TARGET FILE; targets are {names}")
}

/// Tries each target for `seconds` s.
fn search(targets: &[Target], seconds: u64) -> Result<(), String> {
    // Silent but for findings: a refused input may be caught by thousands.
    let mut findings = Vec::new();
    for target in targets {
        let seeds: Vec<Vec<u8>> = (target.seeds)().into_iter().map(|(_, bytes)| bytes).collect();
        let (start, end) = (Instant::now(), Duration::from_secs(seconds));
        let mut random = Random::new(0x51e3);
        let (mut tried, mut slowest) = (0_u64, 0.0_f64);
        while start.elapsed() < end {
            let bytes = mutated(&seeds, &mut random);
            let before = Instant::now();
            let broken = catch_unwind(|| (target.run)(&bytes)).is_err();
            let took = before.elapsed().as_secs_f64();
            (tried, slowest) = (tried + 1, slowest.max(took));
            if broken || took > SLOWEST {
                let file = keep(target.name, &bytes).map_err(|e| format!("out/fuzz: {e}"))?;
                findings.push(format!("{}: {file}", target.name));
                break;
            }
        }
        let passed = start.elapsed().as_secs_f64();
        println!("{:8} {tried} inputs in {passed:.0} s, the slowest in {:.1} ms", target.name, slowest * 1e3);
    }
    if findings.is_empty() { Ok(()) } else { Err(format!("promises broken by\n{}", findings.join("\n"))) }
}

/// Keeps an input; the name of its file.
fn keep(name: &str, bytes: &[u8]) -> io::Result<String> {
    fs::create_dir_all("out/fuzz")?;
    let file = format!("out/fuzz/{name}-{:016x}", sinew::math::digest::of_bytes(bytes));
    fs::write(&file, bytes)?;
    Ok(file)
}

/// Writes every target's seeds below `folder`.
fn write_seeds(folder: &Path) -> io::Result<()> {
    for target in TARGETS {
        let folder = folder.join(target.name);
        fs::create_dir_all(&folder)?;
        for (name, bytes) in (target.seeds)() {
            fs::write(folder.join(name), bytes)?;
        }
    }
    Ok(())
}
