//! `sinew-target ASSET REPLAY`: prints the digests, a line each; in a browser, hands them out.

#[cfg(target_family = "wasm")]
mod wasm;

#[cfg(target_family = "wasm")]
fn main() {}

#[cfg(not(target_family = "wasm"))]
#[allow(clippy::print_stdout, reason = "a command line prints")]
fn main() -> std::process::ExitCode {
    use std::process::ExitCode;
    use std::{env, fs};
    let paths: Vec<String> = env::args().skip(1).collect();
    let [asset, replay] = paths.as_slice() else {
        eprintln!("usage: sinew-target ASSET REPLAY");
        return ExitCode::from(2);
    };
    let read = |path: &String| fs::read(path).map_err(|e| format!("{path}: {e}"));
    let digests = read(asset).and_then(|a| sinew_target::digests(&a, &read(replay)?));
    match digests {
        Ok(digests) => {
            digests.iter().for_each(|(name, digest)| println!("{digest:016x} {name}"));
            ExitCode::SUCCESS
        }
        Err(reason) => {
            println!("{reason}");
            ExitCode::FAILURE
        }
    }
}
