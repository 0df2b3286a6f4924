//! Animated pictures (GIF): one palette for all frames, and only what changes.

use super::palette::Palette;
use gif::{DisposalMethod, Encoder, EncodingError, Frame, Repeat};
use image::RgbImage;
use std::borrow::Cow;
use std::io::{self, Write};

/// Most frames a second: players show frames of less than 2/100 s slowly.
pub const MAX_GIF_FPS: f32 = 50.0;
/// Colors; one index is left for "as before".
const COLORS: usize = 255;
const UNCHANGED: u8 = 255;

/// How many frames to go on for each that is kept, so that at most `most` a second remain: 2 for 60 of at most 50.
/// Hand `fps / stride` to [`GifWriter::new`].
#[must_use]
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "small and positive")]
pub fn gif_stride(fps: f32, most: f32) -> u32 {
    // A rate that is a hair above the limit by rounding is not halved.
    (libm::ceilf(fps / most - 1e-4) as u32).max(1)
}

/// Writes a GIF frame by frame, looping forever.
///
/// Colors are dithered by a pattern that stands still, so that what does not move takes no space.
pub struct GifWriter<W: Write> {
    encoder: Encoder<W>,
    palette: Palette,
    size: [u32; 2],
    fps: f32,
    written: u32,
    before: Vec<u8>,
}

impl<W: Write> core::fmt::Debug for GifWriter<W> {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        let Self { size, fps, written, .. } = self;
        f.debug_struct("GifWriter")
            .field("size", size)
            .field("fps", fps)
            .field("written", written)
            .finish_non_exhaustive()
    }
}

impl<W: Write> GifWriter<W> {
    /// Begins a picture whose palette suits `samples`: a few frames from all over the clip, all of one size.
    ///
    /// * `fps`: frames a second, above 0 and at most [`MAX_GIF_FPS`] (see [`gif_stride`]). Delays are hundredths of
    ///   a second, rounded so that the clip takes its time as a whole.
    ///
    /// # Errors
    ///
    /// The writer's; [`io::ErrorKind::InvalidInput`] without samples, for pictures of no or more than 65,535
    /// pixels across, or `fps` out of range.
    pub fn new(writer: W, samples: &[RgbImage], fps: f32) -> io::Result<Self> {
        let invalid = |what: &str| io::Error::new(io::ErrorKind::InvalidInput, format!("GIF: {what}"));
        let first = samples.first().ok_or_else(|| invalid("no frames"))?;
        let size = [first.width(), first.height()];
        let [Ok(width @ 1..), Ok(height @ 1..)] = size.map(u16::try_from) else {
            return Err(invalid("1 to 65535 pixels across are possible"));
        };
        if !(fps > 0.0 && fps <= MAX_GIF_FPS * 1.001) {
            return Err(invalid("frames a second must be above 0 and at most 50"));
        }
        let pixels: Vec<[u8; 3]> = samples.iter().flat_map(RgbImage::pixels).map(|p| p.0).collect();
        let palette = Palette::new(&pixels, COLORS);
        let mut colors = palette.rgb();
        colors.resize(3 * (COLORS + 1), 0);
        let mut encoder = Encoder::new(writer, width, height, &colors).map_err(io_error)?;
        encoder.set_repeat(Repeat::Infinite).map_err(io_error)?;
        Ok(Self { encoder, palette, size, fps, written: 0, before: Vec::new() })
    }

    /// Appends a frame.
    ///
    /// # Errors
    ///
    /// The writer's; [`io::ErrorKind::InvalidInput`] for a frame of another size.
    pub fn push(&mut self, image: &RgbImage) -> io::Result<()> {
        if [image.width(), image.height()] != self.size {
            return Err(io::Error::new(io::ErrorKind::InvalidInput, "GIF: frames of different sizes"));
        }
        let indices: Vec<u8> = image.enumerate_pixels().map(|(x, y, p)| self.index(p.0, x, y)).collect();
        let [left, top, width, height] = self.changed(&indices);
        let row = self.size[0] as usize;
        let mut buffer = Vec::with_capacity(width * height);
        for y in top..top + height {
            let start = y * row + left;
            for (i, &index) in (start..).zip(&indices[start..start + width]) {
                let same = self.before.get(i) == Some(&index);
                buffer.push(if same { UNCHANGED } else { index });
            }
        }
        let [left, top, width, height] =
            [left, top, width, height].map(|v| u16::try_from(v).unwrap_or(u16::MAX));
        let frame = Frame {
            delay: self.delay(),
            dispose: DisposalMethod::Keep,
            transparent: Some(UNCHANGED),
            left,
            top,
            width,
            height,
            buffer: Cow::Owned(buffer),
            ..Frame::default()
        };
        self.encoder.write_frame(&frame).map_err(io_error)?;
        self.written += 1;
        self.before = indices;
        Ok(())
    }

    /// Ends the picture and hands back the writer.
    ///
    /// # Errors
    ///
    /// The writer's.
    pub fn finish(self) -> io::Result<W> {
        self.encoder.into_inner().map_err(io_error)
    }

