//! Flesh for skinned characters: bellies, ears, tails and muscles that follow through, per frame,
//! without allocation, with the same bits on every machine.
//!
//! ```text
//! pose ─▶ skin ─▶ dynamics ─▶ embed ─▶ vertex buffers
//! ```
//!
//! Each arrow is one file of [`stage`]; a stage calls a few [`kernel`]s; kernels know only [`math`].
//! [`Character`] runs the arrows in order. Read in that direction.
//!
//! # Conventions
//!
//! Metres, seconds, radians. Right-handed, +Y up, column vectors, quaternions `[x, y, z, w]` (glTF).
//! `root_from_joint` maps joint space to the root's; *bind space* is that of the position attribute,
//! *model space* that of the root. Arrays of vectors are `[[f32; 3]]`. The caller owns all memory.
//!
//! # Determinism contract
//!
//! Same asset, same inputs, same steps: the same bits on every supported target, with or without
//! SIMD, at any optimization level. Only `+ − × ÷ √` and comparisons in `f32`, and elementary functions
//! that are correctly rounded for every input ([`math::rounding`]), are used; sums have one written order.
//! NaN and infinities are refused at the door. A thread that flushes subnormals gets the same bits, for
//! none of them counts ([`kernel::tiny`]); one that does not round to nearest is refused
//! ([`Character::float_environment`]).
#![no_std]
#![cfg_attr(test, allow(clippy::float_cmp, reason = "tests compare bits"))]

#[cfg(feature = "std")]
extern crate std;

#[cfg(all(target_arch = "x86", not(target_feature = "sse2")))]
compile_error!("x87 rounds twice: sinew needs SSE2");

pub mod asset;
mod batch;
mod character;
mod dispatch;
pub mod kernel;
mod lanes;
mod life;
pub mod math;
pub mod replay;
pub mod stage;
mod state;
mod step;
mod tunables;
mod workspace;

pub use asset::{Asset, AssetError};
pub use batch::{Batch, step_batch};
pub use character::Character;
pub use math::affine::Affine;
pub use stage::pose::Root;
pub use state::StateError;
pub use step::{Digests, Pose, StepError, Stepped};
pub use tunables::{Region, TunableError, Tunables};
pub use workspace::LengthError;

/// The README's examples are compiled too.
#[cfg(doctest)]
#[doc = include_str!("../../README.md")]
struct Readme;
