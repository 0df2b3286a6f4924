//! The one place that prints: progress on standard error, results on standard output.

use core::cell::Cell;
use core::time::Duration;
use std::io::{self, Write};
use std::time::Instant;

use indicatif::{ProgressBar, ProgressStyle};

/// Steps shorter than this are not worth a line of their own.
const SILENT: Duration = Duration::from_secs(1);
/// Where there is no terminal, a long step says so this often.
const HEARTBEAT: Duration = Duration::from_secs(30);

/// Prints a result.
pub(crate) fn say(text: impl AsRef<str>) {
    // A closed pipe (`| head`) is no reason to fail.
    let _ = writeln!(io::stdout(), "{}", text.as_ref());
}

/// Prints a remark on the way.
pub(crate) fn note(text: impl AsRef<str>) {
    let _ = writeln!(io::stderr(), "{}", text.as_ref());
}

/// Something that may take a while, shown while it runs.
#[derive(Debug)]
pub(crate) struct Step {
    name: String,
    start: Instant,
    spinner: ProgressBar,
    beat: Cell<Instant>,
}

impl Step {
    /// Announces the step.
    pub(crate) fn start(name: impl Into<String>) -> Self {
        let (name, now) = (name.into(), Instant::now());
        let spinner = ProgressBar::new_spinner();
        if let Ok(style) = ProgressStyle::with_template("{spinner} {prefix} {elapsed}  {wide_msg:.dim}") {
            spinner.set_style(style);
        }
        spinner.set_prefix(name.clone());
        spinner.enable_steady_tick(Duration::from_millis(100));
        Self { name, start: now, spinner, beat: Cell::new(now) }
    }

    /// Shows the latest line of output.
    pub(crate) fn line(&self, text: &str) {
        self.spinner.set_message(text.trim().to_owned());
    }

    /// To be called now and then: a sign of life where there is no terminal.
    pub(crate) fn tick(&self) {
        if self.spinner.is_hidden() && self.beat.get().elapsed() >= HEARTBEAT {
            self.beat.set(Instant::now());
            note(format!("   {} ... {:.0} s", self.name, self.seconds()));
        }
    }

    /// Time since the start.
    pub(crate) fn seconds(&self) -> f64 {
        self.start.elapsed().as_secs_f64()
    }

    /// Ends the step; a line remains if it took over a second.
    pub(crate) fn done(self) {
        if self.start.elapsed() >= SILENT {
            self.end("ok");
        }
    }

    /// Ends the step with a line in any case.
    pub(crate) fn end(self, result: &str) {
        self.spinner.finish_and_clear();
        note(format!("{result:>7} {} ({:.1} s)", self.name, self.seconds()));
    }
}

impl Drop for Step {
    fn drop(&mut self) {
        self.spinner.finish_and_clear();
    }
}

/// Rows as aligned text; the columns named in `right` are numbers.
#[must_use]
pub(crate) fn table(rows: &[Vec<String>], right: &[usize]) -> String {
    let columns = rows.iter().map(Vec::len).max().unwrap_or(0);
    let width = |c: usize| rows.iter().filter_map(|r| r.get(c)).map(|s| s.chars().count()).max().unwrap_or(0);
    let widths: Vec<usize> = (0..columns).map(width).collect();
    let cell = |(c, text): (usize, &String)| {
        let w = widths[c];
        if right.contains(&c) { format!("{text:>w$}") } else { format!("{text:<w$}") }
    };
    let line = |row: &Vec<String>| {
        row.iter().enumerate().map(cell).collect::<Vec<_>>().join("  ").trim_end().to_owned()
    };
    rows.iter().map(line).collect::<Vec<_>>().join("\n")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tables_align() {
        let rows = [vec!["a".into(), "10".into()], vec!["long".into(), "9".into()]];
        assert_eq!(table(&rows, &[1]), "a     10\nlong   9", "numbers to the right, text to the left");
    }
}
