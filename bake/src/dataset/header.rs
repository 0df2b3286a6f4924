//! The head of a dataset: magic, version, and as JSON what its samples are.

use super::Shard;
use super::store::{length, read_at};
use crate::Error;
use serde::{Deserialize, Serialize};
use std::io::{self, Read, Seek};

/// Version of the format.
pub const VERSION: u32 = 1;
/// The first bytes of every dataset.
const MAGIC: [u8; 8] = *b"sinewset";
/// Bytes before the JSON: magic, version, length of the JSON.
const FIXED: usize = 16;
/// Longest JSON, bytes.
const LONGEST: usize = 1 << 20;
/// Most arrays a sample has.
const MOST_ARRAYS: usize = 64;
/// Most floats of an array in a sample: 1 GiB.
const MOST_FLOATS: u64 = 1 << 28;

/// What the samples of a dataset are.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Header {
    /// Seed of everything random: a sample is a pure function of it and of its index.
    pub seed: u64,
    /// Number of samples the whole dataset is to have, all shards together.
    pub samples: u64,
    /// Which of them belong into this file.
    pub shard: Shard,
    /// Digest of the character, hexadecimal.
    pub character: String,
    /// What else the samples depend on: cage, material, solver, source of the poses.
    pub setting: serde_json::Value,
    /// Arrays of a sample, in the order of the chunks.
    pub arrays: Vec<ArrayInfo>,
}

/// An array of every sample.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ArrayInfo {
    /// Name, not empty.
    pub name: String,
    /// Lengths of its dimensions, the last runs fastest; a first length of 0 differs from sample to sample.
    pub shape: Vec<u64>,
    /// Unit of its numbers: `m`, `rad`, `1`.
    pub unit: String,
}

impl ArrayInfo {
    /// An array of a shape and unit.
    pub fn new(name: impl Into<String>, shape: &[u64], unit: impl Into<String>) -> Self {
        Self { name: name.into(), shape: shape.to_vec(), unit: unit.into() }
    }

    /// Floats of a row (all dimensions but a first one that differs), and whether it has any number of rows.
    fn row(&self) -> Option<(u64, bool)> {
        let open = self.shape.first() == Some(&0);
        let fixed = &self.shape[usize::from(open)..];
        let floats = fixed.iter().try_fold(1_u64, |n, d| n.checked_mul(*d))?;
        (floats > 0 && floats <= MOST_FLOATS).then_some((floats, open))
    }

    /// Whether an array may have as many floats.
    pub(super) fn allows(&self, floats: u64) -> bool {
        match self.row() {
            Some((row, true)) => floats.is_multiple_of(row) && floats <= MOST_FLOATS,
            Some((row, false)) => floats == row,
            None => false,
        }
    }
}

impl Header {
    /// The same for all shards.
    #[must_use]
    pub fn whole(&self) -> Self {
        Self { shard: Shard::WHOLE, ..self.clone() }
    }

    /// The name of the first entry in which two headers differ, shards aside.
    #[must_use]
    pub fn differs(&self, other: &Self) -> Option<&'static str> {
        [
            ("seed", self.seed != other.seed),
            ("samples", self.samples != other.samples),
            ("character", self.character != other.character),
            ("setting", self.setting != other.setting),
            ("arrays", self.arrays != other.arrays),
        ]
        .into_iter()
        .find_map(|(name, differs)| differs.then_some(name))
    }

    /// That the arrays have names of their own and possible shapes.
    fn check(&self, file: &str) -> Result<(), Error> {
        let refuse = |place: String, problem: &str, remedy: &str| {
            Err(Error::unusable(file, format!("header, {place}"), problem, remedy))
        };
        if self.arrays.is_empty() || self.arrays.len() > MOST_ARRAYS {
            return refuse("arrays".to_owned(), "none, or more than 64", "give 1 to 64 arrays");
        }
        for (i, array) in self.arrays.iter().enumerate() {
            let place = format!("array {i}");
            if array.name.is_empty() || self.arrays[..i].iter().any(|a| a.name == array.name) {
                return refuse(place, "it has no name of its own", "give every array another name");
            }
            if array.row().is_none() {
                let remedy = "only the first length may be 0; 2^28 floats are the most";
                return refuse(place, "its shape is impossible", remedy);
            }
        }
        Ok(())
    }

    /// The bytes of the head, a multiple of 8.
    ///
    /// # Errors
    ///
    /// [`Error::Unusable`] for arrays without names of their own or with impossible shapes, or more than a MiB.
    pub(super) fn to_bytes(&self, file: &str) -> Result<Vec<u8>, Error> {
        self.check(file)?;
        let too_long = || {
            Error::unusable(file, "header", "it is longer than a MiB", "describe the setting in fewer words")
        };
        let mut json = serde_json::to_vec(self).map_err(|_| too_long())?;
        json.resize(json.len().next_multiple_of(8), b' ');
        if json.len() > LONGEST {
            return Err(too_long());
        }
        let mut bytes = MAGIC.to_vec();
        bytes.extend(VERSION.to_le_bytes());
        bytes.extend(u32::try_from(json.len()).map_err(|_| too_long())?.to_le_bytes());
        bytes.extend(json);
        bytes.extend(sinew::math::digest::of_bytes(&bytes).to_le_bytes());
        Ok(bytes)
    }

    /// Reads the head of a store: it, and its length in bytes.
    ///
    /// # Errors
    ///
    /// [`Error::Unusable`] for what is no dataset, of a later version, cut or damaged.
    pub(super) fn read(file: &str, store: &mut (impl Read + Seek)) -> io::Result<Result<(Self, u64), Error>> {
        let mut fixed = [0; FIXED];
        let got = read_at(store, 0, &mut fixed)?;
        let word = |at: usize| u32::from_le_bytes([fixed[at], fixed[at + 1], fixed[at + 2], fixed[at + 3]]);
        let refuse = |place: &str, problem: &str, remedy: &str| {
            Ok(Err(Error::unusable(file, format!("header, {place}"), problem, remedy)))
        };
        let again = "make it again with `sinew simulate`";
        if got < FIXED || fixed[..8] != MAGIC {
            return refuse("byte 0", "this is no dataset", again);
        }
        if word(8) != VERSION {
            let problem = format!("version {} is not known here", word(8));
            return refuse("byte 8", &problem, "read it with the program that wrote it");
        }
        let json = word(12) as usize;
        let whole = FIXED + json + 8;
        if json > LONGEST || length(store)? < whole as u64 {
            return refuse("byte 12", "it is cut off", again);
        }
        let mut bytes = vec![0; whole];
        if read_at(store, 0, &mut bytes)? < whole {
            return refuse("byte 12", "it is cut off", again);
        }
        let (head, digest) = bytes.split_at(whole - 8);
        if digest != sinew::math::digest::of_bytes(head).to_le_bytes() {
            return refuse("JSON", "its checksum does not fit", again);
        }
        match serde_json::from_slice::<Self>(&head[FIXED..]) {
            Err(e) => refuse("JSON", &e.to_string(), again),
            Ok(header) => Ok(header.check(file).map(|()| (header, whole as u64))),
        }
    }
}
