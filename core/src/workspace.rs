//! The caller's memory, split once into the arrays of a character.

use crate::asset::Asset;
use crate::kernel::skin::{BLOCK, LinearBlock, Rows};
use crate::math::affine::Affine;
use crate::stage::dynamics::springs::State;
use core::fmt;

/// A buffer of the wrong length.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LengthError {
    /// Elements needed.
    pub expected: usize,
    /// Elements given.
    pub found: usize,
}

impl LengthError {
    /// Stable name of the error, for programs; its text may change, this does not.
    #[must_use]
    pub const fn code(&self) -> &'static str {
        "BUFFER_WRONG_LENGTH"
    }
}

impl fmt::Display for LengthError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "buffer has {} elements, {} are needed", self.found, self.expected)
    }
}

impl core::error::Error for LengthError {}

/// Floats of a block's linear maps.
const LINEAR: usize = 9 * BLOCK;

/// Arrays of a character in the caller's memory.
#[derive(Debug)]
pub(crate) struct Workspace<'a> {
    /// State of the moving points.
    pub(crate) state: State<'a>,
    /// Offsets shown, bind space.
    pub(crate) offsets: &'a mut [[f32; 3]],
    /// Targets of the step in work; they change places with those of [`State`].
    pub(crate) targets: &'a mut [[f32; 3]],
    /// Accelerations of the step in work; they too.
    pub(crate) f: &'a mut [[f32; 3]],
    /// Linear parts of the blended maps.
    pub(crate) linear: &'a mut [LinearBlock],
    /// Render positions, bind space.
    pub(crate) positions: &'a mut [[f32; 3]],
    /// Render normals, bind space.
    pub(crate) normals: &'a mut [[f32; 3]],
    /// Map of each joint.
    pub(crate) palette: &'a mut [Rows],
    /// Sampled joints.
    pub(crate) joints: &'a mut [Affine],
    /// Sampled local transforms.
    pub(crate) local: &'a mut [[f32; 10]],
    /// Composed transforms of nodes.
    pub(crate) model: &'a mut [Affine],
}

/// Takes `n` elements of `N` floats from the front of `buffer`.
fn take<'a, const N: usize>(buffer: &mut &'a mut [f32], n: usize) -> &'a mut [[f32; N]] {
    let (head, rest) = core::mem::take(buffer).split_at_mut_checked(n * N).unwrap_or_default();
    *buffer = rest;
    head.as_chunks_mut().0
}

impl<'a> Workspace<'a> {
    /// Floats needed for `asset`.
    pub(crate) fn required_len(asset: &Asset<'_>) -> usize {
        let m = &asset.meta;
        let [active, vertices, joints, nodes] = [m.active, m.vertices, m.joints, m.nodes].map(|n| n as usize);
        active * (8 * 3)
            + active.div_ceil(BLOCK) * LINEAR
            + vertices * 6
            + joints * (12 + 12)
            + nodes * (10 + 12)
    }

    /// Splits `buffer`.
    pub(crate) fn new(asset: &Asset<'_>, buffer: &'a mut [f32]) -> Result<Self, LengthError> {
        let (expected, found) = (Self::required_len(asset), buffer.len());
        if expected != found {
            return Err(LengthError { expected, found });
        }
        buffer.fill(0.0);
        let m = &asset.meta;
        let [active, vertices, joints, nodes] = [m.active, m.vertices, m.joints, m.nodes].map(|n| n as usize);
        let buffer = &mut { buffer };
        Ok(Self {
            // Wide elements first: they keep the alignment of the buffer.
            palette: bytemuck::cast_slice_mut(take::<12>(buffer, joints)),
            linear: bytemuck::cast_slice_mut(take::<LINEAR>(buffer, active.div_ceil(BLOCK))),
            joints: bytemuck::cast_slice_mut(take::<12>(buffer, joints)),
            model: bytemuck::cast_slice_mut(take::<12>(buffer, nodes)),
            state: State {
                x: take(buffer, active),
                y: take(buffer, active),
                v: take(buffer, active),
                slope: take(buffer, active),
                f: take(buffer, active),
            },
            offsets: take(buffer, active),
            targets: take(buffer, active),
            f: take(buffer, active),
            positions: take(buffer, vertices),
            normals: take(buffer, vertices),
            local: take(buffer, nodes),
        })
    }
}
