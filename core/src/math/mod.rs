//! Scalars and small matrices: the bottom layer, known to every other.

pub mod activation;
pub mod affine;
pub mod canary;
pub mod digest;
pub mod entire;
pub mod exp;
pub mod float;
mod hard;
pub mod noise;
pub mod psi;
pub mod quat;
pub mod rounding;
pub mod theta;
pub mod trig;
pub mod twin;
pub mod vec3;
pub mod wide;
