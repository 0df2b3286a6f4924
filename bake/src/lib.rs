//! The baker: rigged characters in, runtime assets out.
//!
//! ```text
//! glTF, VRM, built-in ─▶ import ─▶ Model ─▶ recipe ─▶ pack ─▶ asset (read by the crate `sinew`)
//!                                    │                          │
//!                                    └────────▶ play ◀──────────┘ ─▶ picture, GIF, glTF, array, replay
//! ```

pub mod builtin;
#[cfg(feature = "simulate")]
pub mod cage;
#[cfg(feature = "simulate")]
pub mod dataset;
pub mod error;
pub mod export;
#[cfg(feature = "simulate")]
pub mod fem;
#[cfg(feature = "render")]
pub mod film;
pub mod fit;
pub mod import;
pub mod model;
#[cfg(feature = "simulate")]
pub mod multigrid;
pub mod pack;
pub mod play;
#[cfg(feature = "simulate")]
pub mod pose;
pub mod recipe;
#[cfg(feature = "render")]
pub mod render;
#[cfg(feature = "render")]
pub mod report;
#[cfg(feature = "simulate")]
pub mod simulate;
pub mod tunables;

pub use error::Error;
pub use model::Model;
