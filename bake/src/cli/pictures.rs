//! Contact sheets and GIFs of a run.

use super::progress;
use glam::DVec3;
use sinew_bake::play::Frame;
use sinew_bake::render::{Camera, Canvas, Drawn, Gif, Look, Scene, contact_sheet};
use sinew_bake::{Error, Model, export};
use std::io;
use std::path::Path;

/// Columns of a contact sheet.
const COLUMNS: usize = 6;
/// Frames a second of a GIF, at most.
const GIF_FPS: f32 = 30.0;
/// From where characters are seen: azimuth and elevation, radians.
const VIEW: (f64, f64) = (0.62, 0.18);

pub(super) struct Pictures<'a> {
    model: &'a Model,
    height: usize,
    flesh: bool,
    beside: bool,
}

impl<'a> Pictures<'a> {
    /// Pictures `height` pixels high; with `beside`, a GIF shows skinning alone at the left.
    pub(super) fn new(model: &'a Model, height: usize, flesh: bool, beside: bool) -> Self {
        Self { model, height: height.clamp(64, 2000), flesh, beside }
    }

    /// Camera, scene and width of a picture that shows all frames.
    fn stage(&self, frames: &[Frame]) -> (Camera, Scene<'a>, usize) {
        let all = frames.iter().step_by(4).flat_map(|f| f.flesh.iter().chain(&f.skinned));
        let points: Vec<DVec3> = all.map(|p| DVec3::from_array(p.map(f64::from))).collect();
        let low = points.iter().copied().reduce(DVec3::min).unwrap_or_default();
        let high = points.iter().copied().reduce(DVec3::max).unwrap_or(DVec3::ONE);
        let extent = high - low;
        let across = (extent.x * libm::cos(VIEW.0)).abs() + (extent.z * libm::sin(VIEW.0)).abs();
        let aspect = (across / extent.y.max(1e-9) * 1.05).clamp(0.75, 1.6);
        #[allow(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            clippy::cast_precision_loss,
            reason = "pixels"
        )]
        let width = (self.height as f64 * aspect).round() as usize;
        #[allow(clippy::cast_precision_loss, reason = "pixels")]
        let aspect = width as f64 / self.height as f64;
        let camera = Camera::framing(&points, aspect, VIEW.0, VIEW.1);
        (camera, Scene::new(self.model, low.y), width)
    }

    fn draw(
        &self,
        scene: &Scene<'_>,
        camera: &Camera,
        width: usize,
        frame: &Frame,
        flesh: bool,
        heat: Option<f32>,
    ) -> Canvas {
        let mut canvas = Scene::canvas(width, self.height);
        let (positions, normals) = if flesh {
            (&frame.flesh, &frame.flesh_normals)
        } else {
            (&frame.skinned, &frame.skinned_normals)
        };
        let drawn = Drawn { positions, normals, rigid: &frame.rigid };
        match heat {
            None => scene.draw(&mut canvas, camera, drawn, Look::Materials),
            Some(most) => {
                let values: Vec<f32> = frame.heat.iter().map(|h| h / most).collect();
                scene.draw(&mut canvas, camera, drawn, Look::Heat(&values));
            }
        }
        canvas
    }

    /// Writes the contact sheet: skinning, sinew, heat map.
    pub(super) fn sheet(&self, out: &Path, frames: &[Frame]) -> Result<(), Error> {
        let (camera, scene, width) = self.stage(frames);
        let most = frames.iter().flat_map(|f| &f.heat).copied().fold(1e-6, f32::max);
        let moments: Vec<&Frame> = (0..COLUMNS.min(frames.len()))
            .map(|k| &frames[k * frames.len() / COLUMNS.min(frames.len())])
            .collect();
        let bar = progress("draw", 3 * moments.len() as u64);
        let row = |flesh: bool, heat: Option<f32>| -> Vec<Vec<u8>> {
            let draw = |frame: &&Frame| {
                bar.inc(1);
                self.draw(&scene, &camera, width, frame, flesh, heat).to_rgb()
            };
            moments.iter().map(draw).collect()
        };
        let rows = [row(false, None), row(self.flesh, None), row(self.flesh, Some(most))];
        bar.finish_and_clear();
        let heat = format!("offset, red is {:.1} % of the body", 100.0 * most);
        let labels = ["skinning", if self.flesh { "sinew" } else { "skinning" }, heat.as_str()];
        let png = contact_sheet(&self.model.name, &labels, &rows, (width, self.height))?;
        export::write_bytes(out, &png)
    }

    /// Writes the GIF.
    pub(super) fn gif(&self, out: &Path, frames: &[Frame]) -> Result<(), Error> {
        let (camera, scene, width) = self.stage(frames);
        let fps = match frames {
            [a, b, ..] if b.time > a.time => 1.0 / (b.time - a.time),
            _ => GIF_FPS,
        };
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a small number")]
        let skip = libm::ceilf(fps / GIF_FPS - 0.01).max(1.0) as usize;
        let shown: Vec<&Frame> = frames.iter().step_by(skip).collect();
        #[allow(clippy::cast_precision_loss, reason = "a small number")]
        let rate = f64::from(fps) / skip as f64;
        let full = if self.beside { 2 * width } else { width };
        let pixels = |n: usize| u16::try_from(n).map_err(|_| io::Error::from(io::ErrorKind::InvalidInput));
        let bar = progress("draw", shown.len() as u64);
        export::write_atomic(out, |file| {
            let mut gif = Gif::new(file, pixels(full)?, pixels(self.height)?, rate)?;
            for frame in shown {
                let right = self.draw(&scene, &camera, width, frame, self.flesh, None).to_rgb();
                if self.beside {
                    let left = self.draw(&scene, &camera, width, frame, false, None).to_rgb();
                    let rows = left.chunks_exact(3 * width).zip(right.chunks_exact(3 * width));
                    let both = rows.flat_map(|(a, b)| [a, b].concat()).collect();
                    gif.frame(both, &[(12, 8, "skinning"), (width + 12, 8, "sinew")])?;
                } else {
                    gif.frame(right, &[])?;
                }
                bar.inc(1);
            }
            Ok(())
        })?;
        bar.finish_and_clear();
        Ok(())
    }
}
