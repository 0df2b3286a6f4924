//! Where a recording goes.

use core::fmt;

/// The sink takes no more bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SinkFull;

impl SinkFull {
    /// Stable name of the error, for programs; its text may change, this does not.
    #[must_use]
    pub const fn code(&self) -> &'static str {
        "RECORD_SINK_FULL"
    }
}

impl fmt::Display for SinkFull {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "no room left for the recording")
    }
}

impl core::error::Error for SinkFull {}

/// Takes the bytes of a recording, in order.
pub trait Sink {
    /// Appends `bytes`.
    ///
    /// # Errors
    ///
    /// [`SinkFull`] where there is no room for all of them.
    fn write(&mut self, bytes: &[u8]) -> Result<(), SinkFull>;
}

impl<S: Sink + ?Sized> Sink for &mut S {
    fn write(&mut self, bytes: &[u8]) -> Result<(), SinkFull> {
        (**self).write(bytes)
    }
}

/// A sink in memory of fixed length.
#[derive(Debug)]
pub struct Cursor<'a> {
    buffer: &'a mut [u8],
    len: usize,
}

impl<'a> Cursor<'a> {
    /// An empty recording in `buffer`.
    #[must_use]
    pub fn new(buffer: &'a mut [u8]) -> Self {
        Self { buffer, len: 0 }
    }

    /// What was written.
    #[must_use]
    pub fn bytes(&self) -> &[u8] {
        self.buffer.get(..self.len).unwrap_or_default()
    }
}

impl Sink for Cursor<'_> {
    fn write(&mut self, bytes: &[u8]) -> Result<(), SinkFull> {
        let end = self.len.saturating_add(bytes.len());
        self.buffer.get_mut(self.len..end).ok_or(SinkFull)?.copy_from_slice(bytes);
        self.len = end;
        Ok(())
    }
}

#[cfg(feature = "std")]
mod growing {
    extern crate std;
    use super::{Sink, SinkFull};
    use std::vec::Vec;

    impl Sink for Vec<u8> {
        fn write(&mut self, bytes: &[u8]) -> Result<(), SinkFull> {
            self.try_reserve(bytes.len()).map_err(|_| SinkFull)?;
            self.extend_from_slice(bytes);
            Ok(())
        }
    }
}
