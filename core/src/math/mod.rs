//! Scalars and small matrices: the bottom layer, known to every other.

pub mod affine;
pub mod canary;
pub mod digest;
pub mod float;
pub mod noise;
pub mod psi;
pub mod quat;
pub mod vec3;
