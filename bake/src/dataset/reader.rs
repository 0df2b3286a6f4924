//! Several shards, walked as one dataset.

use super::chunk::{self, Place};
use super::header::Header;
use super::store::length;
use super::{Array, Writer};
use crate::Error;
use core::ops::Range;
use std::collections::BTreeMap;
use std::fs::File;
use std::io::{self, Read, Seek};
use std::path::{Path, PathBuf};

/// A sample.
#[derive(Clone, Debug, PartialEq)]
pub struct Sample {
    /// Its index.
    pub index: u64,
    /// Its arrays, in the order of the header.
    pub arrays: Vec<Vec<f32>>,
}

/// Reads one dataset from the files of its shards; see [`Writer`] for an example.
#[derive(Debug)]
pub struct Reader<S = File> {
    header: Header,
    files: Vec<(PathBuf, S)>,
    /// File and place of each sample.
    places: BTreeMap<u64, (usize, Place)>,
    torn: Vec<(PathBuf, u64)>,
}

impl Reader {
    /// Opens files of one dataset, in any order.
    ///
    /// # Errors
    ///
    /// [`Error::Read`]; [`Error::Unusable`] for no files, for what is no dataset, for headers that are not of one dataset
    /// and for a sample that is there twice.
    pub fn open<P: AsRef<Path>>(paths: &[P]) -> Result<Self, Error> {
        let open = |path: &P| {
            let path = path.as_ref().to_owned();
            match File::open(&path) {
                Ok(file) => Ok((path, file)),
                Err(source) => Err(Error::Read { path, source }),
            }
        };
        Self::over(paths.iter().map(open).collect::<Result<_, _>>()?)
    }
}

impl<S: Read + Seek> Reader<S> {
    /// [`Reader::open`] on anything that can be read; paths are for errors.
    ///
    /// # Errors
    ///
    /// As there.
    pub fn over(mut files: Vec<(PathBuf, S)>) -> Result<Self, Error> {
        let (mut header, mut torn) = (None, Vec::new());
        let mut places = BTreeMap::new();
        for (number, (path, store)) in files.iter_mut().enumerate() {
            let failed = |source| Error::Read { path: path.clone(), source };
            let name = path.display().to_string();
            let (found, start) = Header::read(&name, store).map_err(failed)??;
            let first = header.get_or_insert_with(|| found.whole());
            if let Some(entry) = found.differs(first) {
                let problem = format!("its `{entry}` is not that of the first file");
                let remedy = "give the shards of one dataset";
                return Err(Error::unusable(name, "header", problem, remedy));
            }
            let (found, rest) = walk(store, &found, start).map_err(failed)?;
            torn.extend((rest > 0).then(|| (path.clone(), rest)));
            for place in found {
                let at = format!("byte {}, sample {}", place.start, place.index);
                if places.insert(place.index, (number, place)).is_some() {
                    let problem = "it is there twice, here or in a file before";
                    return Err(Error::unusable(name, at, problem, "give every shard once"));
                }
            }
        }
        let header = header.ok_or_else(|| {
            Error::unusable("dataset", "files", "there are none", "give the files of all shards")
        })?;
        Ok(Self { header, files, places, torn })
    }

    /// What the samples are; its shard is the whole.
    #[must_use]
    pub fn header(&self) -> &Header {
        &self.header
    }

    /// Number of samples there are.
    #[must_use]
    pub fn len(&self) -> usize {
        self.places.len()
    }

    /// Whether there are none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.places.is_empty()
    }

    /// Indices of the samples there are, ascending.
    pub fn indices(&self) -> impl Iterator<Item = u64> + '_ {
        self.places.keys().copied()
    }

    /// Samples that the header promises and that are in no file, as ranges, ascending.
    #[must_use]
    pub fn missing(&self) -> Vec<Range<u64>> {
        let mut ranges = Vec::new();
        let mut next = 0;
        for index in self.indices().chain([self.header.samples]) {
            if next < index {
                ranges.push(next..index);
            }
            next = index + 1;
        }
        ranges
    }

    /// Files with bytes behind their last sample, and how many: what a run left that was cut short or is not done.
    #[must_use]
    pub fn torn(&self) -> &[(PathBuf, u64)] {
        &self.torn
    }

    /// A sample.
    ///
    /// # Errors
    ///
    /// [`Error::Read`]; [`Error::Unusable`] for a sample that is not there, or whose checksum does not fit.
    pub fn sample(&mut self, index: u64) -> Result<Sample, Error> {
        let place = format!("sample {index}");
        let Some((number, at)) = self.places.get(&index) else {
            let problem = "it is in none of the files";
            return Err(Error::unusable("dataset", place, problem, "make it, or give the file of its shard"));
        };
        let (path, store) = &mut self.files[*number];
        let arrays = chunk::decode(store, at).map_err(|source| Error::Read { path: path.clone(), source })?;
        let arrays = arrays.ok_or_else(|| {
            let (place, problem) = (format!("byte {}, {place}", at.start), "its checksum does not fit");
            Error::unusable(
                path.display().to_string(),
                place,
                problem,
                "run the shard again, or copy it back",
            )
        })?;
        Ok(Sample { index, arrays })
    }
}

/// Places of the chunks of a file, and how many bytes behind them are none. Only the last chunk's checksum is read:
/// it alone may be half written, and [`Reader::sample`] reads the others'.
fn walk(store: &mut (impl Read + Seek), header: &Header, start: u64) -> io::Result<(Vec<Place>, u64)> {
    let size = length(store)?;
    let (mut places, mut end) = (Vec::new(), start);
    while let Some(place) = chunk::at(store, header, end, size)? {
        end = place.end();
        places.push(place);
    }
    if let Some(last) = places.last()
        && !chunk::is_whole(store, last)?
    {
        end = last.start;
        places.pop();
    }
    Ok((places, size - end))
}

/// Writes all samples of `reader` that `path` does not have yet into that one file, ascending; their number.
///
/// # Errors
///
/// Those of [`Reader::sample`] and [`Writer`].
pub fn merge<S: Read + Seek>(reader: &mut Reader<S>, path: &Path) -> Result<usize, Error> {
    let header = reader.header.clone();
    let mut writer = Writer::open(path, &header)?;
    let indices: Vec<u64> = reader.indices().filter(|i| !writer.has(*i)).collect();
    for index in &indices {
        let sample = reader.sample(*index)?;
        let named = header.arrays.iter().zip(&sample.arrays);
        let arrays: Vec<Array<'_>> = named.map(|(info, values)| Array { name: &info.name, values }).collect();
        writer.append(*index, &arrays)?;
    }
    writer.sync()?;
    Ok(indices.len())
}
