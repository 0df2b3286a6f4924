//! Animated GIFs.

use super::label;
use std::io::{self, Write};

/// A GIF in the making; frames are RGB.
pub struct Gif<W: Write> {
    encoder: gif::Encoder<W>,
    width: u16,
    height: u16,
    fps: f64,
    shown: u32,
}

impl<W: Write> core::fmt::Debug for Gif<W> {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.debug_struct("Gif").field("width", &self.width).field("shown", &self.shown).finish_non_exhaustive()
    }
}

impl<W: Write> Gif<W> {
    /// Starts a looped GIF of `width × height` pixels at `fps` frames a second (at most 50).
    ///
    /// # Errors
    ///
    /// Those of the writer.
    pub fn new(out: W, width: u16, height: u16, fps: f64) -> io::Result<Self> {
        let mut encoder = gif::Encoder::new(out, width, height, &[]).map_err(io::Error::other)?;
        encoder.set_repeat(gif::Repeat::Infinite).map_err(io::Error::other)?;
        Ok(Self { encoder, width, height, fps, shown: 0 })
    }

    /// Adds a frame with labels at `(x, y)`.
    ///
    /// # Errors
    ///
    /// Those of the writer.
    pub fn frame(&mut self, mut rgb: Vec<u8>, labels: &[(usize, usize, &str)]) -> io::Result<()> {
        for (x, y, text) in labels {
            label::write(&mut rgb, usize::from(self.width), (*x, *y), text);
        }
        let mut frame = gif::Frame::from_rgb_speed(self.width, self.height, &rgb, 8);
        frame.delay = self.delay();
        self.shown += 1;
        self.encoder.write_frame(&frame).map_err(io::Error::other)
    }

    /// Hundredths of a second, so that the times of frames are right on average.
    fn delay(&self) -> u16 {
        let at = |i: u32| (f64::from(i) * 100.0 / self.fps).round();
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a few hundredths")]
        {
            (at(self.shown + 1) - at(self.shown)) as u16
        }
    }
}
