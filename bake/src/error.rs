//! Why a file cannot be used: one line that names the file, the place and the remedy.

use std::path::PathBuf;

/// Unusable input or output.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A file cannot be read.
    #[error("{}: cannot be read: {source}", path.display())]
    Read {
        /// File.
        path: PathBuf,
        /// Reason.
        source: std::io::Error,
    },
    /// A file cannot be written; nothing is left of it.
    #[error("{}: cannot be written: {source}", path.display())]
    Write {
        /// File.
        path: PathBuf,
        /// Reason.
        source: std::io::Error,
    },
    /// A file's content is not usable.
    #[error("{file}: {place}: {problem}; {remedy}")]
    Unusable {
        /// File name as given.
        file: String,
        /// Where in the file: `mesh 2, primitive 0, vertex 17`.
        place: String,
        /// What is wrong.
        problem: String,
        /// What to do about it.
        remedy: String,
        /// Code of the runtime's error behind it, or [`Error::UNUSABLE`].
        code: &'static str,
    },
}

impl Error {
    /// Code of a file whose content is not usable, where the runtime has no closer one.
    pub const UNUSABLE: &'static str = "INPUT_UNUSABLE";

    /// An [`Error::Unusable`].
    pub fn unusable(
        file: impl Into<String>,
        place: impl Into<String>,
        problem: impl Into<String>,
        remedy: impl Into<String>,
    ) -> Self {
        Self::Unusable {
            file: file.into(),
            place: place.into(),
            problem: problem.into(),
            remedy: remedy.into(),
            code: Self::UNUSABLE,
        }
    }

    /// The same error with the code of the runtime's error behind it.
    #[must_use]
    pub fn coded(self, cause: &'static str) -> Self {
        match self {
            Self::Unusable { file, place, problem, remedy, .. } => {
                Self::Unusable { file, place, problem, remedy, code: cause }
            }
            other => other,
        }
    }

    /// Stable name of the error, for programs; its text may change, this does not.
    #[must_use]
    pub const fn code(&self) -> &'static str {
        match self {
            Self::Read { .. } => "FILE_UNREADABLE",
            Self::Write { .. } => "FILE_UNWRITABLE",
            Self::Unusable { code, .. } => code,
        }
    }
}
