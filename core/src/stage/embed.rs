//! Offsets in, vertex buffers out: bind-space positions and normals of the render vertices.

use crate::kernel::normal::{self, Stencils};
use crate::math::vec3;

/// What the render mesh needs of an asset.
#[derive(Clone, Copy, Debug)]
pub struct Surface<'a> {
    /// Rest position of each point, bind space.
    pub rest: &'a [[f32; 3]],
    /// Rest normal of each vertex, bind space.
    pub normals: &'a [[f32; 3]],
    /// Point of each vertex.
    pub point_of_vertex: &'a [u32],
    /// Vertices on moving points.
    pub moved: &'a [u32],
    /// Vertices whose normals turn.
    pub stencils: Stencils<'a>,
}

/// Fills both buffers with the rest shape.
///
/// # Panics
///
/// If the lengths differ.
pub fn rest(surface: Surface<'_>, positions: &mut [[f32; 3]], normals: &mut [[f32; 3]]) {
    assert!(positions.len() == surface.point_of_vertex.len(), "embed: lengths differ");
    for (position, point) in positions.iter_mut().zip(surface.point_of_vertex) {
        *position = surface.rest[*point as usize];
    }
    normals.copy_from_slice(surface.normals);
}

/// Writes the positions and normals that `offsets` (bind space, one a moving point) change.
///
/// # Panics
///
/// If an index is out of range.
pub fn embed(
    surface: Surface<'_>,
    offsets: &[[f32; 3]],
    positions: &mut [[f32; 3]],
    normals: &mut [[f32; 3]],
) {
    for vertex in surface.moved {
        let point = surface.point_of_vertex[*vertex as usize] as usize;
        positions[*vertex as usize] = vec3::add(surface.rest[point], offsets[point]);
    }
    normal::turn(surface.stencils, surface.point_of_vertex, surface.normals, offsets, normals);
}
