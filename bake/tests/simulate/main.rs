//! Characters in equilibrium and in motion, and datasets of them.

#![expect(clippy::unwrap_used, reason = "helpers of tests are tests")]

mod job;
mod motion;
mod recordings;
mod settle;

use sinew_bake::pose::Pose;
use sinew_bake::simulate::{Settings, Simulation};
use sinew_bake::{Model, builtin};

/// The pose of the built-in character's first clip at a time.
pub(crate) fn walking(model: &Model, t: f32) -> Pose {
    Pose::of_clip(model, &model.clips[0], t)
}

/// The built-in character.
pub(crate) fn plum() -> Model {
    builtin::character()
}

/// Its flesh in a coarse cage.
pub(crate) fn flesh(model: &Model) -> Simulation<'_> {
    Simulation::new(model, &Settings::draft()).unwrap()
}

/// Greatest distance of points, body sizes.
pub(crate) fn farthest(flesh: &Simulation<'_>, a: &[glam::DVec3], b: &[glam::DVec3]) -> f64 {
    let all = a.iter().zip(b).map(|(a, b)| a.distance(*b));
    all.fold(0.0, f64::max) / flesh.body.surface.size
}
