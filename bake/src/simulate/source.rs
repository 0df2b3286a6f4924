//! Where the poses of a dataset come from.
//!
//! ```text
//! recorded (clips, BVH), root apart ─▶ farthest-point choice ─┐
//! random within joint limits        ─▶ farthest-point choice ─┴─▶ poses;   pieces of recorded motion ─▶ sequences
//! ```

use super::job::Work;
use crate::pose::bvh::Bvh;
use crate::pose::random::Limits;
use crate::pose::{Pose, clip, farthest, retarget};
use crate::{Error, Model};
use std::path::Path;

/// Random poses that some are chosen from at a time: the time of a choice grows with the square.
const POOL: u64 = 4000;
/// How many.
const CHOSEN: usize = 1000;

/// Motions to take poses from.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Source {
    /// Names of the motions.
    pub names: Vec<String>,
    /// Poses of each, at an even rate.
    pub motions: Vec<Vec<Pose>>,
}

impl Source {
    /// All clips of a character at `rate` poses a second.
    ///
    /// # Errors
    ///
    /// As [`clip::poses`].
    pub fn clips(model: &Model, rate: f64) -> Result<Self, Error> {
        let mut out = Self::default();
        for clip in &model.clips {
            out.names.push(clip.name.clone());
            out.motions.push(clip::poses(model, clip, rate)?);
        }
        Ok(out)
    }

    /// Adds a recording, carried over to the character.
    ///
    /// # Errors
    ///
    /// Those of [`Bvh::read`] and [`retarget::poses`].
    pub fn add_bvh(&mut self, model: &Model, path: &Path, rate: f64) -> Result<(), Error> {
        let name = path.display().to_string();
        let poses = retarget::poses(model, &Bvh::read(path)?, &name, rate)?;
        self.names.push(name);
        self.motions.push(poses);
        Ok(())
    }

    /// Poses in which equilibria are sought, root apart: those recorded that differ most, and random ones within the
    /// limits of the joints that differ most. Of both kinds half, but as many recorded ones as there are.
    ///
    /// # Errors
    ///
    /// [`Error::Unusable`] if there are not so many that differ.
    pub fn equilibria(&self, model: &Model, samples: usize, seed: u64) -> Result<Work, Error> {
        let recorded: Vec<Pose> = self.motions.iter().flatten().map(|p| p.split_root(model).1).collect();
        let limits = Limits::new(model, &recorded);
        let nodes: Vec<usize> = limits.joints.iter().map(|j| j.0).collect();
        let choose = |poses: &[Pose], n: usize| -> Vec<Pose> {
            let chosen = farthest::select(poses, &nodes, n).indices;
            chosen.into_iter().map(|i| poses[i].clone()).collect()
        };
        let mut poses = choose(&recorded, samples.div_ceil(2));
        let mut first = 0;
        while poses.len() < samples {
            let pool: Vec<Pose> = (first..first + POOL).map(|i| limits.pose(model, seed, i)).collect();
            let wanted = CHOSEN.min(samples - poses.len());
            let chosen = choose(&pool, wanted);
            let all = chosen.len() == wanted;
            poses.extend(chosen);
            first += POOL;
            // A character without joints has one pose.
            if !all {
                break;
            }
        }
        if poses.len() < samples {
            let problem = format!("{samples} are wanted, {} differ", poses.len());
            let remedy = "ask for fewer, or move the joints of the rig";
            return Err(Error::unusable(&model.name, "poses", problem, remedy));
        }
        Ok(Work::Equilibria(poses))
    }

    /// Motions in pieces of `frames` poses; what is left at the end of one is a piece of its own.
    ///
    /// # Errors
    ///
    /// [`Error::Unusable`] if there are none.
    pub fn sequences(&self, model: &Model, frames: usize, rate: f64, substeps: u32) -> Result<Work, Error> {
        let pieces = self.motions.iter().flat_map(|m| m.chunks(frames.max(2)));
        let sequences: Vec<Vec<Pose>> = pieces.filter(|p| p.len() > 1).map(<[Pose]>::to_vec).collect();
        if sequences.is_empty() {
            let problem = "the character has no clip that moves";
            return Err(Error::unusable(&model.name, "motions", problem, "give motions by --bvh"));
        }
        Ok(Work::Motions { sequences, rate, substeps })
    }
}
