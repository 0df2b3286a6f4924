//! What a person may turn while the character lives; nothing here resets the motion.

use crate::asset::layout::MAX_REGIONS;
use crate::kernel::spring::Spring;
use crate::kernel::tiny::flush;
use crate::kernel::unskin::Limit;
use core::fmt;

/// Parameters of a region.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Region {
    /// Frequency, Hz, `0..=60`; below 0.001 it counts as 0.
    pub frequency: f32,
    /// Damping ratio, `0..=100`; 1 is critical.
    pub damping: f32,
    /// Factor of the offset, `0..=100`.
    pub gain: f32,
    /// Largest offset, body sizes, `1e-6..=100`.
    pub max_offset: f32,
}

impl Default for Region {
    fn default() -> Self {
        Self { frequency: 3.0, damping: 0.3, gain: 1.0, max_offset: 0.1 }
    }
}

impl Region {
    /// From a row of an asset.
    #[must_use]
    pub fn from_row([frequency, damping, gain, max_offset]: [f32; 4]) -> Self {
        Self { frequency, damping, gain, max_offset }
    }

    /// The spring of the region.
    #[must_use]
    pub fn spring(&self) -> Spring {
        Spring::new(self.frequency, self.damping)
    }

    /// The limit of the region for a body of `size`, with the global gain.
    #[must_use]
    pub fn limit(&self, size: f32, gain: f32) -> Limit {
        let longest = self.max_offset * size;
        Limit { gain: flush(self.gain * gain), inverse_square: 1.0 / (longest * longest) }
    }
}

/// All tunables. Lengths are in body sizes, so a model scaled by 100 behaves the same.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tunables {
    /// Gravity in the world, body sizes per s²; equal to the authored one, nothing sags.
    pub gravity: [f32; 3],
    /// Acceleration by wind in the world, body sizes per s².
    pub wind: [f32; 3],
    /// Share of the wind that comes in gusts, `0..=1`.
    pub gust: f32,
    /// Gusts a second, `0..=60`.
    pub gust_rate: f32,
    /// Share of the root's motion that is felt, `0..=1`.
    pub inertia: f32,
    /// Factor of all offsets, `0..=100`.
    pub gain: f32,
    /// Factor of all frequencies, `1e-6..=20`.
    pub frequency: f32,
    /// Factor of all damping ratios, `0..=100`.
    pub damping: f32,
    /// A step of the root longer than this is a teleport, body sizes, `1e-6..=1e9`.
    pub teleport: f32,
    /// A step longer than this settles the flesh, s, `1e-6..=10`.
    pub settle_after: f32,
    /// Parameters by region; those past the asset's last are not used.
    pub regions: [Region; MAX_REGIONS],
}

impl Default for Tunables {
    fn default() -> Self {
        Self {
            gravity: [0.0, -5.0, 0.0],
            wind: [0.0; 3],
            gust: 0.5,
            gust_rate: 1.0,
            inertia: 1.0,
            gain: 1.0,
            frequency: 1.0,
            damping: 1.0,
            teleport: 1.0,
            settle_after: 1.0,
            regions: [Region::default(); MAX_REGIONS],
        }
    }
}

/// A tunable that is NaN, infinite or out of its range.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TunableError {
    /// Name of the field.
    pub field: &'static str,
    /// Index of the region, where it is one of a region.
    pub region: Option<u8>,
}

impl TunableError {
    /// Stable name of the error, for programs; its text may change, this does not.
    #[must_use]
    pub const fn code(&self) -> &'static str {
        "TUNABLE_OUT_OF_RANGE"
    }
}

impl fmt::Display for TunableError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.region {
            None => write!(f, "tunable `{}` is out of its range", self.field),
            Some(i) => write!(f, "tunable `{}` of region {i} is out of its range", self.field),
        }
    }
}

impl core::error::Error for TunableError {}

impl Tunables {
    /// Words of [`Self::to_words`].
    pub const WORDS: usize = 14 + 4 * MAX_REGIONS;

