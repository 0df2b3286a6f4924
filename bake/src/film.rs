//! Pictures of a run: contact sheets and GIFs, with a camera that holds still and misses nothing.
//!
//! ```text
//! frames ─▶ Survey (camera, moments, greatest offset) ─▶ Film ─▶ contact sheet
//! frames once more ────────────────────────────────────▶ Film ─▶ frames of a GIF
//! ```
//!
//! The run is played twice for a GIF, because keeping every frame of a long clip would take gigabytes.

use crate::Model;
use crate::play::{Frame, Motion, Player};
use crate::render::{self, Camera, Figure, Framing, GifWriter, Legend, Pose, Row, Sheet, Show, gif_stride};
use glam::DVec3;
use image::RgbImage;
use rayon::prelude::*;
use std::io::{self, Write};

/// Frames of a GIF that are drawn at a time, on all threads.
const BATCH: usize = 16;
/// From where characters are seen: azimuth and elevation, radians.
const VIEW: (f32, f32) = (0.62, 0.18);
/// Shapes of pictures, width by height; the one that the run fills best is taken.
const ASPECTS: [f32; 7] = [0.7, 0.85, 1.0, 1.2, 1.4, 1.6, 1.8];

/// Length of a round of the built-in shake, s.
pub(crate) const SHAKE_ROUND: f32 = 2.0;

/// Azimuth of a character's front, radians: +Z by glTF's convention, -Z for VRM 0.
#[must_use]
pub fn front(model: &Model) -> f32 {
    let turned = model.vrm.as_ref().is_some_and(|vrm| vrm.major_version == 0);
    if turned { core::f32::consts::PI } else { 0.0 }
}

/// What a first look at a run finds.
#[derive(Clone, Debug)]
pub struct Survey {
    framings: [(f32, Framing); ASPECTS.len()],
    /// Numbers of the frames for the contact sheet, ascending.
    wanted: Vec<u32>,
    moments: Vec<Frame>,
    /// Greatest distance from skinning, body sizes.
    pub hottest: f32,
}

impl Survey {
    /// Prepares for the frames of `player`, which plays `model`; `columns` moments are kept for the contact sheet,
    /// from the last round of a motion that goes over into itself, from the first of any other.
    #[must_use]
    pub fn new(model: &Model, player: &Player<'_>, columns: u32) -> Self {
        let (round, steady) = match &player.motion {
            Motion::Clip { duration, looped, .. } if *duration > 0.0 => (*duration, *looped),
            Motion::Clip { .. } => (f32::INFINITY, false),
            Motion::Shake => (SHAKE_ROUND, true),
        };
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped")]
        let span = (libm::roundf(round * player.fps) as u32).clamp(1, player.frames.max(1));
        let columns = columns.clamp(1, span);
        let moment = |k: u32| u64::from(k) * u64::from(span) / u64::from(columns);
        let first = if steady { player.frames - span } else { 0 };
        Self::of(model, (0..columns).map(|k| first + u32::try_from(moment(k)).unwrap_or(span)).collect())
    }

    /// Prepares for frames from anywhere; those with a number in `wanted`, ascending, are kept.
    #[must_use]
    pub fn of(model: &Model, wanted: Vec<u32>) -> Self {
        Self {
            framings: ASPECTS.map(|a| (a, Framing::new(a, front(model) + VIEW.0, VIEW.1))),
            wanted,
            moments: Vec::new(),
            hottest: 0.0,
        }
    }

    /// Takes the next frame.
    pub fn add(&mut self, model: &Model, frame: &Frame) {
        let rigid: Vec<[f32; 3]> = rigid_points(model, frame);
        for (_, framing) in &mut self.framings {
            framing.add(frame.flesh.iter().chain(&frame.skinned).chain(&rigid).copied());
        }
        self.hottest = frame.heat.iter().copied().fold(self.hottest, f32::max);
        if self.wanted.contains(&frame.index) {
            self.moments.push(frame.clone());
        }
    }
}

/// Points of the meshes that hang on nodes, model space.
fn rigid_points(model: &Model, frame: &Frame) -> Vec<[f32; 3]> {
    let place = |p: &[f32; 3], m: &glam::DMat4| {
        m.transform_point3(DVec3::from_array(p.map(f64::from))).as_vec3().to_array()
    };
    let meshes = model.rigid.iter().zip(&frame.rigid);
    meshes.flat_map(|(r, m)| r.positions.iter().map(move |p| place(p, m))).collect()
}

