//! `NumPy` arrays: float32, frames × vertices × 3, written frame by frame.

use std::io::{self, Write};

/// Writes the header of a `.npy` file (format 1.0) for an array of `frames × vertices × 3`.
///
/// # Errors
///
/// Those of the writer.
pub fn header(out: &mut impl Write, frames: u32, vertices: usize) -> io::Result<()> {
    let mut text =
        format!("{{'descr': '<f4', 'fortran_order': False, 'shape': ({frames}, {vertices}, 3), }}");
    let length = (10 + text.len() + 1).next_multiple_of(64);
    text.extend(core::iter::repeat_n(' ', length - 10 - text.len() - 1));
    text.push('\n');
    out.write_all(b"\x93NUMPY\x01\x00")?;
    let length = u16::try_from(text.len()).map_err(|_| io::Error::from(io::ErrorKind::InvalidInput))?;
    out.write_all(&length.to_le_bytes())?;
    out.write_all(text.as_bytes())
}

/// Writes a frame.
///
/// # Errors
///
/// Those of the writer.
pub fn frame(out: &mut impl Write, positions: &[[f32; 3]]) -> io::Result<()> {
    for x in positions.as_flattened() {
        out.write_all(&x.to_le_bytes())?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    #[test]
    fn data_starts_on_a_multiple_of_64() {
        for (frames, vertices) in [(1, 1), (600, 123_456), (3_600_000, 9)] {
            let mut out = Vec::new();
            super::header(&mut out, frames, vertices).unwrap();
            assert_eq!(out.len() % 64, 0);
            assert_eq!(usize::from(u16::from_le_bytes([out[8], out[9]])), out.len() - 10);
            assert_eq!(out.last(), Some(&b'\n'));
        }
    }
}
