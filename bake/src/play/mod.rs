//! Runs the runtime on a clip and hands out its frames.

mod shake;

use crate::model::{Model, Node, Property};
use crate::{Error, pack};
use glam::{DMat4, DQuat, DVec3};
use sinew::kernel::clip::Channels;
use sinew::kernel::clip::{Interpolation, Keys};
use sinew::replay::{Finished, RecordError, Tape};
use sinew::stage::pose::{self, Skeleton};
use sinew::{Affine, Asset, Character, Pose, Root, Tunables};

pub use shake::shake;

/// What to play.
#[derive(Clone, Debug)]
pub struct Settings {
    /// Name of the clip; the first where it is `None`. A character without clips is shaken.
    pub clip: Option<String>,
    /// Frames a second.
    pub fps: f32,
    /// Length, s; where it is `None` one round of the clip, at least two seconds.
    pub seconds: Option<f32>,
    /// Tunables; the asset's where it is `None`.
    pub tunables: Option<Tunables>,
}

impl Default for Settings {
    fn default() -> Self {
        Self { clip: None, fps: 60.0, seconds: None, tunables: None }
    }
}

/// The motion that was chosen.
#[derive(Clone, Debug, PartialEq)]
pub enum Motion {
    /// A clip of the asset, by index.
    Clip {
        /// Index.
        index: u32,
        /// Name.
        name: String,
        /// Length, s.
        duration: f32,
        /// Whether its end meets its beginning.
        looped: bool,
    },
    /// The built-in shake of the root.
    Shake,
}

impl Motion {
    /// The clip's name, or what the shake is called.
    #[must_use]
    pub fn name(&self) -> &str {
        match self {
            Self::Clip { name, .. } => name,
            Self::Shake => "built-in shake",
        }
    }
}

/// One frame of a character, model space.
#[derive(Clone, Debug, Default)]
pub struct Frame {
    /// Number of the frame.
    pub index: u32,
    /// Time, s.
    pub time: f32,
    /// Positions with flesh, render vertices in the order of the primitives.
    pub flesh: Vec<[f32; 3]>,
    /// Normals with flesh.
    pub flesh_normals: Vec<[f32; 3]>,
    /// Positions of skinning alone.
    pub skinned: Vec<[f32; 3]>,
    /// Normals of skinning alone.
    pub skinned_normals: Vec<[f32; 3]>,
    /// Distance between the two, body sizes.
    pub heat: Vec<f32>,
    /// Where the root is; already applied to the positions.
    pub root: Root,
    /// Transforms of the nodes of [`Model::rigid`], one each.
    pub rigid: Vec<DMat4>,
}

/// A character on a motion.
#[derive(Debug)]
pub struct Player<'a> {
    model: &'a Model,
    character: Character<'a>,
    /// What is played.
    pub motion: Motion,
    /// Frames a second.
    pub fps: f32,
    /// Number of frames.
    pub frames: u32,
    next: u32,
    frame: Frame,
    /// Joints in the rest pose, relative to the root.
    rest: Vec<Affine>,
    tape: Option<Tape<Vec<u8>>>,
}

/// Frames between the snapshots of a recording.
const SNAPSHOT_EVERY: u32 = 60;

