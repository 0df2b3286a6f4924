//! Motion capture as BVH files.
//!
//! A joint's rotation is the product of its channels in the order in which the file names them, `R = R₁·R₂·R₃`, and its
//! translation is its offset, of which position channels replace their axis (Meredith and Maddock, *Motion capture
//! file formats explained*, University of Sheffield 2001, section 2). With all rotations zero every joint has the axes
//! of the file, so that a joint's rotation in space is also how far it is turned from that pose.

mod parse;
#[cfg(test)]
mod tests;

use crate::Error;
use glam::{DQuat, DVec3};
use std::path::Path;

/// A motion of a skeleton.
///
/// ```
/// let file = b"HIERARCHY\nROOT hip\n{\n OFFSET 0 0 0\n CHANNELS 2 Yposition Zrotation\n End Site\n {\n  OFFSET 0 2 0\n }\n}
/// MOTION\nFrames: 2\nFrame Time: 0.5\n1 0\n1 90\n";
/// let bvh = sinew_bake::pose::bvh::Bvh::from_bytes("hip.bvh", file)?;
/// let hip = bvh.placed(1)[0];
/// assert_eq!(hip.translation.y, 1.0);
/// assert!(hip.rotation.mul_vec3(bvh.joints[0].ends[0]).distance(glam::DVec3::new(-2.0, 0.0, 0.0)) < 1e-15);
/// # Ok::<(), sinew_bake::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Bvh {
    /// Joints; the root is the first, parents come before their children.
    pub joints: Vec<Joint>,
    /// Seconds between frames.
    pub frame_time: f64,
    /// Values of all channels, frame after frame, in the order of the joints.
    values: Vec<f64>,
}

/// A joint of a BVH file.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Joint {
    /// Name.
    pub name: String,
    /// Index of the parent.
    pub parent: Option<usize>,
    /// Where it is in its parent's frame, the file's unit of length.
    pub offset: DVec3,
    /// Its end sites, in its own frame.
    pub ends: Vec<DVec3>,
    /// What is recorded of it, in the file's order.
    pub channels: Vec<Channel>,
    /// Number of the first of its channels within a frame.
    first: usize,
}

/// A recorded number; the axis is 0 to 2.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Channel {
    /// Translation along an axis.
    Position(usize),
    /// Rotation about an axis, degrees in the file.
    Rotation(usize),
}

/// Where a joint is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Placed {
    /// Translation, the file's unit of length.
    pub translation: DVec3,
    /// Rotation, normalized.
    pub rotation: DQuat,
}

/// Degrees a second beyond which a body does not turn: the fastest in the clips of CMU are near 1,500.
const FASTEST: f64 = 2_000.0;
/// Frames at the start that may belong to a calibration pose.
const CALIBRATION: usize = 8;

impl Bvh {
    /// Reads a file.
    ///
    /// # Errors
    ///
    /// [`Error::Read`]; [`Error::Unusable`] with the line for what is not BVH.
    pub fn read(path: &Path) -> Result<Self, Error> {
        let bytes = std::fs::read(path).map_err(|source| Error::Read { path: path.to_owned(), source })?;
        Self::from_bytes(&path.display().to_string(), &bytes)
    }

    /// Reads the bytes of a file; `name` is for errors. Takes memory in proportion to the bytes at hand, whatever they
    /// promise.
    ///
    /// # Errors
    ///
    /// [`Error::Unusable`] with the line for what is not BVH.
    pub fn from_bytes(name: &str, bytes: &[u8]) -> Result<Self, Error> {
        parse::parse(name, bytes)
    }

    /// Numbers in a frame.
    fn channels(&self) -> usize {
        self.joints.last().map_or(0, |j| j.first + j.channels.len())
    }

    /// Number of frames.
    #[must_use]
    pub fn frames(&self) -> usize {
        self.values.len().checked_div(self.channels()).unwrap_or(0)
    }

    /// Every joint relative to its parent in a frame.
    ///
    /// # Panics
    ///
    /// If there is no such frame.
    #[must_use]
    pub fn local(&self, frame: usize) -> Vec<Placed> {
        let count = self.channels();
        let values = &self.values[frame * count..(frame + 1) * count];
        let place = |joint: &Joint| {
            let (mut translation, mut rotation) = (joint.offset, DQuat::IDENTITY);
            for (channel, value) in joint.channels.iter().zip(&values[joint.first..]) {
                match *channel {
                    Channel::Position(axis) => translation[axis] = *value,
                    Channel::Rotation(axis) => {
                        rotation *= DQuat::from_axis_angle(DVec3::AXES[axis], value.to_radians());
                    }
                }
            }
            Placed { translation, rotation: rotation.normalize() }
        };
        self.joints.iter().map(place).collect()
    }

    /// Every joint in space in a frame.
    ///
    /// # Panics
    ///
    /// If there is no such frame.
    #[must_use]
    pub fn placed(&self, frame: usize) -> Vec<Placed> {
        self.compose(self.local(frame))
    }

    /// Every joint in space with all rotations zero and the root at its offset.
    #[must_use]
    pub fn rest(&self) -> Vec<Placed> {
        let local = |j: &Joint| Placed { translation: j.offset, rotation: DQuat::IDENTITY };
        self.compose(self.joints.iter().map(local).collect())
    }

    fn compose(&self, mut placed: Vec<Placed>) -> Vec<Placed> {
        for i in 0..placed.len() {
            if let Some(parent) = self.joints[i].parent.map(|p| placed[p]) {
                let local = placed[i];
                placed[i] = Placed {
                    translation: parent.translation + parent.rotation * local.translation,
                    rotation: (parent.rotation * local.rotation).normalize(),
                };
            }
        }
        placed
    }

    /// Number of the first frame of the motion itself: many recordings begin with a calibration pose and jump from it
    /// within their first frames, faster than any body.
    #[must_use]
    pub fn first_frame(&self) -> usize {
        let last = self.frames().min(CALIBRATION);
        (1..last).rev().find(|f| self.fastest_turn(*f) > FASTEST).unwrap_or(0)
    }

    /// The fastest turn of a joint relative to its parent on the way to a frame, degrees a second.
    fn fastest_turn(&self, frame: usize) -> f64 {
        let (before, after) = (self.local(frame - 1), self.local(frame));
        let turns = before.iter().zip(&after).map(|(a, b)| super::angle_between(a.rotation, b.rotation));
        turns.fold(0.0, f64::max).to_degrees() / self.frame_time
    }
}
