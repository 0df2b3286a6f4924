//! Inputs whose value in `f64` lies on the wrong side of the middle between two `f32`, with the right result.
//!
//! Found, and proved to be all, by the sweep over all 2³² inputs: `cargo xtask exhaustive`.

pub(crate) const EXP: [(u32, u32); 0] = [];
pub(crate) const EXPM1: [(u32, u32); 0] = [];
pub(crate) const PHI1: [(u32, u32); 0] = [];
pub(crate) const PHI2: [(u32, u32); 0] = [];
pub(crate) const PHI3: [(u32, u32); 0] = [];
pub(crate) const SIN: [(u32, u32); 0] = [];
pub(crate) const COS: [(u32, u32); 0] = [];
pub(crate) const ACOS: [(u32, u32); 0] = [];
pub(crate) const TANH: [(u32, u32); 0] = [];
pub(crate) const SIGMOID: [(u32, u32); 0] = [];
pub(crate) const GELU: [(u32, u32); 0] = [];
pub(crate) const ENTIRE_C: [(u32, u32); 0] = [];
pub(crate) const ENTIRE_S: [(u32, u32); 0] = [];
pub(crate) const SINHC: [(u32, u32); 0] = [];
pub(crate) const RSQRT: [(u32, u32); 0] = [];