impl<'a> Player<'a> {
    /// Prepares `asset` of `model` in `memory` (see [`Character::required_len`]).
    ///
    /// # Errors
    ///
    /// [`Error::Unusable`] for a clip that does not exist, numbers out of range, or an asset of another model.
    pub fn new(
        model: &'a Model,
        asset: Asset<'a>,
        memory: &'a mut [f32],
        settings: &Settings,
    ) -> Result<Self, Error> {
        let name = model.name.as_str();
        let refuse =
            |place: &str, problem: String, remedy: &str| Error::unusable(name, place, problem, remedy);
        if asset.meta.vertices as usize != model.vertex_count() {
            let problem =
                format!("it has {} vertices, the asset {}", model.vertex_count(), asset.meta.vertices);
            return Err(refuse("asset", problem, "bake this file again"));
        }
        if !(1.0..=1000.0).contains(&settings.fps) {
            return Err(refuse("--fps", format!("{} is out of range", settings.fps), "give 1 to 1000"));
        }
        let motion = choose(&asset, model, settings.clip.as_deref())?;
        let seconds = match (settings.seconds, &motion) {
            (Some(s), _) => s,
            (None, Motion::Shake) => 4.0,
            (None, Motion::Clip { duration, .. }) if *duration > 0.0 => {
                duration * libm::ceilf(2.0 / duration).max(1.0)
            }
            (None, Motion::Clip { .. }) => 2.0,
        };
        if !(seconds > 0.0 && seconds <= 3600.0) {
            return Err(refuse("--seconds", format!("{seconds} is out of range"), "give up to 3600"));
        }
        let mut character = Character::new(asset, memory)
            .map_err(|e| refuse("memory", e.to_string(), "please report this"))?;
        if let Some(tunables) = &settings.tunables {
            character.set_tunables(tunables).map_err(|e| {
                refuse("tunables", e.to_string(), "see the ranges of Tunables").coded(e.code())
            })?;
        }
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "at most 3.6 million")]
        let frames = libm::roundf(seconds * settings.fps).max(1.0) as u32;
        let mut player = Self {
            model,
            character,
            motion,
            fps: settings.fps,
            frames,
            next: 0,
            frame: Frame::default(),
            rest: rest_joints(&asset),
            tape: None,
        };
        player.warm_up()?;
        Ok(player)
    }

    /// Plays a looped clip twice beforehand, so that the first frame does not pop and the last meets it.
    fn warm_up(&mut self) -> Result<(), Error> {
        if let Motion::Clip { index, looped: true, .. } = self.motion {
            let step = 1.0 / self.fps;
            self.character.warm_up(index, 2, Root::default(), step).map_err(|e| self.failed(e))?;
        }
        Ok(())
    }

    fn failed(&self, error: impl Into<RecordError>) -> Error {
        let (place, error) = (format!("frame {}", self.next), error.into());
        Error::unusable(self.model.name.as_str(), place, error.to_string(), "check the clip of this file")
            .coded(error.code())
    }

    /// Records from here on.
    ///
    /// # Errors
    ///
    /// [`Error::Unusable`] when the recorder cannot start.
    pub fn record(&mut self) -> Result<(), Error> {
        let tape = Tape::begin(&self.character, SNAPSHOT_EVERY, Vec::new()).map_err(|e| self.failed(e))?;
        self.tape = Some(tape);
        Ok(())
    }

    /// Ends the recording: its bytes, number of frames and digest.
    ///
    /// # Errors
    ///
    /// [`Error::Unusable`] when nothing was recorded.
    pub fn recorded(&mut self) -> Result<(Vec<u8>, Finished), Error> {
        let tape = self.tape.take().ok_or_else(|| {
            Error::unusable(&self.model.name, "replay", "nothing was recorded", "call `record` first")
        })?;
        tape.finish(&self.character).map_err(|e| self.failed(e))
    }

    /// The character.
    #[must_use]
    pub fn character(&self) -> &Character<'a> {
        &self.character
    }

    /// What is played, for people: clip, number of frames, rate.
    #[must_use]
    pub fn describe(&self) -> String {
        format!("{}, {} frames at {} Hz", self.motion.name(), self.frames, self.fps)
    }

    /// The pose of frame `i`: time in the clip and root.
    #[must_use]
    pub fn pose(&self, i: u32) -> (f32, Root) {
        #[allow(clippy::cast_precision_loss, reason = "at most 3.6 million")]
        let time = i as f32 / self.fps;
        match &self.motion {
            Motion::Clip { duration, .. } if *duration > 0.0 => (time % duration, Root::default()),
            Motion::Clip { .. } => (0.0, Root::default()),
            Motion::Shake => (time, shake(time, self.character.asset().meta.body_size)),
        }
    }

    /// The next frame, or `None` after the last.
    ///
    /// # Errors
    ///
    /// [`Error::Unusable`] for a clip whose values leave the range of the runtime.
    #[allow(clippy::should_implement_trait, reason = "frames borrow the player")]
    pub fn next(&mut self) -> Result<Option<&Frame>, Error> {
        if self.next == self.frames {
            return Ok(None);
        }
        let (time, root) = self.pose(self.next);
        let dt = 1.0 / self.fps;
        let (character, still) = (&mut self.character, Pose { root, root_from_joint: &self.rest });
        let stepped = match (&self.motion, &mut self.tape) {
            (Motion::Clip { index, .. }, None) => {
                character.step_clip(*index, time, root, dt).map_err(RecordError::from)
            }
            (Motion::Clip { index, .. }, Some(tape)) => tape.step_clip(character, *index, time, root, dt),
            (Motion::Shake, None) => character.step(still, dt).map_err(RecordError::from),
            (Motion::Shake, Some(tape)) => tape.step(character, still, dt),
        };
        stepped.map_err(|e| self.failed(e))?;
        self.fill(time, root);
        self.next += 1;
        Ok(Some(&self.frame))
    }

    fn fill(&mut self, time: f32, root: Root) {
        let n = self.model.vertex_count();
        let frame = &mut self.frame;
        (frame.index, frame.time, frame.root) = (self.next, time, root);
        for buffer in [&mut frame.flesh, &mut frame.flesh_normals] {
            buffer.resize(n, [0.0; 3]);
        }
        for buffer in [&mut frame.skinned, &mut frame.skinned_normals] {
            buffer.resize(n, [0.0; 3]);
        }
        for (flesh, positions, normals) in [
            (true, &mut frame.flesh, &mut frame.flesh_normals),
            (false, &mut frame.skinned, &mut frame.skinned_normals),
        ] {
            let skinned = self.character.skin_surface(flesh, positions, normals);
            debug_assert!(skinned.is_ok(), "a model and its asset have as many vertices");
        }
        let size = self.character.asset().meta.body_size;
        let distance = |(a, b): (&[f32; 3], &[f32; 3])| {
            let d = [0, 1, 2].map(|i| a[i] - b[i]);
            libm::sqrtf(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]) / size
        };
        frame.heat.clear();
        frame.heat.extend(frame.flesh.iter().zip(&frame.skinned).map(distance));
        place(frame, &root);
        let clip = match self.motion {
            Motion::Clip { index, .. } => self.model.clips.get(index as usize),
            Motion::Shake => None,
        };
        frame.rigid = rigid(self.model, clip, time, &root);
    }
}

