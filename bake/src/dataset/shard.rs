//! Shares of a dataset: sample `k` belongs to shard `i` of `n` where `k ≡ i (mod n)`.

use core::fmt;
use core::str::FromStr;
use serde::{Deserialize, Serialize};

/// A share of a dataset, written `i/n` with `i` from 0 to `n − 1`.
///
/// ```
/// use sinew_bake::dataset::Shard;
/// let shard: Shard = "1/3".parse()?;
/// assert!(shard.contains(7) && !shard.contains(8));
/// assert_eq!(shard.indices(8).collect::<Vec<_>>(), [1, 4, 7]);
/// assert!("3/3".parse::<Shard>().is_err());
/// # Ok::<(), sinew_bake::dataset::ShardError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(try_from = "[u32; 2]", into = "[u32; 2]")]
pub struct Shard {
    index: u32,
    count: u32,
}

/// Text that is no shard.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("`{0}` is no shard; write i/n with i from 0 to n - 1, such as 0/4")]
pub struct ShardError(String);

impl Default for Shard {
    fn default() -> Self {
        Self::WHOLE
    }
}

impl Shard {
    /// All samples.
    pub const WHOLE: Self = Self { index: 0, count: 1 };

    /// Share `index` of `count`.
    ///
    /// # Errors
    ///
    /// If `index` is not below `count`.
    pub fn new(index: u32, count: u32) -> Result<Self, ShardError> {
        let shard = Self { index, count };
        if index < count { Ok(shard) } else { Err(ShardError(shard.to_string())) }
    }

    /// Whether a sample belongs to it.
    #[must_use]
    pub fn contains(self, sample: u64) -> bool {
        sample % u64::from(self.count) == u64::from(self.index)
    }

    /// Its samples below `samples`, ascending.
    pub fn indices(self, samples: u64) -> impl Iterator<Item = u64> {
        (u64::from(self.index)..samples).step_by(self.count as usize)
    }
}

impl fmt::Display for Shard {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}/{}", self.index, self.count)
    }
}

impl FromStr for Shard {
    type Err = ShardError;

    fn from_str(text: &str) -> Result<Self, ShardError> {
        let parts = text.split_once('/').and_then(|(i, n)| Some((i.parse().ok()?, n.parse().ok()?)));
        parts.and_then(|(i, n)| Self::new(i, n).ok()).ok_or_else(|| ShardError(text.to_owned()))
    }
}

impl TryFrom<[u32; 2]> for Shard {
    type Error = ShardError;

    fn try_from([index, count]: [u32; 2]) -> Result<Self, ShardError> {
        Self::new(index, count)
    }
}

impl From<Shard> for [u32; 2] {
    fn from(shard: Shard) -> Self {
        [shard.index, shard.count]
    }
}
