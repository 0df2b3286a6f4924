//! The figures as tables, and as JSON.

use std::collections::{BTreeMap, BTreeSet};

use serde_json::{Value, json};

use super::{Kernel, Outcome};
use crate::report;

/// What moves the flesh, with all the functions that it may use.
const MOTION: [&str; 6] = [
    "springs",
    "skinning, normals",
    "network",
    "elementary functions",
    "arithmetic in software",
    "vectors, shared",
];
/// Vertices of the tube, by which a frame is divided.
const SURFACE: &str = "skin: vertices and normals";

/// The tables, a column a board.
pub(crate) fn text(outcomes: &[Outcome]) -> String {
    let mut parts = vec![
        report::table(&boards(outcomes), &[3, 4, 5, 6, 7, 8]),
        report::table(&code(outcomes), &[1, 2]),
        report::table(&instructions(outcomes), &[1, 2]),
    ];
    parts.extend(listed(outcomes).into_iter().map(|name| report::table(&by_part(outcomes, &name), &[1, 2])));
    parts.join("\n\n")
}

/// A row a board: bits, flash, RAM.
fn boards(outcomes: &[Outcome]) -> Vec<Vec<String>> {
    let head =
        ["target", "processor", "digest", "code, B", "constants", "asset", "RAM, B", "of it floats", "stack"];
    let row = |o: &Outcome| {
        let s = &o.sizes;
        let numbers = [s.text, s.constants, s.asset, s.variables, s.memory, o.stack].map(|n| n.to_string());
        let result = if o.ok { "ok".to_owned() } else { format!("{} FAILED", o.digest) };
        let names = [o.triple.to_owned(), o.processor.to_owned(), result];
        names.into_iter().chain(numbers).collect()
    };
    rows(&head, outcomes.iter().map(row))
}

/// Bytes of code by part of the source, largest first.
fn code(outcomes: &[Outcome]) -> Vec<Vec<String>> {
    let columns: Vec<_> = outcomes.iter().map(|o| o.code.clone()).collect();
    let mut table = sums("bytes of code", outcomes, &columns);
    let motion = |o: &Outcome| MOTION.iter().filter_map(|part| o.code.get(part)).sum::<u64>().to_string();
    table.push(line("springs, skinning, network, and what they use", outcomes.iter().map(motion)));
    table
}

/// A kernel's instructions by part of the source.
fn by_part(outcomes: &[Outcome], name: &str) -> Vec<Vec<String>> {
    let of =
        |o: &Outcome| o.kernels.iter().find(|k| k.name == name).map(|k| k.parts.clone()).unwrap_or_default();
    sums(&format!("instructions: {name}"), outcomes, &outcomes.iter().map(of).collect::<Vec<_>>())
}

/// Names of the kernels whose instructions were listed.
fn listed(outcomes: &[Outcome]) -> Vec<String> {
    let kernels = outcomes.first().map(|o| &o.kernels[..]).unwrap_or_default();
    kernels.iter().filter(|k| !k.parts.is_empty()).map(|k| k.name.clone()).collect()
}

/// Numbers by name, a column a board, with their sum.
fn sums(title: &str, outcomes: &[Outcome], columns: &[BTreeMap<&str, u64>]) -> Vec<Vec<String>> {
    let number = |column: &BTreeMap<&str, u64>, name: &str| column.get(name).copied().unwrap_or(0);
    let mut names: Vec<&str> =
        columns.iter().flat_map(|c| c.keys().copied()).collect::<BTreeSet<_>>().into_iter().collect();
    names.sort_by_key(|name| core::cmp::Reverse(columns.first().map(|c| number(c, name))));
    let row = |name: &&str| line(name, columns.iter().map(|c| number(c, name).to_string()));
    let sum = line("sum", columns.iter().map(|c| c.values().sum::<u64>().to_string()));
    rows(&head(title, outcomes), names.iter().map(row).chain([sum]))
}

/// Instructions of the frames, and of each kernel by element.
fn instructions(outcomes: &[Outcome]) -> Vec<Vec<String>> {
    let mut table = Vec::new();
    for (i, name) in ["step", "skinning", "network", "all"].iter().enumerate() {
        table.push(line(
            &format!("frame: {name}"),
            outcomes.iter().map(|o| format!("{:.0}", o.frames[i].mean)),
        ));
    }
    table.push(line("frame: most", outcomes.iter().map(|o| o.frames[3].most.to_string())));
    let per_vertex = |o: &Outcome| (o.frames[0].mean + o.frames[1].mean) / vertices(o);
    table.push(line(
        "frame without network, a vertex",
        outcomes.iter().map(|o| format!("{:.1}", per_vertex(o))),
    ));
    let kernels = outcomes.first().map(|o| &o.kernels[..]).unwrap_or_default();
    for (i, kernel) in kernels.iter().enumerate() {
        let name = match kernel.elements {
            1 => kernel.name.clone(),
            n => format!("{}, one of {n}", kernel.name),
        };
        table.push(line(
            &name,
            outcomes.iter().map(|o| o.kernels.get(i).map_or_else(String::new, |k| format!("{:.1}", each(k)))),
        ));
    }
    rows(&head("instructions", outcomes), table.into_iter())
}

/// Instructions an element.
#[allow(clippy::cast_precision_loss, reason = "far below 2^52")]
fn each(kernel: &Kernel) -> f64 {
    kernel.instructions as f64 / kernel.elements.max(1) as f64
}

#[allow(clippy::cast_precision_loss, reason = "far below 2^52")]
fn vertices(outcome: &Outcome) -> f64 {
    outcome.kernels.iter().find(|k| k.name == SURFACE).map_or(1, |k| k.elements) as f64
}

fn head<'a>(title: &'a str, outcomes: &[Outcome]) -> Vec<&'a str> {
    [title].into_iter().chain(outcomes.iter().map(|o| o.triple)).collect()
}

fn line(name: &str, cells: impl Iterator<Item = String>) -> Vec<String> {
    [name.to_owned()].into_iter().chain(cells).collect()
}

fn rows(head: &[&str], rows: impl Iterator<Item = Vec<String>>) -> Vec<Vec<String>> {
    let head = head.iter().map(|cell| (*cell).to_owned()).collect();
    [head].into_iter().chain(rows).collect()
}

/// All figures as one object.
pub(crate) fn json(outcomes: &[Outcome]) -> Value {
    let board = |o: &Outcome| {
        let [step, skinning, network, all] = o.frames.map(|s| json!({"mean": s.mean, "most": s.most}));
        let kernel = |k: &Kernel| json!({"name": k.name, "elements": k.elements, "instructions": k.instructions, "parts": k.parts});
        let s = &o.sizes;
        json!({
            "target": o.triple,
            "processor": o.processor,
            "digest": o.digest,
            "ok": o.ok,
            "flash": {"code": s.text, "constants": s.constants, "asset": s.asset},
            "ram": {"variables": s.variables, "floats": s.memory, "stack": o.stack},
            "code": o.code,
            "vertices": vertices(o),
            "frame": {"step": step, "skinning": skinning, "network": network, "all": all},
            "kernels": o.kernels.iter().map(kernel).collect::<Vec<_>>(),
            "panics": o.panics,
            "heap": o.heap,
        })
    };
    json!({ "boards": outcomes.iter().map(board).collect::<Vec<_>>() })
}
