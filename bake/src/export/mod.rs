//! Files out: characters, animated meshes and arrays, written whole or not at all.

#[cfg(feature = "simulate")]
pub mod cage;
pub mod glb;
pub mod morph;
pub mod npy;

use crate::Error;
use std::ffi::OsString;
use std::fs::{self, File, OpenOptions};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

/// Writes a file so that it is either complete or untouched.
///
/// The content goes to a temporary file in the same folder, is flushed to the disk and takes the name of `path`
/// last; when something fails on the way the temporary file is removed and whatever was at `path` remains. A
/// symbolic link is followed; what is not a file (such as `/dev/stdout`) is written to directly.
///
/// `write` may return any error that turns into an [`io::Error`]; an [`Error`] inside comes out as it is.
///
/// # Errors
///
/// [`Error::Write`] with `path`; or the [`Error`] that `write` returned.
pub fn write_atomic<T>(
    path: &Path,
    write: impl FnOnce(&mut BufWriter<File>) -> io::Result<T>,
) -> Result<T, Error> {
    try_write(path, write).map_err(|source| match source.downcast::<Error>() {
        Ok(error) => error,
        Err(source) => Error::Write { path: path.to_owned(), source },
    })
}

/// [`write_atomic`] for bytes at hand.
///
/// # Errors
///
/// [`Error::Write`] with `path`.
pub fn write_bytes(path: &Path, bytes: &[u8]) -> Result<(), Error> {
    write_atomic(path, |out| out.write_all(bytes))
}

fn try_write<T>(path: &Path, write: impl FnOnce(&mut BufWriter<File>) -> io::Result<T>) -> io::Result<T> {
    let target = fs::canonicalize(path).unwrap_or_else(|_| path.to_owned());
    match fs::metadata(&target) {
        Ok(known) if known.is_dir() => return Err(io::ErrorKind::IsADirectory.into()),
        Ok(known) if !known.is_file() => {
            return fill(OpenOptions::new().write(true).open(&target)?, false, write);
        }
        _ => {}
    }
    let (file, temporary) = create_beside(&target)?;
    let written = fill(file, true, write).and_then(|value| {
        fs::rename(&temporary, &target)?;
        Ok(value)
    });
    if written.is_err() {
        // The first error is the one to tell.
        let _ = fs::remove_file(&temporary);
    }
    written
}

/// A new file in the folder of `target`, with a name that nobody has.
fn create_beside(target: &Path) -> io::Result<(File, PathBuf)> {
    let name = target.file_name().ok_or(io::ErrorKind::InvalidFilename)?;
    for attempt in 0..100_u32 {
        let mut hidden = OsString::from(".");
        hidden.push(name);
        hidden.push(format!(".{}-{attempt}.tmp", std::process::id()));
        let path = target.with_file_name(hidden);
        match OpenOptions::new().write(true).create_new(true).open(&path) {
            Err(e) if e.kind() == io::ErrorKind::AlreadyExists => {}
            Err(e) => return Err(e),
            Ok(file) => return Ok((file, path)),
        }
    }
    Err(io::ErrorKind::AlreadyExists.into())
}

fn fill<T>(
    file: File,
    sync: bool,
    write: impl FnOnce(&mut BufWriter<File>) -> io::Result<T>,
) -> io::Result<T> {
    let mut writer = BufWriter::new(file);
    let value = write(&mut writer)?;
    writer.flush()?;
    if sync {
        writer.get_ref().sync_all()?;
    }
    Ok(value)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A folder of its own for a test, removed at the end.
    pub(super) struct Folder(pub(super) PathBuf);

    impl Folder {
        pub(super) fn new(name: &str) -> Self {
            let path = std::env::temp_dir().join(format!("sinew-{name}-{}", std::process::id()));
            fs::create_dir_all(&path).expect("a temporary folder");
            Self(path)
        }

        fn names(&self) -> Vec<OsString> {
            fs::read_dir(&self.0).expect("the folder").map(|e| e.expect("an entry").file_name()).collect()
        }
    }

    impl Drop for Folder {
        fn drop(&mut self) {
            let _ = fs::remove_dir_all(&self.0);
        }
    }

    #[test]
    fn a_file_is_replaced_whole_or_left_alone() {
        let folder = Folder::new("replace");
        let path = folder.0.join("out.bin");
        write_atomic(&path, |w| w.write_all(b"first")).expect("a writable folder");
        let broken = write_atomic(&path, |w| {
            w.write_all(&[7; 100_000])?;
            Err::<(), _>(io::Error::other("disk full"))
        });
        let message = broken.expect_err("the writer failed").to_string();
        assert!(message.contains("out.bin") && message.contains("disk full"), "{message}");
        assert_eq!(fs::read(&path).expect("the first file"), b"first");
        write_atomic(&path, |w| w.write_all(b"second")).expect("a writable folder");
        assert_eq!(fs::read(&path).expect("the second file"), b"second");
        assert_eq!(folder.names(), ["out.bin"], "no temporary file is left");
    }

    #[test]
    fn unwritable_places_are_named() {
        let folder = Folder::new("unwritable");
        for path in [folder.0.join("missing/out.bin"), folder.0.clone(), PathBuf::from("/")] {
            let error = write_atomic(&path, |w| w.write_all(b"x")).expect_err("no place for a file");
            assert!(error.to_string().starts_with(&path.display().to_string()), "{error}");
        }
        assert!(folder.names().is_empty(), "nothing is left");
    }

    #[test]
    fn an_error_of_the_baker_inside_the_writer_comes_out_as_it_is() {
        let folder = Folder::new("inside");
        let inner = || Error::unusable("fox.glb", "frame 3", "is missing", "bake again");
        let result = write_atomic(&folder.0.join("a"), |_| Err::<(), _>(io::Error::other(inner())));
        assert_eq!(result.expect_err("failed").to_string(), inner().to_string());
    }

    #[cfg(unix)]
    #[test]
    fn links_are_followed_and_devices_written_to() {
        let folder = Folder::new("links");
        let (target, link) = (folder.0.join("target"), folder.0.join("link"));
        fs::write(&target, b"old").expect("a file");
        std::os::unix::fs::symlink(&target, &link).expect("a link");
        write_atomic(&link, |w| w.write_all(b"new")).expect("a writable folder");
        assert_eq!(fs::read(&target).expect("the target"), b"new");
        assert!(fs::symlink_metadata(&link).expect("the link").is_symlink(), "the link remains");
        write_atomic(Path::new("/dev/null"), |w| w.write_all(b"x")).expect("a device");
        let full = Path::new("/dev/full");
        if full.exists() {
            let error = write_atomic(full, |w| w.write_all(&[0; 100])).expect_err("a full disk");
            assert!(error.to_string().contains("/dev/full"), "{error}");
        }
    }
}
