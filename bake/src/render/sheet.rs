//! Contact sheets: moments of a motion as columns, ways of looking as rows.

use super::label;
use crate::Error;
use std::io::Cursor;

/// Joins pictures of `width × height` pixels (RGB) to a sheet as PNG: one row a label, one column a moment.
///
/// # Errors
///
/// [`Error::Unusable`] when the encoder refuses the size.
pub fn contact_sheet(
    title: &str,
    labels: &[&str],
    rows: &[Vec<Vec<u8>>],
    (width, height): (usize, usize),
) -> Result<Vec<u8>, Error> {
    let columns = rows.iter().map(Vec::len).max().unwrap_or(0);
    let head = label::LINE + 12;
    let (w, h) = (columns * width, head + rows.len() * height);
    let mut out = vec![246_u8; w * h * 3];
    label::write(&mut out, w, (12, 7), title);
    for (r, row) in rows.iter().enumerate() {
        for (c, picture) in row.iter().enumerate() {
            for y in 0..height {
                let to = ((head + r * height + y) * w + c * width) * 3;
                out[to..to + width * 3].copy_from_slice(&picture[y * width * 3..(y + 1) * width * 3]);
            }
        }
        if let Some(text) = labels.get(r) {
            label::write(&mut out, w, (12, head + r * height + 8), text);
        }
    }
    png(&out, w, h)
}

/// RGB to PNG.
///
/// # Errors
///
/// As [`contact_sheet`].
pub fn png(rgb: &[u8], width: usize, height: usize) -> Result<Vec<u8>, Error> {
    let size = |n: usize| u32::try_from(n).unwrap_or(u32::MAX);
    let image = image::RgbImage::from_raw(size(width), size(height), rgb.to_vec());
    let mut out = Cursor::new(Vec::new());
    let written = image.map(|i| i.write_to(&mut out, image::ImageFormat::Png));
    match written {
        Some(Ok(())) => Ok(out.into_inner()),
        _ => Err(Error::unusable("picture", "PNG", "the encoder refuses it", "choose fewer frames")),
    }
}
