//! Labels.

use image::{Rgb, RgbImage};
use noto_sans_mono_bitmap::{FontWeight, RasterHeight, get_raster, get_raster_width};

/// Size and weight of letters.
#[derive(Clone, Copy, Debug)]
pub(super) struct Font {
    height: RasterHeight,
    weight: FontWeight,
}

/// Headings.
pub(super) const TITLE: Font = Font { height: RasterHeight::Size32, weight: FontWeight::Bold };
/// Names of rows and panels.
pub(super) const LABEL: Font = Font { height: RasterHeight::Size20, weight: FontWeight::Bold };
/// Everything else.
pub(super) const NOTE: Font = Font { height: RasterHeight::Size16, weight: FontWeight::Regular };

impl Font {
    /// Height of a line, px.
    pub(super) fn height(self) -> u32 {
        u32::try_from(self.height.val()).unwrap_or(u32::MAX)
    }

    /// Width of a text, px.
    pub(super) fn width(self, text: &str) -> u32 {
        let letter = get_raster_width(self.weight, self.height);
        u32::try_from(text.chars().count().saturating_mul(letter)).unwrap_or(u32::MAX)
    }

    /// The text, cut with an ellipsis where it is wider than `width` px.
    pub(super) fn fit(self, text: &str, width: u32) -> String {
        let letters = usize::try_from(width / self.width("x").max(1)).unwrap_or(usize::MAX);
        if text.chars().count() <= letters {
            return text.to_owned();
        }
        text.chars().take(letters.saturating_sub(3)).chain("...".chars()).collect()
    }

    /// Writes a text whose upper left corner is at `x`, `y`; letters that the font lacks become `?`.
    pub(super) fn write(self, image: &mut RgbImage, [x, y]: [u32; 2], text: &str, color: [u8; 3]) {
        let mut left = x;
        for letter in text.chars() {
            let raster = get_raster(letter, self.weight, self.height)
                .or_else(|| get_raster('?', self.weight, self.height));
            for (j, row) in (0_u32..).zip(raster.iter().flat_map(|r| r.raster())) {
                for (i, &share) in (0_u32..).zip(row.iter()) {
                    blend(image, [left + i, y + j], color, share);
                }
            }
            left += self.width("x");
        }
    }
}

/// Lays `color` over a pixel; nothing happens outside the image.
pub(super) fn blend(image: &mut RgbImage, [x, y]: [u32; 2], color: [u8; 3], share: u8) {
    if let Some(Rgb(pixel)) = image.get_pixel_mut_checked(x, y) {
        for (p, c) in pixel.iter_mut().zip(color) {
            let mixed = u32::from(*p) * (255 - u32::from(share)) + u32::from(c) * u32::from(share);
            *p = u8::try_from((mixed + 127) / 255).unwrap_or(u8::MAX);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn letters_stay_in_their_box_and_long_texts_are_cut() {
        let mut image = RgbImage::from_pixel(100, 40, Rgb([255; 3]));
        NOTE.write(&mut image, [90, 10], "sinew Ωé", [0; 3]);
        let touched: Vec<_> = image.enumerate_pixels().filter(|(_, _, p)| p.0 != [255; 3]).collect();
        assert!(!touched.is_empty(), "something is written");
        assert!(touched.iter().all(|(x, y, _)| *x >= 90 && (10..26).contains(y)), "beyond its box");
        assert_eq!(NOTE.fit("jump", 100), "jump");
        let cut = NOTE.fit("a long name of a clip", 80);
        assert!(cut.ends_with("...") && NOTE.width(&cut) <= 80, "{cut}");
    }
}