/// Joints of the rest pose, by the runtime's own composition.
fn rest_joints(asset: &Asset<'_>) -> Vec<Affine> {
    let identity = sinew::math::affine::IDENTITY;
    let skeleton = Skeleton { parents: asset.parents, rest: asset.node_rest, joint_node: asset.joint_node };
    let (mut local, mut model) = (vec![[0.0; 10]; asset.parents.len()], vec![identity; asset.parents.len()]);
    let mut out = vec![identity; asset.joint_node.len()];
    pose::sample(skeleton, Channels::default(), 0.0, &mut out, (&mut local, &mut model));
    out
}

/// Root-space positions to model space, where the root moves.
fn place(frame: &mut Frame, root: &Root) {
    if *root == Root::default() {
        return;
    }
    let world = root_transform(root);
    let buffers =
        [(&mut frame.flesh, &mut frame.flesh_normals), (&mut frame.skinned, &mut frame.skinned_normals)];
    for (positions, normals) in buffers {
        for p in positions {
            *p = world.transform_point3(DVec3::from_array(p.map(f64::from))).to_array().map(pack::narrow);
        }
        for n in normals {
            *n = world.transform_vector3(DVec3::from_array(n.map(f64::from))).to_array().map(pack::narrow);
        }
    }
}

fn root_transform(root: &Root) -> DMat4 {
    let rotation = DQuat::from_array(root.rotation.map(f64::from)).normalize();
    DMat4::from_rotation_translation(rotation, DVec3::from_array(root.translation))
}

