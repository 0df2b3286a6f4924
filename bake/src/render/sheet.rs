//! Contact sheets: rows of frames with labels.

use super::color::heat;
use super::text::{LABEL, NOTE, TITLE, blend};
use crate::{Error, export};
use image::codecs::png::{CompressionType, FilterType, PngEncoder};
use image::{ExtendedColorType, ImageEncoder, Rgb, RgbImage, imageops};
use std::io;
use std::path::Path;

const PAPER: [u8; 3] = [250, 250, 251];
const INK: [u8; 3] = [32, 36, 44];
const PALE_INK: [u8; 3] = [104, 112, 124];
/// Space between cells, px.
const GAP: u32 = 6;
/// Space around everything, px.
const MARGIN: u32 = 24;

/// Frames to put on one picture.
#[derive(Clone, Debug, Default)]
pub struct Sheet {
    /// Heading.
    pub title: String,
    /// What is shown: clip, length, counts.
    pub note: String,
    /// One a column: the time.
    pub columns: Vec<String>,
    /// Rows from the top.
    pub rows: Vec<Row>,
    /// What the colors of a heat map mean.
    pub legend: Option<Legend>,
}

/// A row of frames.
#[derive(Clone, Debug, Default)]
pub struct Row {
    /// What is drawn in this row.
    pub label: String,
    /// Frames, all of one size.
    pub cells: Vec<RgbImage>,
}

/// What the colors of a heat map mean.
#[derive(Clone, Debug, Default)]
pub struct Legend {
    /// Quantity, such as `offset, % of body size`.
    pub caption: String,
    /// Labels from the cold end to the hot, evenly spread.
    pub ticks: Vec<String>,
}

/// Puts frames on one picture.
#[must_use]
pub fn contact_sheet(sheet: &Sheet) -> RgbImage {
    let cells = || sheet.rows.iter().flat_map(|r| &r.cells);
    let cell = [cells().map(RgbImage::width).max(), cells().map(RgbImage::height).max()]
        .map(Option::unwrap_or_default);
    let count = |n: usize| u32::try_from(n).unwrap_or(u32::MAX);
    let columns = count(sheet.rows.iter().map(|r| r.cells.len()).max().unwrap_or(0)).max(1);
    let top = MARGIN + TITLE.height() + 12 + if sheet.columns.is_empty() { 0 } else { NOTE.height() + 8 };
    let bottom = if sheet.legend.is_some() { 64 } else { MARGIN };
    let width = 2 * MARGIN + columns * (cell[0] + GAP) - GAP;
    let rows = count(sheet.rows.len());
    let mut page = RgbImage::from_pixel(width, top + rows * (cell[1] + GAP) + bottom, Rgb(PAPER));

    let title = TITLE.fit(&sheet.title, width - 2 * MARGIN);
    TITLE.write(&mut page, [MARGIN, MARGIN - 6], &title, INK);
    let left = MARGIN + TITLE.width(&title) + 24;
    let note = NOTE.fit(&sheet.note, (width - MARGIN).saturating_sub(left));
    NOTE.write(&mut page, [width - MARGIN - NOTE.width(&note), MARGIN + 5], &note, PALE_INK);
    for (i, label) in (0..columns).zip(&sheet.columns) {
        let label = NOTE.fit(label, cell[0]);
        let middle = MARGIN + i * (cell[0] + GAP) + (cell[0] - NOTE.width(&label)) / 2;
        NOTE.write(&mut page, [middle, top - NOTE.height() - 6], &label, PALE_INK);
    }
    for (j, row) in (0..rows).zip(&sheet.rows) {
        let y = top + j * (cell[1] + GAP);
        for (i, image) in (0..columns).zip(&row.cells) {
            imageops::replace(&mut page, image, i64::from(MARGIN + i * (cell[0] + GAP)), i64::from(y));
        }
        tag(&mut page, [MARGIN, y], cell[1], &row.label);
    }
    if let Some(legend) = &sheet.legend {
        let y = page.height() - bottom + 12;
        draw_legend(&mut page, y, legend);
    }
    page
}

/// Puts pictures of one moment side by side, each with a label: the frames of a comparing GIF.
#[must_use]
pub fn side_by_side(panels: &[(&str, &RgbImage)]) -> RgbImage {
    let width = panels.iter().map(|(_, p)| p.width()).sum();
    let height = panels.iter().map(|(_, p)| p.height()).max().unwrap_or(0);
    let mut out = RgbImage::from_pixel(width, height, Rgb(PAPER));
    let mut x = 0;
    for (label, panel) in panels {
        imageops::replace(&mut out, *panel, i64::from(x), 0);
        tag(&mut out, [x, 0], height, label);
        if x > 0 {
            (0..height).for_each(|y| blend(&mut out, [x, y], [255; 3], 200));
        }
        x += panel.width();
    }
    out
}

