//! Appending samples, and going on where a run was cut short.

use super::chunk::{self, Place};
use super::header::Header;
use super::store::{Store, length, read_at};
use crate::Error;
use std::collections::BTreeSet;
use std::fs::{File, OpenOptions, TryLockError};
use std::io::{self, SeekFrom};
use std::path::{Path, PathBuf};

/// An array of a sample.
#[derive(Clone, Copy, Debug)]
pub struct Array<'a> {
    /// Its name in the header.
    pub name: &'a str,
    /// Its numbers, finite, the last dimension runs fastest.
    pub values: &'a [f32],
}

/// What was found when a file was opened.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Resumed {
    /// Samples that were there.
    pub kept: usize,
    /// Bytes of a sample that was not finished, which were cut off.
    pub cut: u64,
}

/// Writes the samples of one shard.
///
/// ```
/// use sinew_bake::dataset::{Array, ArrayInfo, Header, Reader, Shard, Writer};
/// # let path = std::env::temp_dir().join(format!("sinew-dataset-{}", std::process::id()));
/// let header = Header {
///     seed: 1,
///     samples: 3,
///     shard: Shard::WHOLE,
///     character: "0f".to_owned(),
///     setting: serde_json::json!({"cage": "voxels of 0.05"}),
///     arrays: vec![ArrayInfo::new("displacement", &[2, 3], "m")],
/// };
/// let mut writer = Writer::open(&path, &header)?;
/// for i in header.shard.indices(header.samples) {
///     if !writer.has(i) {
///         writer.append(i, &[Array { name: "displacement", values: &[i as f32; 6] }])?;
///     }
/// }
/// writer.sync()?;
/// drop(writer);
/// let mut reader = Reader::open(&[&path])?;
/// assert_eq!(reader.sample(2)?.arrays[0], [2.0; 6]);
/// # std::fs::remove_file(&path).unwrap();
/// # Ok::<(), sinew_bake::Error>(())
/// ```
#[derive(Debug)]
pub struct Writer<S = File> {
    path: PathBuf,
    header: Header,
    store: S,
    /// Length of what is whole; whatever is behind it counts for nothing.
    end: u64,
    /// Whether there may be something behind it.
    torn: bool,
    indices: BTreeSet<u64>,
    resumed: Resumed,
    chunk: Vec<u8>,
}

impl Writer {
    /// Opens a file for the samples that `header` describes; makes it where there is none, else goes on with it.
    ///
    /// # Errors
    ///
    /// [`Error::Write`]; [`Error::Unusable`] for a header that cannot be, a file with other samples, one that is
    /// damaged in its middle, or one that another process writes.
    pub fn open(path: &Path, header: &Header) -> Result<Self, Error> {
        let failed = |source| Error::Write { path: path.to_owned(), source };
        let file = OpenOptions::new()
            .read(true)
            .write(true)
            .create(true)
            .truncate(false)
            .open(path)
            .map_err(failed)?;
        match file.try_lock() {
            Ok(()) => Self::resume(path, file, header),
            Err(TryLockError::WouldBlock) => Err(Error::unusable(
                path.display().to_string(),
                "lock",
                "another process writes this file",
                "wait for it, or give each process a shard of its own",
            )),
            // Some file systems of clusters know no locks.
            Err(TryLockError::Error(e)) if e.kind() == io::ErrorKind::Unsupported => {
                Self::resume(path, file, header)
            }
            Err(TryLockError::Error(e)) => Err(failed(e)),
        }
    }
}

impl<S: Store> Writer<S> {
    /// [`Writer::open`] on any store; `path` is for errors.
    ///
    /// # Errors
    ///
    /// As there.
    pub fn resume(path: &Path, mut store: S, header: &Header) -> Result<Self, Error> {
        let failed = |source| Error::Write { path: path.to_owned(), source };
        let name = path.display().to_string();
        let head = header.to_bytes(&name)?;
        let mut before = vec![0; head.len()];
        let size = read_at(&mut store, 0, &mut before).map_err(failed)?;
        let mut writer = Self {
            path: path.to_owned(),
            header: header.clone(),
            store,
            end: 0,
            torn: size > 0,
            indices: BTreeSet::new(),
            resumed: Resumed { kept: 0, cut: 0 },
            chunk: Vec::new(),
        };
        // The beginning of this very head is what a process leaves that is killed at once.
        if size < head.len() && head.starts_with(&before[..size]) {
            writer.resumed.cut = size as u64;
            writer.write(&head)?;
            return Ok(writer);
        }
        if before != head {
            return Err(writer.other(&name)?);
        }
        writer.end = head.len() as u64;
        writer.scan(&name)?;
        Ok(writer)
    }

    #[cfg(test)]
    pub(super) fn store_mut(&mut self) -> &mut S {
        &mut self.store
    }

    fn failed(&self, source: io::Error) -> Error {
        Error::Write { path: self.path.clone(), source }
    }

    /// The error for a file that holds something else.
    fn other(&mut self, name: &str) -> Result<Error, Error> {
        let read = Header::read(name, &mut self.store).map_err(|e| self.failed(e))?;
        Ok(match read {
            Err(error) => error,
            Ok((found, _)) => {
                let what = match found.differs(&self.header) {
                    Some(entry) => format!("its `{entry}` is not that of these samples"),
                    None => format!("it holds shard {}, not {}", found.shard, self.header.shard),
                };
                Error::unusable(name, "header", what, "write to another file, or remove this one")
            }
        })
    }