/// The motion that `name` asks for.
fn choose(asset: &Asset<'_>, model: &Model, name: Option<&str>) -> Result<Motion, Error> {
    let index = match name {
        None if asset.meta.clips == 0 => return Ok(Motion::Shake),
        None => 0,
        Some(name) => model.clips.iter().position(|c| c.name == name).ok_or_else(|| {
            let names: Vec<_> = model.clips.iter().map(|c| c.name.as_str()).collect();
            let remedy = if names.is_empty() {
                "the file has no clips: leave --clip out to shake it".to_owned()
            } else {
                format!("choose one of: {}", names.join(", "))
            };
            Error::unusable(model.name.as_str(), "--clip", format!("there is no clip `{name}`"), remedy)
        })?,
    };
    let clip = &model.clips[index];
    Ok(Motion::Clip {
        index: u32::try_from(index).unwrap_or(u32::MAX),
        name: clip.name.clone(),
        duration: clip.duration,
        looped: is_looped(model, index, f64::from(asset.meta.body_size)),
    })
}

/// Whether every joint is within 1 % of the body of where it began when the clip ends.
fn is_looped(model: &Model, index: usize, body_size: f64) -> bool {
    let clip = &model.clips[index];
    let (first, last) = (transforms(model, Some(clip), 0.0), transforms(model, Some(clip), clip.duration));
    clip.duration > 0.0
        && model.joints.iter().all(|j| {
            let (a, b) = (first[j.node].w_axis, last[j.node].w_axis);
            (a - b).length() < 0.01 * body_size
        })
}

/// Transforms of all nodes at time `t` of a clip, model from node.
fn transforms(model: &Model, clip: Option<&crate::model::Clip>, t: f32) -> Vec<DMat4> {
    let local: Vec<DMat4> = nodes_at(model, clip, t).iter().map(Node::parent_from_node).collect();
    model.compose(&local)
}

/// All nodes of a model as a clip has them at time `t`, s.
pub(crate) fn nodes_at(model: &Model, clip: Option<&crate::model::Clip>, t: f32) -> Vec<Node> {
    let mut nodes = model.nodes.clone();
    for c in clip.iter().flat_map(|c| &c.channels) {
        let interpolation = match c.interpolation {
            crate::model::Interpolation::Step => Interpolation::Step,
            crate::model::Interpolation::Linear => Interpolation::Linear,
            crate::model::Interpolation::CubicSpline => Interpolation::CubicSpline,
        };
        let keys = Keys { interpolation, times: &c.times, values: &c.values };
        let vector = |v: [f32; 3]| DVec3::from_array(v.map(f64::from));
        let node = &mut nodes[c.node];
        match c.property {
            Property::Translation => node.translation = vector(keys.sample::<3>(t)),
            Property::Scale => node.scale = vector(keys.sample::<3>(t)),
            Property::Rotation => {
                node.rotation = DQuat::from_array(keys.sample_rotation(t).map(f64::from)).normalize();
            }
        }
    }
    nodes
}

/// Transforms of the rigid meshes' nodes.
fn rigid(model: &Model, clip: Option<&crate::model::Clip>, t: f32, root: &Root) -> Vec<DMat4> {
    if model.rigid.is_empty() {
        return Vec::new();
    }
    let (world, nodes) = (root_transform(root), transforms(model, clip, t));
    model.rigid.iter().map(|r| world * nodes[r.node]).collect()
}
