//! How many tests a program says it ran.

use core::ops::AddAssign;

/// Tests that passed and failed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Count {
    /// Tests that passed.
    pub passed: u32,
    /// Tests that failed.
    pub failed: u32,
}

impl Count {
    /// A check that is one test.
    pub(crate) const PASSED: Self = Self { passed: 1, failed: 0 };
    /// The same, failed.
    pub(crate) const FAILED: Self = Self { passed: 0, failed: 1 };

    /// Sums what cargo's and Node's test runners report in `text`; `None` if neither ran.
    #[must_use]
    pub(crate) fn of(text: &str) -> Option<Self> {
        let mut count = Self::default();
        let mut reported = false;
        for line in text.lines() {
            if let Some((_, result)) = line.trim_start().split_once("test result: ") {
                count.passed += number_before(result, " passed");
                count.failed += number_before(result, " failed");
                reported = true;
            }
            // `# pass 3` in Node 20, `ℹ pass 3` later and on terminals.
            let words: Vec<&str> = line.split_whitespace().collect();
            match words[..] {
                ["#" | "ℹ", "pass", n] => count.passed += n.parse().unwrap_or(0),
                ["#" | "ℹ", "fail", n] => count.failed += n.parse().unwrap_or(0),
                _ => continue,
            }
            reported = true;
        }
        reported.then_some(count)
    }
}

impl AddAssign for Count {
    fn add_assign(&mut self, other: Self) {
        self.passed += other.passed;
        self.failed += other.failed;
    }
}

/// The number in front of a word, 0 if there is none.
fn number_before(text: &str, word: &str) -> u32 {
    let before = text.split_once(word).map(|(before, _)| before);
    before.and_then(|before| before.rsplit(' ').next()?.parse().ok()).unwrap_or(0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_runners_are_understood() {
        let cargo = "test result: ok. 12 passed; 0 failed; 1 ignored; 0 measured; 3 filtered out\n\
                     test result: FAILED. 3 passed; 2 failed; 0 ignored";
        assert_eq!(Count::of(cargo), Some(Count { passed: 15, failed: 2 }), "cargo, two binaries");
        let node = "# tests 4\n# pass 3\n# fail 1\n";
        assert_eq!(Count::of(node), Some(Count { passed: 3, failed: 1 }), "Node 20");
        assert_eq!(Count::of("ℹ pass 5\nℹ fail 0"), Some(Count { passed: 5, failed: 0 }), "Node 22");
        assert_eq!(Count::of("10 passed in a sentence"), None, "other text");
    }
}
