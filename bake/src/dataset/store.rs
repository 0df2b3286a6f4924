//! What a dataset is written to: a file, or memory that fails when a test wants it to.

use std::fs::File;
use std::io::{self, Read, Seek, SeekFrom, Write};

/// A file, as far as datasets need one.
pub trait Store: Read + Write + Seek {
    /// Cuts it to `length` bytes.
    ///
    /// # Errors
    ///
    /// The store's.
    fn cut(&mut self, length: u64) -> io::Result<()>;

    /// Brings what was written to the disk.
    ///
    /// # Errors
    ///
    /// The store's.
    fn sync(&mut self) -> io::Result<()>;
}

impl Store for File {
    fn cut(&mut self, length: u64) -> io::Result<()> {
        self.set_len(length)
    }

    fn sync(&mut self) -> io::Result<()> {
        self.sync_data()
    }
}

/// Fills as much of `buffer` as there is from `offset` on; how much that was.
pub(super) fn read_at(store: &mut (impl Read + Seek), offset: u64, buffer: &mut [u8]) -> io::Result<usize> {
    store.seek(SeekFrom::Start(offset))?;
    let mut filled = 0;
    while filled < buffer.len() {
        match store.read(&mut buffer[filled..]) {
            Ok(0) => break,
            Ok(n) => filled += n,
            Err(e) if e.kind() == io::ErrorKind::Interrupted => {}
            Err(e) => return Err(e),
        }
    }
    Ok(filled)
}

/// Number of bytes in it.
pub(super) fn length(store: &mut impl Seek) -> io::Result<u64> {
    store.seek(SeekFrom::End(0))
}
