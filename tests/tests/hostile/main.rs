//! The 80 classes of bad input: each has its cases here and its stable code.
//!
//! For every case: a code or a harmless run, no panic, no allocation, finite output, and the next valid frame
//! as if nothing had been offered.

mod container;
mod content;
mod numbers;
mod offer;
mod replays;
mod running;
mod table;

use sinew_tests::probe::Counting;
use std::collections::BTreeSet;
use std::panic::catch_unwind;
use std::path::Path;
use table::{CLASSES, Case};

#[global_allocator]
static COUNTING: Counting = Counting;

/// Classes of kernels that are not written yet: the count is a promise that can only fall.
const NOT_YET: usize = 18;

/// What is wrong with a class, if anything.
fn fault(case: &Case) -> Option<String> {
    match case {
        Case::Offers(offers, expected) => {
            let Ok(seen) = catch_unwind(offers) else { return Some("panicked (see above)".into()) };
            let (seen, expected) = (BTreeSet::from_iter(seen), BTreeSet::from_iter(expected.iter().copied()));
            (seen != expected).then(|| format!("came to {seen:?}, expected {expected:?}"))
        }
        Case::Elsewhere(file, mark) => {
            let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("..").join(file);
            let text = std::fs::read_to_string(path).unwrap_or_default();
            (!text.contains(mark)).then(|| format!("{file} has no test marked \"{mark}\""))
        }
        Case::NotYet(_) => None,
    }
}

#[test]
fn every_class_of_bad_input_has_its_code() {
    let numbers: Vec<u8> = CLASSES.iter().map(|c| c.number).collect();
    assert_eq!(numbers, (1..=80).collect::<Vec<u8>>(), "every class once, in order");
    let mut faults = Vec::new();
    let mut waiting = Vec::new();
    for class in &CLASSES {
        let start = std::time::Instant::now();
        faults.extend(fault(&class.case).map(|f| format!("{} {}: {f}", class.number, class.name)));
        println!("{} {}: {:.0} ms", class.number, class.name, start.elapsed().as_secs_f64() * 1e3);
        if let Case::NotYet(awaits) = class.case {
            waiting.push(format!("{} {} ({awaits})", class.number, class.name));
        }
    }
    println!("{} classes have cases; not yet:\n{}", 80 - waiting.len(), waiting.join("\n"));
    assert!(faults.is_empty(), "classes at fault:\n{}", faults.join("\n"));
    assert_eq!(waiting.len(), NOT_YET, "classes without a case:\n{}", waiting.join("\n"));
}
