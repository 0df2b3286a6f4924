//! Offsets in, vertex buffers out: bind-space positions and normals of the render vertices.

use crate::kernel::copy::copy;
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

/// Fills both buffers with the rest shape, as far as they reach.
pub fn rest(surface: Surface<'_>, positions: &mut [[f32; 3]], normals: &mut [[f32; 3]]) {
    for (position, point) in positions.iter_mut().zip(surface.point_of_vertex) {
        *position = surface.rest.get(*point as usize).copied().unwrap_or(*position);
    }
    copy(surface.normals, normals);
}

/// Writes the positions and normals that `offsets` (bind space, one a moving point) change.
///
/// A vertex with an index out of range (a parsed asset holds none) is left alone.
pub fn embed(
    surface: Surface<'_>,
    offsets: &[[f32; 3]],
    positions: &mut [[f32; 3]],
    normals: &mut [[f32; 3]],
) {
    for vertex in surface.moved {
        let vertex = *vertex as usize;
        let Some(point) = surface.point_of_vertex.get(vertex).map(|point| *point as usize) else { continue };
        let moved = (positions.get_mut(vertex), surface.rest.get(point), offsets.get(point));
        if let (Some(position), Some(rest), Some(offset)) = moved {
            *position = vec3::add(*rest, *offset);
        }
    }
    normal::turn(surface.stencils, surface.point_of_vertex, surface.normals, offsets, normals);
}