    /// Finds whole chunks, and cuts off the rest.
    fn scan(&mut self, name: &str) -> Result<(), Error> {
        let size = length(&mut self.store).map_err(|e| self.failed(e))?;
        while let Some(place) = self.chunk_at(self.end, size)? {
            if !chunk::is_whole(&mut self.store, &place).map_err(|e| self.failed(e))? {
                break;
            }
            if !self.indices.insert(place.index) {
                let at = format!("byte {}, sample {}", place.start, place.index);
                return Err(Error::unusable(name, at, "it is there twice", "make the file again"));
            }
            self.end = place.end();
        }
        // A process that is killed leaves nothing behind what it was writing.
        let later = chunk::search(&mut self.store, &self.header, self.end + 8, size);
        if let Some(later) = later.map_err(|e| self.failed(e))? {
            let problem = format!("it is damaged, but sample {} behind it is not", later.index);
            let remedy = "what is on the disk has changed: copy the file back, or make it again";
            return Err(Error::unusable(name, format!("byte {}", self.end), problem, remedy));
        }
        self.resumed = Resumed { kept: self.indices.len(), cut: size - self.end };
        if self.resumed.cut > 0 {
            self.store.cut(self.end).map_err(|e| self.failed(e))?;
        }
        self.torn = false;
        Ok(())
    }

    fn chunk_at(&mut self, start: u64, size: u64) -> Result<Option<Place>, Error> {
        chunk::at(&mut self.store, &self.header, start, size).map_err(|e| self.failed(e))
    }

    /// Writes bytes behind what is whole, all or none.
    fn write(&mut self, bytes: &[u8]) -> Result<(), Error> {
        let written = self.try_write(bytes);
        if written.is_err() {
            // A disk that is full may refuse this too; then the next write or run does it.
            self.torn = self.store.cut(self.end).is_err();
        }
        written.map_err(|e| self.failed(e))
    }

    fn try_write(&mut self, bytes: &[u8]) -> io::Result<()> {
        if self.torn {
            self.store.cut(self.end)?;
            self.torn = false;
        }
        self.store.seek(SeekFrom::Start(self.end))?;
        self.store.write_all(bytes)?;
        self.end += bytes.len() as u64;
        Ok(())
    }

    /// What was found in the file.
    #[must_use]
    pub fn resumed(&self) -> Resumed {
        self.resumed
    }

    /// Whether a sample is written already.
    #[must_use]
    pub fn has(&self, index: u64) -> bool {
        self.indices.contains(&index)
    }

    /// Number of samples in the file.
    #[must_use]
    pub fn len(&self) -> usize {
        self.indices.len()
    }

    /// Whether there are none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.indices.is_empty()
    }

    /// Writes a sample; its arrays are those of the header, in its order.
    ///
    /// # Errors
    ///
    /// [`Error::Write`], after which the file is as it was and the sample may be tried again; [`Error::Unusable`] for a
    /// sample that is there already or in another shard, for other arrays than the header's, and for numbers that are
    /// not finite.
    pub fn append(&mut self, index: u64, arrays: &[Array<'_>]) -> Result<(), Error> {
        if let Some((place, problem, remedy)) = self.misfit(index, arrays) {
            let place = format!("sample {index}{place}");
            return Err(Error::unusable(self.path.display().to_string(), place, problem, remedy));
        }
        let values: Vec<&[f32]> = arrays.iter().map(|a| a.values).collect();
        let mut bytes = core::mem::take(&mut self.chunk);
        chunk::encode(index, &values, &mut bytes);
        let written = self.write(&bytes);
        self.chunk = bytes;
        written?;
        self.indices.insert(index);
        Ok(())
    }

    /// Why a sample cannot be taken: place, problem, remedy.
    fn misfit(&self, index: u64, arrays: &[Array<'_>]) -> Option<(String, String, &'static str)> {
        let header = &self.header;
        if !header.shard.contains(index) || index >= header.samples {
            let problem = format!("it is not in shard {} of {} samples", header.shard, header.samples);
            return Some((String::new(), problem, "give each shard its own samples"));
        }
        if self.has(index) {
            return Some((String::new(), "it is there already".to_owned(), "ask `has` first"));
        }
        let names = |i: &[&str]| i.join(", ");
        let (given, wanted): (Vec<&str>, Vec<&str>) = (
            arrays.iter().map(|a| a.name).collect(),
            header.arrays.iter().map(|a| a.name.as_str()).collect(),
        );
        if given != wanted {
            let problem = format!("its arrays are {}; the header's {}", names(&given), names(&wanted));
            return Some((String::new(), problem, "give the header's arrays in its order"));
        }
        for (array, info) in arrays.iter().zip(&header.arrays) {
            let place = format!(", array {}", info.name);
            if !info.allows(array.values.len() as u64) {
                let problem = format!("it has {} floats, its shape is {:?}", array.values.len(), info.shape);
                return Some((place, problem, "give as many as the header says"));
            }
            if let Some(at) = array.values.iter().position(|x| !x.is_finite()) {
                let problem = format!("number {at} is {}", array.values[at]);
                return Some((place, problem, "leave out samples that did not converge"));
            }
        }
        None
    }

    /// Brings all samples to the disk: before it, a loss of power may take more than one of them.
    ///
    /// # Errors
    ///
    /// [`Error::Write`].
    pub fn sync(&mut self) -> Result<(), Error> {
        self.store.sync().map_err(|e| self.failed(e))
    }
}
