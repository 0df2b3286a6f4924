//! A file opened: its structure, the bytes of its buffers, and how much may still be read from them.

use core::cell::Cell;
use core::fmt::Display;

use gltf::json::{Index, Root};

use super::container;
use crate::Error;

/// Remedy for files that break the format.
pub(super) const EXPORT_AGAIN: &str = "export the file again, and check it with the glTF validator";

/// Most values (vertex components, indices, keys) that are read from one file: a small file may refer to the same
/// bytes any number of times. A character of a million vertices takes half of it.
const VALUE_LIMIT: u64 = 1 << 26;

/// A glTF file with its buffers.
#[derive(Debug)]
pub(super) struct Source<'a> {
    /// Name as given, for errors.
    pub(super) file: &'a str,
    /// Structure, not validated: every index must be looked up with a check.
    pub(super) root: Root,
    /// Bytes of the buffers; `None` where the file names none.
    pub(super) buffers: Vec<Option<Vec<u8>>>,
    values_left: Cell<u64>,
}

impl<'a> Source<'a> {
    /// Takes a file apart and loads its buffers.
    pub(super) fn open(
        file: &'a str,
        bytes: &[u8],
        resolve: &mut dyn FnMut(&str) -> Result<Vec<u8>, Error>,
    ) -> Result<Self, Error> {
        let (root, binary) = container::open(file, bytes)?;
        let buffers = container::load_buffers(file, &root, binary, resolve)?;
        Ok(Self { file, root, buffers, values_left: Cell::new(VALUE_LIMIT) })
    }

    /// Takes `values` off what may be read.
    pub(super) fn charge(&self, values: u64, place: &str) -> Result<(), Error> {
        let left = self.values_left.get().checked_sub(values).ok_or_else(|| {
            self.error(place, "the file expands to more data than any character needs", "simplify its meshes")
        })?;
        self.values_left.set(left);
        Ok(())
    }

    /// An error of this file.
    pub(super) fn error(
        &self,
        place: impl Into<String>,
        problem: impl Into<String>,
        remedy: impl Into<String>,
    ) -> Error {
        Error::unusable(self.file, place, problem, remedy)
    }

    /// An error of this file that only another export can cure.
    pub(super) fn damaged(&self, place: impl Into<String>, problem: impl Into<String>) -> Error {
        self.error(place, problem, EXPORT_AGAIN)
    }

    /// The entry of a list of the file, such as `root.nodes`.
    pub(super) fn get<'s, T>(
        &self,
        list: &'s [T],
        index: Index<T>,
        what: &str,
        place: &str,
    ) -> Result<&'s T, Error> {
        list.get(index.value()).ok_or_else(|| {
            self.damaged(place, format!("there is no {what} {index}: the file has {}", list.len()))
        })
    }
}

/// `mesh 2 "Body"`: how errors name a thing of the file.
pub(super) fn label(kind: impl Display, index: usize, name: Option<&String>) -> String {
    name.filter(|n| !n.is_empty())
        .map_or_else(|| format!("{kind} {index}"), |name| format!("{kind} {index} {name:?}"))
}
