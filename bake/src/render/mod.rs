//! Pictures: a small software renderer, contact sheets and GIFs.
//!
//! Characters are drawn as triangles into a depth buffer at twice the size, lit by a warm key, a cool
//! fill and a rim, on plain ground with a soft shadow. The crates that rasterize (`euc`, `tiny-skia`)
//! bring either no lighting or no depth; two hundred lines here do all of it without threads.

mod camera;
mod gif;
mod label;
mod raster;
mod scene;
mod sheet;

pub use camera::Camera;
pub use gif::Gif;
pub use raster::Canvas;
pub use scene::{Drawn, Look, Scene};
pub use sheet::{contact_sheet, png};