/// What is drawn of a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Look {
    /// Skinning alone.
    Skinning,
    /// With flesh.
    Flesh,
    /// The distance between the two, as heat.
    Heat,
}

/// A character in front of its camera.
#[derive(Debug)]
pub struct Film<'a> {
    model: &'a Model,
    figure: Figure<'a>,
    camera: Camera,
    size: [u32; 2],
    survey: Survey,
}

impl<'a> Film<'a> {
    /// Places the camera for pictures `height` pixels high.
    #[must_use]
    pub fn new(model: &'a Model, survey: Survey, height: u32) -> Self {
        let (aspect, framing) = survey
            .framings
            .iter()
            .fold(survey.framings[0], |best, this| if this.1.fit() > best.1.fit() { *this } else { best });
        #[allow(clippy::cast_precision_loss, reason = "pixels")]
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "pixels")]
        let width = libm::roundf(height as f32 * aspect).max(1.0) as u32;
        let camera = framing.camera();
        Self { model, figure: Figure::new(model), camera, size: [width, height.max(1)], survey }
    }

    /// Draws a frame.
    #[must_use]
    pub fn draw(&self, frame: &Frame, look: Look) -> RgbImage {
        let (positions, normals) = match look {
            Look::Skinning => (&frame.skinned, &frame.skinned_normals),
            Look::Flesh | Look::Heat => (&frame.flesh, &frame.flesh_normals),
        };
        let most = self.survey.hottest.max(f32::MIN_POSITIVE);
        let heat: Vec<f32> = frame.heat.iter().map(|h| h / most).collect();
        let show = if look == Look::Heat { Show::Heat(&heat) } else { Show::Materials };
        let pose = Pose { positions, normals, rigid: &frame.rigid, show };
        self.figure.draw(&pose, &self.camera, self.size[0], self.size[1])
    }

    /// Draws frames on all threads; with several looks they stand side by side, each with its name.
    #[must_use]
    pub fn draw_all(&self, frames: &[Frame], looks: &[(&str, Look)]) -> Vec<RgbImage> {
        let draw = |frame: &Frame| {
            let panels: Vec<RgbImage> = looks.iter().map(|(_, look)| self.draw(frame, *look)).collect();
            match panels.as_slice() {
                [one] => one.clone(),
                _ => {
                    let named = looks.iter().map(|(name, _)| *name);
                    render::side_by_side(&named.zip(&panels).collect::<Vec<_>>())
                }
            }
        };
        frames.par_iter().map(draw).collect()
    }

    /// Size of a picture, pixels.
    #[must_use]
    pub fn size(&self) -> [u32; 2] {
        self.size
    }

    /// Moments from all over the run.
    #[must_use]
    pub fn moments(&self) -> &[Frame] {
        &self.survey.moments
    }

    /// Writes a looping GIF of what `player` still has to play, with at most `most` frames a second (at most
    /// [`MAX_GIF_FPS`](render::MAX_GIF_FPS)). `drawn` is called for each frame that was played.
    ///
    /// # Errors
    ///
    /// The writer's; the player's as an [`io::Error`] with an [`Error`](crate::Error) inside.
    pub fn gif<W: Write>(
        &self,
        out: W,
        player: &mut Player<'_>,
        most: f32,
        looks: &[(&str, Look)],
        mut drawn: impl FnMut(),
    ) -> io::Result<W> {
        let stride = gif_stride(player.fps, most);
        #[allow(clippy::cast_precision_loss, reason = "a small number")]
        let fps = player.fps / stride as f32;
        // The palette is to suit moments from all over the run.
        let mut gif = GifWriter::new(out, &self.draw_all(self.moments(), looks), fps)?;
        let mut batch = Vec::with_capacity(BATCH);
        loop {
            let frame = player.next().map_err(io::Error::other)?;
            let ended = frame.is_none();
            batch.extend(frame.filter(|f| f.index % stride == 0).cloned());
            if ended || batch.len() == BATCH {
                self.draw_all(&batch, looks).iter().try_for_each(|picture| gif.push(picture))?;
                batch.clear();
            }
            if ended {
                return gif.finish();
            }
            drawn();
        }
    }

    /// Writes a looping GIF of frames from anywhere, `fps` a second.
    ///
    /// # Errors
    ///
    /// Those of [`GifWriter`].
    pub fn gif_of<W: Write>(
        &self,
        out: W,
        frames: &[Frame],
        fps: f32,
        looks: &[(&str, Look)],
        mut drawn: impl FnMut(),
    ) -> io::Result<W> {
        let mut gif = GifWriter::new(out, &self.draw_all(self.moments(), looks), fps)?;
        for batch in frames.chunks(BATCH) {
            for picture in self.draw_all(batch, looks) {
                gif.push(&picture)?;
                drawn();
            }
        }
        gif.finish()
    }

    /// The contact sheet: one row a look, one column a moment. `drawn` is called after each row.
    #[must_use]
    pub fn sheet(&self, note: &str, looks: &[(&str, Look)], drawn: impl FnMut()) -> RgbImage {
        self.sheet_of(note, looks, |f| format!("{:.2} s", f.time), drawn)
    }

    /// [`Self::sheet`] with a `caption` over each moment.
    #[must_use]
    pub fn sheet_of(
        &self,
        note: &str,
        looks: &[(&str, Look)],
        caption: impl Fn(&Frame) -> String,
        mut drawn: impl FnMut(),
    ) -> RgbImage {
        let row = |(name, look): &(&str, Look)| {
            let cells = self.draw_all(self.moments(), &[("", *look)]);
            drawn();
            Row { label: (*name).to_owned(), cells }
        };
        let rows: Vec<Row> = looks.iter().map(row).collect();
        let heat = looks.iter().any(|(_, look)| *look == Look::Heat);
        render::contact_sheet(&Sheet {
            title: self.model.name.clone(),
            note: note.to_owned(),
            columns: self.moments().iter().map(caption).collect(),
            rows,
            legend: heat.then(|| Legend {
                caption: "distance from skinning, % of the body".to_owned(),
                ticks: ticks(100.0 * self.survey.hottest),
            }),
        })
    }
}

