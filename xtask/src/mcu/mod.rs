//! `cargo xtask mcu`: the tube on microcontrollers without an operating system, emulated, and what it costs there.

mod board;
mod image;
mod tables;
mod trace;

use std::collections::BTreeMap;
use std::path::Path;

use anyhow::{Context, Result};

use crate::report;
use image::{Image, Lines, Sizes};
use trace::{Span, Stage};

/// Where the frames' digest is a constant.
const GOLDEN: &str = include_str!("../../../tests/mcu/src/lib.rs");
/// Whether the firmware is known to be free of panics: if so, a symbol of one fails the run.
const PANIC_FREE: bool = true;
/// Parts of names that only a program that may panic, or format text, contains.
const PANICS: [&str; 5] = ["core::panicking", "rust_begin_unwind", "_fail", "panic", "core::fmt"];
/// Parts of names that only a program with a heap contains.
const HEAP: [&str; 4] = ["__rust_alloc", "__rg_alloc", "__rdl_alloc", "alloc::"];

/// Rust target, board, and what the processor has.
const BOARDS: [[&str; 3]; 2] = [
    ["thumbv7em-none-eabihf", "mps2-an386", "Cortex-M4F, f32 in hardware"],
    ["thumbv6m-none-eabi", "mps2-an385", "Cortex-M0's instructions, no floats in hardware"],
];

/// What came of a board.
#[derive(Debug)]
struct Outcome {
    triple: &'static str,
    processor: &'static str,
    digest: String,
    /// Whether the digest is that of every other machine, and no symbol is there that must not be.
    ok: bool,
    sizes: Sizes,
    /// Bytes of the stack that were in use.
    stack: u64,
    /// Bytes of code by part of the source.
    code: BTreeMap<&'static str, u64>,
    /// Step, skinning, network, all.
    frames: [Stage; 4],
    /// One part of the work after the other.
    kernels: Vec<Kernel>,
    /// Symbols of panics and of text formatting.
    panics: Vec<String>,
    /// Symbols of a heap.
    heap: Vec<String>,
}

/// Work that was counted on its own.
#[derive(Debug)]
struct Kernel {
    name: String,
    /// Points, vertices or calls.
    elements: u64,
    instructions: u64,
    /// Instructions by part of the source, where asked for.
    parts: BTreeMap<&'static str, u64>,
}

/// Runs the firmware on each board; false if a digest differs, or a symbol is there that must not be.
///
/// # Errors
///
/// With what to install, or if the firmware cannot be built or fails.
pub(crate) fn run(json: bool) -> Result<bool> {
    let plugin = board::ready()?;
    let golden = golden(GOLDEN).context("no constant GOLDEN in tests/mcu/src/lib.rs")?;
    let outcomes =
        BOARDS.iter().map(|board| on_board(board, &plugin, &golden)).collect::<Result<Vec<_>>>()?;
    let text = if json { tables::json(&outcomes).to_string() } else { tables::text(&outcomes) };
    report::say(text);
    for outcome in &outcomes {
        tell_failures(outcome, &golden);
    }
    Ok(outcomes.iter().all(|outcome| outcome.ok))
}

/// Builds, runs and reads both firmwares.
fn on_board(
    &[triple, machine, processor]: &[&'static str; 3],
    plugin: &Path,
    golden: &str,
) -> Result<Outcome> {
    let [player, figures] = board::build(triple)?;
    let image = Image::read(&player)?;
    let spans = board::run(machine, plugin, &player, &image)?;
    let digest = format!("{:016x}", trace::number(&spans, "digest")?);
    let owned = |words: &[&str]| image.with_any(words).into_iter().map(str::to_owned).collect::<Vec<_>>();
    let (panics, heap) = (owned(&PANICS), owned(&HEAP));
    Ok(Outcome {
        triple,
        processor,
        ok: digest == golden && heap.is_empty() && (panics.is_empty() || !PANIC_FREE),
        digest,
        sizes: image.sizes,
        stack: trace::number(&spans, "stack")?,
        code: image.code(&Lines::read(&player)?)?,
        frames: trace::frames(&spans)?,
        kernels: kernels(
            &board::run(machine, plugin, &figures, &Image::read(&figures)?)?,
            &Lines::read(&figures)?,
        )?,
        panics,
        heap,
    })
}

/// The counted lines of a run.
fn kernels(spans: &[Span], lines: &Lines) -> Result<Vec<Kernel>> {
    let kernel = |span: &Span| {
        let mut parts = BTreeMap::new();
        for (address, times) in &span.ran {
            *parts.entry(lines.part(*address)?).or_default() += times;
        }
        let instructions =
            span.instructions().with_context(|| format!("no two marks after `{}`", span.name))?;
        Ok(Kernel { name: span.name.clone(), elements: span.number, instructions, parts })
    };
    spans.iter().filter(|span| !span.name.is_empty()).map(kernel).collect()
}

/// Says on standard error why a board failed.
fn tell_failures(outcome: &Outcome, golden: &str) {
    let triple = outcome.triple;
    if outcome.digest != golden {
        report::note(format!("{triple}: the digest is {}, elsewhere {golden}", outcome.digest));
    }
    for (what, symbols) in [("panic or format text", &outcome.panics), ("use a heap", &outcome.heap)] {
        if !symbols.is_empty() {
            report::note(format!("{triple}: symbols of code that may {what}: {}", symbols.join(", ")));
        }
    }
}

/// The hexadecimal digits of the constant `GOLDEN` in Rust source.
fn golden(source: &str) -> Option<String> {
    let (_, rest) = source.split_once("GOLDEN: u64 = 0x")?;
    Some(rest.split(';').next()?.replace('_', ""))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_constant_is_found() {
        assert_eq!(golden("pub const GOLDEN: u64 = 0x00ab_cdef;").as_deref(), Some("00abcdef"), "digits");
        assert_eq!(golden(GOLDEN).map(|digits| digits.len()), Some(16), "in the firmware");
    }
}
