//! A quantised multilayer perceptron: int8 weights and inputs, int32 sums, a fixed sequence of `f32` operations around.
//!
//! ```text
//! q = round(x / s)          inputs, one scale s a layer            [`quantize`]
//! z = W·q                   int32, exact                           [`dot`]
//! y = σ(N((w·s)·z + b))     a scale w and a bias b a row, a norm N, an activation σ   [`dense`], [`norm`]
//! ```
//!
//! Integers do not round and the rest rounds in one written order, so the bits are the same everywhere, whatever
//! the vector registers. [`Dense`] has its sizes in its type and cannot fail; [`Layer`] borrows weights from a file.

pub mod dense;
pub mod dot;
pub mod norm;
pub mod quantize;

pub use dense::{Activation, Dense, Layer, ShapeError};
pub use norm::Norm;