    /// Hundredths of a second until the next frame: the difference of rounded times does not add up errors.
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "at least 2, clamped above")]
    fn delay(&self) -> u16 {
        let time = |frame: u32| libm::round(f64::from(frame) * 100.0 / f64::from(self.fps));
        (time(self.written + 1) - time(self.written)).min(65_535.0) as u16
    }

    /// Color index of a pixel, dithered.
    fn index(&mut self, color: [u8; 3], x: u32, y: u32) -> u8 {
        let shift = dither(x, y);
        let color = color.map(|c| u8::try_from((i32::from(c) + shift).clamp(0, 255)).unwrap_or(0));
        self.palette.index(color)
    }

    /// The rectangle `[left, top, width, height]` of what differs from the frame before; never empty.
    fn changed(&self, indices: &[u8]) -> [usize; 4] {
        let [width, height] = self.size.map(|s| s as usize);
        if self.before.len() != indices.len() {
            return [0, 0, width, height];
        }
        let (mut low, mut high) = ([usize::MAX; 2], [0; 2]);
        for (i, (a, b)) in indices.iter().zip(&self.before).enumerate() {
            if a != b {
                let at = [i % width, i / width];
                (low, high) = ([0, 1].map(|k| low[k].min(at[k])), [0, 1].map(|k| high[k].max(at[k])));
            }
        }
        if low[0] == usize::MAX {
            return [0, 0, 1, 1];
        }
        [low[0], low[1], high[0] - low[0] + 1, high[1] - low[1] + 1]
    }
}

/// Ordered dithering: -3 to 3 in a pattern of 4 × 4 pixels.
fn dither(x: u32, y: u32) -> i32 {
    const PATTERN: [[i32; 4]; 4] = [[0, 8, 2, 10], [12, 4, 14, 6], [3, 11, 1, 9], [15, 7, 13, 5]];
    (PATTERN[(y % 4) as usize][(x % 4) as usize] * 2 - 15) / 5
}

fn io_error(error: EncodingError) -> io::Error {
    match error {
        EncodingError::Io(error) => error,
        other => io::Error::other(other),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use image::Rgb;

    fn frame(i: u32) -> RgbImage {
        RgbImage::from_fn(64, 48, |x, y| {
            let ball = (x.abs_diff(10 + i)).pow(2) + y.abs_diff(24).pow(2) < 60;
            Rgb(if ball { [220, 60, 30] } else { [u8::try_from(100 + x + y).expect("small"), 180, 200] })
        })
    }

    fn gif(frames: u32, fps: f32) -> Vec<u8> {
        let samples: Vec<_> = (0..frames).step_by(7).map(frame).collect();
        let mut writer = GifWriter::new(Vec::new(), &samples, fps).expect("usable samples");
        for i in 0..frames {
            writer.push(&frame(i)).expect("memory");
        }
        writer.finish().expect("memory")
    }

    #[test]
    fn frames_are_shown_as_they_are_and_for_as_long() {
        for fps in [24.0, 30.0, 50.0, 12.5] {
            let bytes = gif(30, fps);
            let mut decoder = gif::DecodeOptions::new();
            decoder.set_color_output(gif::ColorOutput::Indexed);
            let mut decoder = decoder.read_info(bytes.as_slice()).expect("a GIF");
            let palette = decoder.global_palette().expect("one palette").to_vec();
            let mut canvas = vec![0_u8; 64 * 48];
            let (mut count, mut time) = (0, 0);
            let (mut worst, mut total) = (0, 0_u64);
            while let Some(f) = decoder.read_next_frame().expect("a frame") {
                assert!((2..=9).contains(&f.delay), "{} hundredths", f.delay);
                for (i, &index) in f.buffer.iter().enumerate() {
                    let (x, y) = (i % usize::from(f.width), i / usize::from(f.width));
                    if Some(index) != f.transparent {
                        canvas[(y + usize::from(f.top)) * 64 + x + usize::from(f.left)] = index;
                    }
                }
                for (index, pixel) in canvas.iter().zip(frame(count).pixels()) {
                    let shown = &palette[usize::from(*index) * 3..][..3];
                    for (a, b) in shown.iter().zip(pixel.0) {
                        worst = worst.max(a.abs_diff(b));
                        total += u64::from(a.abs_diff(b));
                    }
                }
                count += 1;
                time += u32::from(f.delay);
            }
            assert!(worst <= 40 && total < 4 * 3 * 64 * 48 * 30, "worst {worst}, sum {total}");
            let exact = f64::from(count) * 100.0 / f64::from(fps);
            assert!(count == 30 && (f64::from(time) - exact).abs() <= 0.5, "{time} for {exact} at {fps}");
            assert_eq!(decoder.repeat(), Repeat::Infinite);
        }
    }

    #[test]
    fn what_stands_still_takes_no_space() {
        let (one, many) = (gif(1, 25.0).len(), gif(30, 25.0).len());
        assert!(many < one * 7, "{many} bytes for 30 frames, {one} for one");
    }

    #[test]
    fn impossible_pictures_are_refused() {
        let picture = [frame(0)];
        assert!(GifWriter::new(Vec::new(), &[], 30.0).is_err(), "no frames");
        assert!(GifWriter::new(Vec::new(), &[RgbImage::new(0, 4)], 30.0).is_err(), "no pixels");
        assert!(GifWriter::new(Vec::new(), &[RgbImage::new(70_000, 1)], 30.0).is_err(), "too wide");
        for fps in [0.0, 60.0, f32::NAN] {
            assert!(GifWriter::new(Vec::new(), &picture, fps).is_err(), "{fps}");
        }
        let mut writer = GifWriter::new(Vec::new(), &picture, 30.0).expect("usable");
        assert!(writer.push(&RgbImage::new(64, 47)).is_err(), "another size");
        assert_eq!([24.0, 50.0, 60.0, 120.0, 240.0].map(|fps| gif_stride(fps, MAX_GIF_FPS)), [1, 1, 2, 3, 5]);
    }
}
