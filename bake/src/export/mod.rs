//! Files out: whole or not at all.

pub mod glb;
pub mod morph;
pub mod npy;

use crate::Error;
use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

/// Writes a file by way of a temporary one in the same folder, renamed at the end.
///
/// # Errors
///
/// [`Error::Write`] naming `path`; nothing of the new file is left then, and an old one is untouched.
pub fn write_atomic(
    path: &Path,
    write: impl FnOnce(&mut BufWriter<File>) -> io::Result<()>,
) -> Result<(), Error> {
    let temporary = temporary(path);
    let attempt = || {
        let mut out = BufWriter::new(File::create(&temporary)?);
        write(&mut out)?;
        let file = out.into_inner().map_err(io::IntoInnerError::into_error)?;
        file.sync_all()?;
        fs::rename(&temporary, path)
    };
    attempt().map_err(|source| {
        drop(fs::remove_file(&temporary)); // it may not exist: the first error is what counts
        Error::Write { path: path.to_owned(), source }
    })
}

/// [`write_atomic`] for bytes at hand.
///
/// # Errors
///
/// As [`write_atomic`].
pub fn write_bytes(path: &Path, bytes: &[u8]) -> Result<(), Error> {
    write_atomic(path, |out| out.write_all(bytes))
}

fn temporary(path: &Path) -> PathBuf {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    path.with_file_name(format!(".{name}.{}.part", std::process::id()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_failure_leaves_the_old_file_and_nothing_else() {
        let folder = std::env::temp_dir().join(format!("sinew-export-{}", std::process::id()));
        fs::create_dir_all(&folder).unwrap();
        let path = folder.join("x.bin");
        write_bytes(&path, b"old").unwrap();
        let full = |out: &mut BufWriter<File>| {
            out.write_all(b"half")?;
            Err(io::Error::from(io::ErrorKind::StorageFull))
        };
        let error = write_atomic(&path, full).unwrap_err().to_string();
        assert!(error.contains("x.bin"), "{error}");
        assert_eq!(fs::read(&path).unwrap(), b"old");
        assert_eq!(fs::read_dir(&folder).unwrap().count(), 1);
        let missing = folder.join("no/such/folder/x.bin");
        assert!(matches!(write_bytes(&missing, b""), Err(Error::Write { .. })));
        fs::remove_dir_all(&folder).unwrap();
    }
}
