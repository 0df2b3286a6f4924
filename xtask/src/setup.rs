//! `cargo xtask setup`: what a fresh machine lacks. Each chore also asks for what it needs itself.

use anyhow::Result;

use crate::toolchain::Toolchain;
use crate::{browser, exhaustive, npm, report, wasm};

/// A part of the set-up: its name, and what makes it ready or says how.
type Part = (&'static str, fn() -> Result<String>);

const PARTS: [Part; 5] = [
    ("judge of accuracy", exhaustive::ready),
    ("wasm compiler", || Toolchain::for_target(wasm::TARGET).map(|t| format!("{t:?}"))),
    ("npm packages of wasm/", || npm::ready("wasm").map(|()| "installed".to_owned())),
    ("npm packages of www/", || npm::ready("www").map(|()| "installed".to_owned())),
    ("browser", || browser::ready().map(|path| path.display().to_string())),
];

/// Makes everything ready that can be; reports all that cannot, not only the first.
///
/// # Errors
///
/// If something is missing that only the user can install.
pub(crate) fn run() -> Result<()> {
    let mut rows = Vec::new();
    let mut missing = 0;
    for (name, ready) in PARTS {
        let state = ready().unwrap_or_else(|error| {
            missing += 1;
            format!("MISSING: {error:#}")
        });
        rows.push(vec![name.to_owned(), state]);
    }
    report::say(report::table(&rows, &[]));
    anyhow::ensure!(missing == 0, "{missing} of {} parts are missing", PARTS.len());
    Ok(())
}
