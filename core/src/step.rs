//! What goes into a step and what comes out of it.

use crate::math::affine::{self, Affine};
use crate::math::digest::Digest;
use crate::math::float;
use crate::stage::dynamics::springs::State;
use crate::stage::pose::Root;
use crate::workspace::{LengthError, Workspace};
use core::fmt;

/// What moves the character in a step.
#[derive(Clone, Copy, Debug)]
pub struct Pose<'a> {
    /// Where the root is in the world.
    pub root: Root,
    /// Transform of every joint relative to the root, in the asset's order.
    pub root_from_joint: &'a [Affine],
}

/// Why a step was refused; the state is as it was.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum StepError {
    /// `dt` is NaN or infinite.
    TimeNotFinite,
    /// The root is not finite, or its rotation is zero.
    BadRoot,
    /// The pose has another number of joints than the asset.
    JointCount(LengthError),
    /// A joint's transform is not finite or larger than `1e7`, or with its inverse bind matrix larger than `1e9`.
    BadJoint(u32),
    /// The asset has no such clip.
    NoSuchClip(u32),
    /// The thread does not round to nearest: its [`crate::math::canary`] word. Results would differ from those of
    /// every other machine.
    FloatEnvironment(u32),
}

impl StepError {
    /// Stable name of the error, for programs; its text may change, this does not.
    #[must_use]
    pub const fn code(&self) -> &'static str {
        match self {
            Self::TimeNotFinite => "STEP_TIME_NOT_FINITE",
            Self::BadRoot => "STEP_BAD_ROOT",
            Self::JointCount(_) => "STEP_JOINT_COUNT",
            Self::BadJoint(_) => "STEP_BAD_JOINT",
            Self::NoSuchClip(_) => "STEP_NO_SUCH_CLIP",
            Self::FloatEnvironment(_) => "STEP_FLOAT_ENVIRONMENT",
        }
    }
}

impl fmt::Display for StepError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::TimeNotFinite => write!(f, "dt is not a finite number of seconds"),
            Self::BadRoot => write!(f, "the root's transform is not finite, or its rotation is zero"),
            Self::JointCount(LengthError { expected, found }) => {
                write!(f, "the pose has {found} joints, the asset has {expected}")
            }
            Self::BadJoint(i) => write!(f, "the transform of joint {i} is not finite or too large"),
            Self::NoSuchClip(i) => write!(f, "the asset has no clip {i}"),
            Self::FloatEnvironment(word) => {
                write!(
                    f,
                    "this thread does not round to nearest (canary {word:07b}): restore its float environment"
                )
            }
        }
    }
}

impl core::error::Error for StepError {}

/// Largest entry of a joint's transform.
const LARGEST_JOINT: f32 = 1e7;
/// Largest entry of a joint's map from bind space. With an asset's largest numbers and the stiffest springs the
/// state stays below 1e32 over any time that a character lives.
const LARGEST_MAP: f32 = 1e9;

/// Fails at the first joint whose transform, or whose map from bind space, is not finite or too large.
pub(crate) fn check_joints(root_from_joint: &[Affine], joint_from_bind: &[Affine]) -> Result<(), StepError> {
    let within = |m: &Affine, most: f32| m.as_flattened().iter().all(|x| float::abs(*x) <= most);
    let usable = |(a, b)| within(a, LARGEST_JOINT) && within(&affine::mul(a, b), LARGEST_MAP);
    match root_from_joint.iter().zip(joint_from_bind).position(|pair| !usable(pair)) {
        None => Ok(()),
        Some(i) => Err(StepError::BadJoint(u32::try_from(i).unwrap_or(u32::MAX))),
    }
}

/// What a step did.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stepped {
    /// The flesh advanced: the buffers are new.
    Advanced,
    /// Nothing was due; the time is kept for the next step.
    Held,
}

/// Digests of what each stage made in the last step.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Digests {
    /// Palette.
    pub pose: u64,
    /// Targets and accelerations.
    pub skin: u64,
    /// State of the springs.
    pub dynamics: u64,
    /// Offsets, positions and normals.
    pub embed: u64,
}

impl Digests {
    /// Digests of the arrays of a character.
    pub(crate) fn of(m: &Workspace<'_>) -> Self {
        Self {
            pose: digest_of(&[m.palette.as_flattened().as_flattened()]),
            skin: digest_of(&[m.state.x.as_flattened(), m.state.f.as_flattened()]),
            dynamics: Self::of_dynamics(&m.state).dynamics,
            embed: digest_of(&[
                m.offsets.as_flattened(),
                m.positions.as_flattened(),
                m.normals.as_flattened(),
            ]),
        }
    }

    /// That of the dynamics alone; the others are 0.
    pub(crate) fn of_dynamics(state: &State<'_>) -> Self {
        Self { dynamics: digest_of(&state.arrays().map(<[_]>::as_flattened)), ..Self::default() }
    }
}

fn digest_of(arrays: &[&[f32]]) -> u64 {
    let mut digest = Digest::default();
    arrays.iter().for_each(|a| digest.floats(a));
    digest.finish()
}
