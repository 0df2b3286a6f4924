//! Textures, with smaller copies for distant surfaces.

use super::color::{to_linear, to_srgb};
use image::imageops::FilterType;

/// Greatest side of a texture, texels: no picture needs more.
const MAX_SIDE: u32 = 1024;

/// An image on a surface.
#[derive(Clone, Debug)]
pub struct Texture {
    /// The image, then copies of half the size of the one before.
    levels: Vec<Level>,
}

#[derive(Clone, Debug)]
struct Level {
    width: usize,
    height: usize,
    /// sRGB, rows from the top.
    texels: Vec<[u8; 3]>,
}

impl Texture {
    /// Decodes a PNG or JPEG; transparency is ignored.
    ///
    /// # Errors
    ///
    /// The decoder's, for other or broken data.
    pub fn decode(bytes: &[u8]) -> Result<Self, image::ImageError> {
        let mut image = image::load_from_memory(bytes)?;
        if image.width().max(image.height()) > MAX_SIDE {
            image = image.resize(MAX_SIDE, MAX_SIDE, FilterType::Triangle);
        }
        Ok(Self::new(&image.to_rgb8()))
    }

    /// A texture of an image, sRGB.
    #[must_use]
    pub fn new(image: &image::RgbImage) -> Self {
        let texels = image.pixels().map(|p| p.0).collect();
        let mut levels =
            vec![Level { width: image.width() as usize, height: image.height() as usize, texels }];
        while let Some(half) = levels.last().and_then(Level::half) {
            levels.push(half);
        }
        Self { levels }
    }

    /// Width and height, texels.
    #[must_use]
    pub fn size(&self) -> [usize; 2] {
        [self.levels[0].width, self.levels[0].height]
    }

    /// The level whose texels are about as large as pixels.
    pub(super) fn level(&self, texels_per_pixel: f32) -> usize {
        let mut ratio = texels_per_pixel;
        let mut level = 0;
        while ratio > 1.5 && level + 1 < self.levels.len() {
            ratio *= 0.5;
            level += 1;
        }
        level
    }

    /// Linear color at `uv`, repeated beyond `0..1`, interpolated between texels.
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "texel coordinates")]
    #[allow(clippy::cast_precision_loss, reason = "texel coordinates")]
    pub(super) fn sample(&self, uv: [f32; 2], level: usize) -> [f32; 3] {
        let level = &self.levels[level];
        let place = |t: f32, size: usize| {
            let fraction = if t.is_finite() { t - libm::floorf(t) } else { 0.0 };
            let x = fraction * size as f32 - 0.5 + size as f32;
            let base = x as usize;
            (base % size, (base + 1) % size, x - base as f32)
        };
        let (x0, x1, fx) = place(uv[0], level.width);
        let (y0, y1, fy) = place(uv[1], level.height);
        let at = |x: usize, y: usize| to_linear(level.texels[y * level.width + x]);
        let (top, bottom) = (lerp(at(x0, y0), at(x1, y0), fx), lerp(at(x0, y1), at(x1, y1), fx));
        lerp(top, bottom, fy)
    }
}

impl Level {
    /// Half the size, or `None` of a single texel.
    fn half(&self) -> Option<Self> {
        if self.width * self.height <= 1 {
            return None;
        }
        let (width, height) = (self.width.div_ceil(2), self.height.div_ceil(2));
        let mut texels = Vec::with_capacity(width * height);
        for y in 0..height {
            for x in 0..width {
                let (x0, y0) = ((2 * x).min(self.width - 1), (2 * y).min(self.height - 1));
                let (x1, y1) = ((x0 + 1).min(self.width - 1), (y0 + 1).min(self.height - 1));
                let at = |x: usize, y: usize| to_linear(self.texels[y * self.width + x]);
                let rows = [lerp(at(x0, y0), at(x1, y0), 0.5), lerp(at(x0, y1), at(x1, y1), 0.5)];
                texels.push(to_srgb(lerp(rows[0], rows[1], 0.5)));
            }
        }
        Some(Self { width, height, texels })
    }
}

/// Between two colors.
pub(super) fn lerp(a: [f32; 3], b: [f32; 3], t: f32) -> [f32; 3] {
    core::array::from_fn(|i| a[i] + (b[i] - a[i]) * t)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn texels_repeat_and_are_interpolated() {
        let image = image::RgbImage::from_fn(2, 2, |x, _| image::Rgb(if x == 0 { [0; 3] } else { [255; 3] }));
        let texture = Texture::new(&image);
        assert_eq!((texture.size(), texture.levels.len()), ([2, 2], 2));
        for (u, expected) in [(0.25, 0.0), (0.75, 1.0), (0.5, 0.5), (1.25, 0.0), (-0.25, 1.0)] {
            let [r, _, _] = texture.sample([u, 0.5], 0);
            assert!((r - expected).abs() < 1e-6, "{r} at {u}");
        }
        let mean = texture.sample([0.3, 0.3], texture.level(2.0))[0];
        assert!((mean - 0.5).abs() < 0.01, "the smaller copy is the mean light, {mean}");
    }

    #[test]
    fn broken_images_are_refused_and_absurd_coordinates_are_not() {
        assert!(Texture::decode(b"\x89PNG and nothing more").is_err(), "no image");
        let texture = Texture::new(&image::RgbImage::new(3, 1));
        for uv in [[f32::NAN, 0.0], [1e30, -1e30], [f32::INFINITY, 0.0]] {
            assert!(texture.sample(uv, 0)[0].abs() < 1e-6, "black");
        }
    }
}
