//! Results as rows: for people, as JSON, as a committed table.

use core::fmt;
use std::fs;
use std::path::Path;

use anyhow::{Context, Result};

use crate::functions::Function;
use crate::plane;
use crate::sweep::Swept;

/// Errors up to this many ulp of the largest entry are promised for functions of two arguments.
const PROMISED: f64 = 1.0;
/// A step may add no more energy than rounding does: half an ulp of 1.
const ACTIVE: f64 = 6e-8;

/// One function.
#[derive(Clone, Debug)]
pub(crate) struct Row {
    name: &'static str,
    domain: &'static str,
    inputs: u64,
    /// Largest error, ulp, of both bodies, and where.
    worst: f64,
    at: String,
    mean: f64,
    /// Inputs not correctly rounded by `f64` and by pairs of `f32`; `None` for functions of two arguments.
    wrong: Option<[u64; 2]>,
    by_mpfr: u64,
    seconds: f64,
    /// What else is wrong.
    faults: Vec<String>,
}

impl Row {
    #[allow(clippy::cast_precision_loss, reason = "a mean for people")]
    pub(crate) fn of_function(function: &Function, swept: &Swept) -> Self {
        let [a, b] = &swept.bodies;
        let worst = if b.worst.0 > a.worst.0 { b } else { a };
        Self {
            name: function.name,
            domain: function.domain,
            inputs: swept.inputs,
            worst: worst.worst.0,
            at: format!("{:e}", f32::from_bits(worst.worst.1)),
            mean: worst.sum / swept.inputs as f64,
            wrong: Some([a.wrong, b.wrong]),
            by_mpfr: swept.undecided,
            seconds: swept.seconds,
            faults: Vec::new(),
        }
    }

    #[allow(clippy::cast_precision_loss, reason = "a mean for people")]
    pub(crate) fn of_plane(swept: &plane::Swept) -> [Self; 2] {
        let mut faults = swept.broken.clone();
        let (active, [a, b]) = swept.active;
        if active > ACTIVE {
            faults.push(format!("a step adds energy: eigenvalue 1 + {active:e} at a {a:e} b {b:e}"));
        }
        // Else no error below could be believed.
        if swept.reference > 1e-3 {
            faults.push(format!("the reference errs by {} ulp", swept.reference));
        }
        [0, 1].map(|k| {
            let (worst, [a, b]) = swept.worst[k];
            Self {
                name: plane::NAMES[k],
                domain: plane::DOMAIN,
                inputs: swept.points[1],
                worst,
                at: format!("({a:e}, {b:e})"),
                mean: swept.sum[k] / swept.points[1] as f64,
                wrong: None,
                by_mpfr: swept.points[2],
                seconds: swept.seconds,
                faults: faults.clone(),
            }
        })
    }

    /// True if every promise is kept.
    pub(crate) fn holds(&self) -> bool {
        let accurate = match self.wrong {
            Some(wrong) => wrong == [0, 0],
            None => self.worst <= PROMISED,
        };
        accurate && self.faults.is_empty()
    }

    fn wrong(&self) -> String {
        self.wrong.map_or_else(|| "-".to_owned(), |[a, b]| format!("{a} / {b}"))
    }
}

impl fmt::Display for Row {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "{:9} {:27} {:10} inputs, worst {:.7} ulp at {}, mean {:.4}, not correctly rounded {}, {} by MPFR, {:.1} s",
            self.name,
            self.domain,
            self.inputs,
            self.worst,
            self.at,
            self.mean,
            self.wrong(),
            self.by_mpfr,
            self.seconds
        )?;
        self.faults.iter().try_for_each(|fault| write!(f, "\n  FAULT {fault}"))
    }
}

/// One object for all.
pub(crate) fn json(rows: &[Row]) -> String {
    let functions: Vec<_> = rows
        .iter()
        .map(|row| {
            serde_json::json!({
                "name": row.name,
                "domain": row.domain,
                "inputs": row.inputs,
                "worst_ulp": row.worst,
                "worst_at": row.at,
                "mean_ulp": row.mean,
                "not_correctly_rounded": row.wrong.map(|[a, b]| a.max(b)),
                "by_mpfr": row.by_mpfr,
                "seconds": row.seconds,
                "ok": row.holds(),
            })
        })
        .collect();
    serde_json::json!({ "functions": functions }).to_string()
}

/// Writes the table with what it was measured on; the file appears whole or not at all.
///
/// # Errors
///
/// With the path, if the file cannot be written.
pub(crate) fn write(path: &Path, rows: &[Row], stride: u32) -> Result<()> {
    let inputs =
        if stride == 0 { "all 2^32".to_owned() } else { format!("every 2^{stride}-th and all special") };
    let mut text = format!(
        "# Accuracy of the elementary functions\n\n\
         Made by `cargo xtask exhaustive`: {inputs} inputs of each function of one argument, by both bodies \
         (`f64`, and pairs of `f32`), against MPFR where doubles cannot decide the rounding. *Not correctly rounded* \
         counts the inputs for which either body does not return the `f32` nearest to the real value. `psi` and \
         `theta` are functions of two arguments over lattices, all pairs of exponents, the critical manifold and the \
         seams of the code; their error is in ulp of the largest of the five entries.\n\n\
         Measured on: {}.\n\n\
         | function | domain | inputs | worst error, ulp | at | mean error | not correctly rounded, f64 / f32 pairs | decided by MPFR | seconds |\n\
         | --- | --- | ---: | ---: | --- | ---: | ---: | ---: | ---: |\n",
        machine()
    );
    for row in rows {
        text += &format!(
            "| `{}` | {} | {} | {:.8} | {} | {:.4} | {} | {} | {:.0} |\n",
            row.name,
            row.domain.replace('|', "\\|"),
            row.inputs,
            row.worst,
            row.at,
            row.mean,
            row.wrong(),
            row.by_mpfr,
            row.seconds
        );
    }
    let partial = path.with_extension("partial");
    fs::write(&partial, text).with_context(|| format!("cannot write {}", partial.display()))?;
    fs::rename(&partial, path).with_context(|| format!("cannot write {}", path.display()))
}

/// Processor and threads.
fn machine() -> String {
    let info = fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let model = info.lines().find_map(|line| line.strip_prefix("model name")?.split_once(": "));
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    format!(
        "{}, {threads} threads, {}",
        model.map_or(std::env::consts::ARCH, |(_, name)| name),
        std::env::consts::OS
    )
}

/// The list of a function for the source.
pub(crate) fn hard(function: &Function, swept: &Swept) -> String {
    let found = &swept.bodies[0].examples;
    let mut text =
        format!("pub(crate) const {}: [(u32, u32); {}] = [", function.name.to_uppercase(), found.len());
    for (x, y) in found {
        let halves = |b: u32| format!("0x{:04x}_{:04x}", b >> 16, b & 0xffff);
        text += &format!("({}, {}), ", halves(*x), halves(*y));
    }
    text + "];"
}
