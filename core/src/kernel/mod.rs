//! One algorithm a file: free functions over slices, the equation above each.

pub mod blend;
pub mod block;
pub mod cg;
pub mod clip;
pub mod cofactor;
pub(crate) mod copy;
pub mod csr;
pub mod ldl;
pub mod load;
pub mod mlp;
pub mod multigrid;
pub mod normal;
pub mod skin;
pub mod spring;
pub mod target;
pub mod tiny;
pub mod unskin;
