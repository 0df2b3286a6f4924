//! A body against its own surface: how near, how steep, and how far until it touches.
//!
//! ```text
//! Surface ─▶ near: pairs of points and triangles, of edges and edges ─▶ distance ─▶ barrier, mollifier: energy
//!                                                                  └──▶ advance: largest part of a step
//! ```
//!
//! After incremental potential contact (Li et al. 2020: Incremental Potential Contact): an energy that is infinite where
//! surfaces touch and zero from a small distance on, and steps that end before anything touches. What does not cross at
//! first then never does.

pub mod advance;
pub mod barrier;
pub mod distance;
pub mod mollifier;
pub mod near;
pub mod pair;

#[cfg(test)]
mod cases;