    /// Checks every field.
    ///
    /// # Errors
    ///
    /// [`TunableError`] names the first field out of its range.
    pub fn validate(&self) -> Result<(), TunableError> {
        let words = self.to_words();
        let (global, regions) = words.split_at(GLOBAL.len());
        check(&GLOBAL, global, None)?;
        (0..).zip(regions.chunks_exact(REGION.len())).try_for_each(|(i, row)| check(&REGION, row, Some(i)))
    }

    /// The same with numbers that are too small to matter as zero ([`crate::kernel::tiny`]).
    #[must_use]
    pub fn flushed(&self) -> Self {
        let mut words = self.to_words();
        words.iter_mut().for_each(|word| *word = flush(*word));
        Self::of_words(&words)
    }

    /// As words, for saved states and replays.
    #[must_use]
    pub fn to_words(&self) -> [f32; Self::WORDS] {
        let ([gx, gy, gz], [wx, wy, wz]) = (self.gravity, self.wind);
        let mut words = [0.0; Self::WORDS];
        let head = [gx, gy, gz, wx, wy, wz, self.gust, self.gust_rate, self.inertia, self.gain];
        words[..10].copy_from_slice(&head);
        words[10..14].copy_from_slice(&[self.frequency, self.damping, self.teleport, self.settle_after]);
        for (row, r) in words[14..].chunks_exact_mut(4).zip(&self.regions) {
            row.copy_from_slice(&[r.frequency, r.damping, r.gain, r.max_offset]);
        }
        words
    }

    /// The inverse of [`Self::to_words`], checked.
    ///
    /// # Errors
    ///
    /// As [`Self::validate`].
    pub fn from_words(w: &[f32; Self::WORDS]) -> Result<Self, TunableError> {
        let tunables = Self::of_words(w);
        tunables.validate()?;
        Ok(tunables)
    }

    fn of_words(w: &[f32; Self::WORDS]) -> Self {
        let mut regions = [Region::default(); MAX_REGIONS];
        for (r, row) in regions.iter_mut().zip(w[14..].as_chunks::<4>().0) {
            *r = Region::from_row(*row);
        }
        Self {
            gravity: [w[0], w[1], w[2]],
            wind: [w[3], w[4], w[5]],
            gust: w[6],
            gust_rate: w[7],
            inertia: w[8],
            gain: w[9],
            frequency: w[10],
            damping: w[11],
            teleport: w[12],
            settle_after: w[13],
            regions,
        }
    }
}

/// A field: its name and range.
type Field = (&'static str, f32, f32);

/// The first words of [`Tunables::to_words`].
const GLOBAL: [Field; 14] = [
    ("gravity", -1e4, 1e4),
    ("gravity", -1e4, 1e4),
    ("gravity", -1e4, 1e4),
    ("wind", -1e4, 1e4),
    ("wind", -1e4, 1e4),
    ("wind", -1e4, 1e4),
    ("gust", 0.0, 1.0),
    ("gust_rate", 0.0, 60.0),
    ("inertia", 0.0, 1.0),
    ("gain", 0.0, 100.0),
    ("frequency", 1e-6, 20.0),
    ("damping", 0.0, 100.0),
    ("teleport", 1e-6, 1e9),
    ("settle_after", 1e-6, 10.0),
];

/// The words of a region.
const REGION: [Field; 4] =
    [("frequency", 0.0, 60.0), ("damping", 0.0, 100.0), ("gain", 0.0, 100.0), ("max_offset", 1e-6, 100.0)];

fn check(fields: &[Field], words: &[f32], region: Option<u8>) -> Result<(), TunableError> {
    let outside = |((_, low, high), word): &(&Field, &f32)| !(*word >= low && *word <= high);
    match fields.iter().zip(words).find(outside) {
        Some(((field, ..), _)) => Err(TunableError { field, region }),
        None => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_go_round_and_bad_fields_are_named() {
        let mut t = Tunables { inertia: 0.25, wind: [1.0, 2.0, 3.0], ..Tunables::default() };
        t.regions[15].gain = 7.0;
        assert_eq!(Tunables::from_words(&t.to_words()), Ok(t));
        t.regions[3].damping = f32::NAN;
        assert_eq!(t.validate(), Err(TunableError { field: "damping", region: Some(3) }));
        assert!(Tunables { gust: 1.5, ..Tunables::default() }.validate().is_err());
    }
}
