//! One algorithm a file: free functions over slices, the equation above each.

pub mod blend;
pub mod clip;
pub mod cofactor;
pub(crate) mod copy;
pub mod load;
pub mod mlp;
pub mod normal;
pub mod skin;
pub mod spring;
pub mod target;
pub mod tiny;
pub mod unskin;