/// Five labels from 0 to `most`.
fn ticks(most: f32) -> Vec<String> {
    let digits = if most >= 10.0 { 0 } else { 1 };
    (0..5_u8).map(|i| format!("{:.digits$}", most * f32::from(i) / 4.0)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::play::Settings;
    use crate::{builtin, pack, recipe};
    use sinew::{Asset, Character};

    /// Times of the moments that a survey of the built-in character keeps.
    fn moments(seconds: f32, columns: u32) -> Vec<f32> {
        let model = builtin::character();
        let flesh = recipe::flesh(&model, &recipe::Recipe::default()).expect("it has flesh");
        let words = pack::align(&pack::pack(&model, &flesh, 0).expect("it is packed"));
        let asset = Asset::parse(bytemuck::cast_slice(&words)).expect("an asset");
        let mut memory = vec![0.0; Character::required_len(&asset)];
        let settings = Settings { seconds: Some(seconds), fps: 30.0, ..Settings::default() };
        let mut player = Player::new(&model, asset, &mut memory, &settings).expect("it plays");
        let mut survey = Survey::new(&model, &player, columns);
        while let Some(frame) = player.next().expect("a frame") {
            survey.add(&model, frame);
        }
        let film = Film::new(&model, survey, 100);
        let inside = |p: &[f32; 3]| {
            let size = film.size().map(|s| u16::try_from(s).map_or(0.0, f32::from));
            let at = film.camera.project(*p, size).expect("before the camera");
            (0..2).all(|i| at[i] > 0.05 * size[i] && at[i] < 0.95 * size[i])
        };
        assert!(film.moments().iter().flat_map(|f| &f.flesh).all(inside), "all of it is in the picture");
        film.moments().iter().map(|f| f.time).collect()
    }

    #[test]
    fn moments_are_spread_over_one_round() {
        // The clip takes a second.
        for seconds in [1.0, 3.0] {
            let times = moments(seconds, 5);
            assert_eq!(times.len(), 5);
            for (k, t) in (0_u8..).zip(&times) {
                assert!((t - 0.2 * f32::from(k)).abs() < 0.01, "{times:?} of {seconds} s");
            }
        }
        assert_eq!(moments(0.1, 6).len(), 3, "no more moments than frames");
    }
}
