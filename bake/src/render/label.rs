//! Text on pictures.

use noto_sans_mono_bitmap::{FontWeight, RasterHeight, get_raster, get_raster_width};

/// Height of a line, pixels.
pub(super) const LINE: usize = 20;

/// Writes `text` in dark ink at `(x, y)` into an RGB picture `width` pixels wide; what does not fit is cut.
pub(super) fn write(rgb: &mut [u8], width: usize, (x, y): (usize, usize), text: &str) {
    let advance = get_raster_width(FontWeight::Regular, RasterHeight::Size20);
    for (i, c) in text.chars().enumerate() {
        let glyph = get_raster(c, FontWeight::Regular, RasterHeight::Size20)
            .or_else(|| get_raster('?', FontWeight::Regular, RasterHeight::Size20));
        let Some(glyph) = glyph else { continue };
        for (row, line) in glyph.raster().iter().enumerate() {
            for (column, ink) in line.iter().enumerate() {
                let px = x + i * advance + column;
                let at = ((y + row) * width + px) * 3;
                if px >= width || at + 3 > rgb.len() {
                    continue;
                }
                for (channel, paper) in rgb[at..at + 3].iter_mut().enumerate() {
                    let dark = [38_u16, 42, 52][channel];
                    let (ink, old) = (u16::from(*ink), u16::from(*paper));
                    *paper = u8::try_from((old * (255 - ink) + dark * ink) / 255).unwrap_or(255);
                }
            }
        }
    }
}