/// A label on a pale ground, in the lower left corner of a picture `height` px high whose upper left is at `x`, `y`.
fn tag(image: &mut RgbImage, [x, y]: [u32; 2], height: u32, label: &str) {
    if label.is_empty() {
        return;
    }
    // Feet are there too: small pictures have small labels.
    let (font, pad) = if height >= 320 { (LABEL, 8) } else { (NOTE, 4) };
    let size = [font.width(label) + 2 * pad, font.height() + pad];
    let [x, y] = [x + pad, (y + height).saturating_sub(size[1] + pad)];
    for j in 0..size[1] {
        for i in 0..size[0] {
            let corner = (i == 0 || i + 1 == size[0]) && (j == 0 || j + 1 == size[1]);
            blend(image, [x + i, y + j], [255; 3], if corner { 60 } else { 190 });
        }
    }
    font.write(image, [x + pad, y + pad / 2 - 1], label, INK);
}

/// The colors of a heat map from cold to hot.
fn draw_legend(page: &mut RgbImage, y: u32, legend: &Legend) {
    let caption = NOTE.width(&legend.caption);
    let left = MARGIN + caption + 20;
    let width = 320.min(page.width().saturating_sub(left + MARGIN + 40));
    NOTE.write(page, [MARGIN, y - 1], &legend.caption, INK);
    for i in 0..width {
        let color = heat(ratio(i, width));
        (0..14).for_each(|j| blend(page, [left + i, y + j], color, 255));
    }
    let last = legend.ticks.len().saturating_sub(1).max(1);
    for (i, tick) in legend.ticks.iter().enumerate() {
        let x = left + width * u32::try_from(i).unwrap_or(0) / u32::try_from(last).unwrap_or(1);
        (0..4).for_each(|j| blend(page, [x.min(left + width - 1), y + 14 + j], PALE_INK, 255));
        NOTE.write(page, [x - NOTE.width(tick) / 2, y + 19], tick, PALE_INK);
    }
}

#[allow(clippy::cast_precision_loss, reason = "pixels")]
fn ratio(i: u32, n: u32) -> f32 {
    i as f32 / n.saturating_sub(1).max(1) as f32
}

/// The bytes of a PNG.
///
/// # Errors
///
/// The encoder's, as an [`io::Error`].
pub fn encode_png(image: &RgbImage, writer: impl io::Write) -> io::Result<()> {
    PngEncoder::new_with_quality(writer, CompressionType::Default, FilterType::Adaptive)
        .write_image(image, image.width(), image.height(), ExtendedColorType::Rgb8)
        .map_err(|e| match e {
            image::ImageError::IoError(e) => e,
            other => io::Error::other(other),
        })
}

/// Writes a PNG, whole or not at all.
///
/// # Errors
///
/// [`Error::Write`] with `path`.
pub fn write_png(path: &Path, image: &RgbImage) -> Result<(), Error> {
    export::write_atomic(path, |writer| encode_png(image, writer))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sheet(columns: u8) -> Sheet {
        let cell = |i: u8| RgbImage::from_pixel(120, 90, Rgb([i, 0, 0]));
        Sheet {
            title: "Fox".to_owned(),
            note: "Run".to_owned(),
            columns: (0..columns).map(|i| format!("0.{i} s")).collect(),
            rows: ["skinning", "sinew"]
                .map(|l| Row { label: l.to_owned(), cells: (0..columns).map(cell).collect() })
                .to_vec(),
            legend: Some(Legend {
                caption: "offset".to_owned(),
                ticks: vec!["0".to_owned(), "1 %".to_owned()],
            }),
        }
    }

    #[test]
    fn every_cell_is_on_the_sheet_at_full_size() {
        let page = contact_sheet(&sheet(5));
        for i in 0..5 {
            let count = page.pixels().filter(|p| p.0 == [i, 0, 0]).count();
            // All but what the labels of the two rows hide.
            assert!(count > 2 * 120 * 90 - if i == 0 { 9000 } else { 1 }, "{count} pixels of cell {i}");
        }
    }

    #[test]
    fn empty_and_narrow_sheets_are_drawn() {
        assert!(contact_sheet(&Sheet::default()).width() > 0, "an empty sheet");
        assert!(contact_sheet(&sheet(1)).width() >= 120, "one column");
    }

    #[test]
    fn a_png_is_read_back_as_it_was() {
        let image =
            RgbImage::from_fn(7, 5, |x, y| Rgb([x, y, x * y].map(|v| u8::try_from(v).expect("small"))));
        let mut bytes = Vec::new();
        encode_png(&image, &mut bytes).expect("memory");
        assert_eq!(image::load_from_memory(&bytes).expect("a picture").to_rgb8(), image);
    }
}
