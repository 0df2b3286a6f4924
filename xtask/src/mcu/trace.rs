//! What a firmware printed, with the counts of the plugin between its lines.

use anyhow::{Context, Result, bail};

/// Marks a frame: before the step, the skinning, the network, and after it.
const MARKS: usize = 4;

/// A line of the firmware, and what the plugin counted until the next.
#[derive(Debug, Default, PartialEq, Eq)]
pub(crate) struct Span {
    /// The words of the line; empty before the first.
    pub name: String,
    /// Its number.
    pub number: u64,
    /// Instructions at each mark.
    pub marks: Vec<u64>,
    /// Addresses that ran since the mark before the last, and how often.
    pub ran: Vec<(u64, u64)>,
}

impl Span {
    /// Instructions between the two marks.
    pub(crate) fn instructions(&self) -> Option<u64> {
        let [start, end] = self.marks[..] else { return None };
        end.checked_sub(start)
    }
}

/// Instructions of a stage of the frames.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Stage {
    pub mean: f64,
    pub most: u64,
}

/// The lines of a run.
///
/// # Errors
///
/// If a line is neither the firmware's nor the plugin's.
pub(crate) fn spans(text: &str) -> Result<Vec<Span>> {
    let mut spans = vec![Span::default()];
    for line in text.lines() {
        let words: Vec<&str> = line.split(' ').collect();
        let last = spans.last_mut().context("never empty")?;
        match words[..] {
            ["mark", count] => {
                last.marks.push(count.parse().with_context(|| line.to_owned())?);
                last.ran.clear();
            }
            ["ran", address, times] => {
                let address = u64::from_str_radix(address, 16).with_context(|| line.to_owned())?;
                last.ran.push((address, times.parse().with_context(|| line.to_owned())?));
            }
            [ref name @ .., number] if !name.is_empty() && number.len() == 16 => {
                let number = u64::from_str_radix(number, 16).with_context(|| line.to_owned())?;
                spans.push(Span { name: name.join(" "), number, ..Span::default() });
            }
            _ => bail!("the firmware printed {line:?}"),
        }
    }
    Ok(spans)
}

/// The number of a line.
///
/// # Errors
///
/// If there is no such line.
pub(crate) fn number(spans: &[Span], name: &str) -> Result<u64> {
    let span = spans.iter().find(|span| span.name == name);
    span.map(|span| span.number).with_context(|| format!("the firmware printed no `{name}`"))
}

/// Step, skinning, network, and all of a frame, from the marks before the first line.
///
/// # Errors
///
/// If there are no whole frames.
pub(crate) fn frames(spans: &[Span]) -> Result<[Stage; MARKS]> {
    let marks = spans.first().map(|span| &span.marks[..]).unwrap_or_default();
    let (frames, rest) = marks.as_chunks::<MARKS>();
    if frames.is_empty() || !rest.is_empty() {
        bail!("{} marks are no whole frames", marks.len());
    }
    let stage = |from: usize, to: usize| {
        let counts = || frames.iter().map(|marks| marks[to] - marks[from]);
        #[allow(clippy::cast_precision_loss, reason = "far below 2^52")]
        let mean = counts().sum::<u64>() as f64 / frames.len() as f64;
        Stage { mean, most: counts().max().unwrap_or(0) }
    };
    Ok([stage(0, 1), stage(1, 2), stage(2, 3), stage(0, 3)])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_and_counts_are_told_apart() {
        let text = "mark 10\nmark 30\nmark 35\nmark 36\nmark 100\nmark 140\nmark 145\nmark 147\n\
                    two words 00000000000000ff\nmark 150\nran 7f 1\nmark 170\nran 80 3\n";
        let spans = spans(text).unwrap();
        assert_eq!(number(&spans, "two words").unwrap(), 255, "hexadecimal");
        assert_eq!(
            (spans[1].instructions(), &spans[1].ran[..]),
            (Some(20), &[(128, 3)][..]),
            "between marks"
        );
        let [step, skin, network, all] = frames(&spans).unwrap();
        assert_eq!((step.mean, step.most, all.most), (30.0, 40, 47), "the step and the frame");
        assert_eq!((skin.most, network.mean), (5, 1.5), "the others");
        assert!(super::spans("panicked at").is_err(), "other text");
    }
}
