//! Pictures of characters: a small software renderer, contact sheets and animated pictures.
//!
//! ```text
//! surfaces ─▶ scene ─▶ raster (which triangle does a sample see?) ─▶ shade (lamps, sky, ground) ─▶ picture
//!                └───▶ light  (what do the lamps and the sky see?) ─┘
//! ```
//!
//! Pictures depend on the arguments alone: not on the host, nor on the number of threads.

mod animation;
mod camera;
mod color;
mod figure;
mod light;
mod palette;
mod raster;
mod scene;
mod shade;
mod sheet;
mod text;
mod texture;

pub use animation::{GifWriter, MAX_GIF_FPS, gif_stride};
pub use camera::{Camera, Framing};
pub use color::{heat as heat_color, linear};
pub use figure::{Figure, Pose, Show};
pub use shade::render;
pub use sheet::{Legend, Row, Sheet, contact_sheet, encode_png, side_by_side, write_png};
pub use texture::Texture;

/// A triangle mesh with a paint.
#[derive(Clone, Copy, Debug)]
pub struct Surface<'a> {
    /// Positions, model space.
    pub positions: &'a [[f32; 3]],
    /// Unit normals, one a vertex.
    pub normals: &'a [[f32; 3]],
    /// Texture coordinates, one a vertex; may be empty.
    pub uvs: &'a [[f32; 2]],
    /// Triangles.
    pub triangles: &'a [[u32; 3]],
    /// Color.
    pub paint: Paint<'a>,
    /// Whether the inner side is drawn.
    pub double_sided: bool,
}

/// What a surface looks like.
#[derive(Clone, Copy, Debug)]
pub enum Paint<'a> {
    /// One linear color.
    Flat([f32; 3]),
    /// A texture, multiplied by a linear color.
    Texture {
        /// Image.
        texture: &'a Texture,
        /// Linear color.
        factor: [f32; 3],
    },
    /// A heat `0..=1` a vertex, in the colors of [`heat_color`].
    Heat(&'a [f32]),
    /// A linear color a vertex, lit as evenly as heat.
    Colors(&'a [[f32; 3]]),
}

#[cfg(test)]
mod tests;
