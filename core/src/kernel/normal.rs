//! Normals of a surface whose points were offset.
//!
//! ```text
//! n = (n₀ − ∇ₛ(o·n₀)) / |…|,    ∇ₛφ at a vertex = Σₖ gₖ·(φ(pₖ) − φ(p)),    k = 1 … 4
//! ```
//!
//! First order in the slope of the offset field. The tangent vectors `gₖ` and the points `pₖ` are
//! baked from the triangles around the vertex, so hard edges stay hard.

use super::tiny::flush_all;
use crate::math::vec3;

/// Tangent stencil of a vertex.
#[derive(Clone, Copy, Debug)]
pub struct Stencils<'a> {
    /// Vertices whose normals move.
    pub vertices: &'a [u32],
    /// Four neighbouring points of each; an unused place repeats the vertex's own point.
    pub points: &'a [[u32; 4]],
    /// Tangent vectors `g`, per unit of bind space; zero where unused.
    pub tangents: &'a [[[f32; 3]; 4]],
}

/// Turns the normals of the stencils' vertices; others are left alone.
///
/// * `rest`: unit normals of all vertices, bind space.
/// * `offsets`: of the moving points, bind space; a point beyond its end does not move.
///
/// A vertex beyond the end of a slice is left alone.
pub fn turn(
    stencils: Stencils<'_>,
    point_of_vertex: &[u32],
    rest: &[[f32; 3]],
    offsets: &[[f32; 3]],
    normals: &mut [[f32; 3]],
) {
    let offset = |p: u32| offsets.get(p as usize).copied().unwrap_or([0.0; 3]);
    for ((vertex, points), tangents) in stencils.vertices.iter().zip(stencils.points).zip(stencils.tangents) {
        let vertex = *vertex as usize;
        let of_vertex = (rest.get(vertex), point_of_vertex.get(vertex), normals.get_mut(vertex));
        let (Some(n), Some(point), Some(normal)) = of_vertex else { continue };
        let (n, own) = (*n, vec3::dot(offset(*point), *n));
        let mut turned = n;
        for (p, g) in points.iter().zip(tangents) {
            turned = vec3::sub(turned, vec3::scale(*g, vec3::dot(offset(*p), n) - own));
        }
        *normal = vec3::normalize_or(flush_all(turned), n);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A plane tilted by its offsets: the exact normal to second order of the slope.
    #[test]
    fn a_tilted_plane_turns_its_normal() {
        let slope = 0.01_f32;
        let points = [[1, 2, 3, 4]];
        let tangents = [[[0.5, 0.0, 0.0], [-0.5, 0.0, 0.0], [0.0, 0.0, 0.5], [0.0, 0.0, -0.5]]];
        let offsets =
            [[0.0, 0.0, 0.0], [0.0, slope, 0.0], [0.0, -slope, 0.0], [0.0, 0.0, 0.0], [0.0, 0.0, 0.0]];
        let mut normals = [[9.0; 3]; 2];
        let stencils = Stencils { vertices: &[1], points: &points, tangents: &tangents };
        turn(stencils, &[0, 0], &[[0.0, 1.0, 0.0]; 2], &offsets, &mut normals);
        let want = vec3::normalize_or([-slope, 1.0, 0.0], [0.0; 3]);
        assert!(vec3::dot(normals[1], want) > 1.0 - 1e-7, "{:?}", normals[1]);
        assert_eq!(normals[0], [9.0; 3]);
    }
}
