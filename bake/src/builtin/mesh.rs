//! Half of the body's surface as triangles: surface nets, then relaxed onto the implicit surface.
//!
//! ```text
//! samples of the field, x ≥ −h/2 ─▶ surface nets ─▶ (smooth along the surface ─▶ project) × n ─▶ split quads
//! ```
//!
//! The grid straddles `x = 0` with one layer of cells, whose vertices are put on the plane: the half
//! and its mirror image make a closed surface.

use super::shape::Shape;
use crate::pack::narrow;
use fast_surface_nets::ndshape::{RuntimeShape, Shape as _};
use fast_surface_nets::{SurfaceNetsBuffer, surface_nets};
use glam::{DVec3, dvec3};

/// Edge of a grid cell, units.
const CELL: f64 = 0.0305;
/// Lowest corner of the grid; `x` straddles the plane of symmetry.
const LOW: DVec3 = dvec3(-0.5 * CELL, -0.07, -1.05);
/// Highest corner.
const HIGH: DVec3 = dvec3(0.72, 1.70, 0.50);
/// Rounds of relaxation.
const ROUNDS: usize = 14;

/// Half of a surface, `x ≥ 0`.
#[derive(Debug, Default)]
pub(super) struct Half {
    /// Positions; exactly `x = 0` on the seam.
    pub(super) positions: Vec<DVec3>,
    /// Unit normals.
    pub(super) normals: Vec<DVec3>,
    /// Triangles.
    pub(super) triangles: Vec<[usize; 3]>,
    /// Whether a vertex is on the plane of symmetry.
    pub(super) seam: Vec<bool>,
}

impl Half {
    /// Meshes the shape.
    pub(super) fn of(shape: &Shape) -> Self {
        let (mut positions, quads) = nets(shape);
        let seam: Vec<bool> = positions.iter().map(|p| p.x < 0.5 * CELL).collect();
        let ring = neighbors(positions.len(), quads.iter().map(|q| &q[..]));
        let mut normals = vec![DVec3::ZERO; positions.len()];
        settle(shape, &mut positions, &mut normals, &seam);
        for _ in 0..ROUNDS {
            positions = relax(&positions, &normals, &seam, &ring);
            settle(shape, &mut positions, &mut normals, &seam);
        }
        for _ in 0..2 {
            settle(shape, &mut positions, &mut normals, &seam);
        }
        let triangles = quads.iter().flat_map(|q| split(&positions, *q)).collect();
        Self { positions, normals, triangles, seam }
    }

    /// Neighbors of each vertex along edges, in the half.
    pub(super) fn neighbors(&self) -> Vec<Vec<usize>> {
        neighbors(self.positions.len(), self.triangles.iter().map(|t| &t[..]))
    }
}

/// Surface nets of the half: vertices and quads.
fn nets(shape: &Shape) -> (Vec<DVec3>, Vec<[usize; 4]>) {
    let size = ((HIGH - LOW) / CELL).ceil();
    let count = size.to_array().map(whole);
    let grid = RuntimeShape::<u32, 3>::new(count);
    let at = |[x, y, z]: [u32; 3]| LOW + dvec3(f64::from(x), f64::from(y), f64::from(z)) * CELL;
    let samples: Vec<f32> = (0..grid.size()).map(|i| narrow(shape.field(at(grid.delinearize(i))))).collect();
    let mut buffer = SurfaceNetsBuffer::default();
    surface_nets(&samples, &grid, [0; 3], count.map(|n| n - 1), &mut buffer);
    let positions = buffer.positions.iter().zip(&buffer.surface_points);
    let positions = positions
        .map(|(p, cell)| {
            let p = LOW + DVec3::from_array(p.map(f64::from)) * CELL;
            dvec3(if cell[0] == 0 { 0.0 } else { p.x }, p.y, p.z)
        })
        .collect();
    // Two triangles a quad, of which three corners and a diagonal are the first's.
    let quads = buffer.indices.chunks_exact(6).map(|t| {
        let t: [usize; 6] = core::array::from_fn(|k| usize::try_from(t[k]).unwrap_or(0));
        let opposite = t[3..].iter().copied().find(|v| !t[..3].contains(v)).unwrap_or(t[5]);
        let apex = (0..3).find(|k| !t[3..].contains(&t[*k])).unwrap_or(0);
        [t[apex], t[(apex + 1) % 3], opposite, t[(apex + 2) % 3]]
    });
    (positions, quads.collect())
}

#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a small number of cells")]
fn whole(x: f64) -> u32 {
    x as u32
}

/// Neighbors along the edges of polygons, ascending.
fn neighbors<'a>(count: usize, polygons: impl Iterator<Item = &'a [usize]>) -> Vec<Vec<usize>> {
    let mut out = vec![Vec::new(); count];
    for polygon in polygons {
        for (k, &a) in polygon.iter().enumerate() {
            let b = polygon[(k + 1) % polygon.len()];
            out[a].push(b);
            out[b].push(a);
        }
    }
    for row in &mut out {
        row.sort_unstable();
        row.dedup();
    }
    out
}

/// Moves each vertex towards the middle of its neighbors along the surface.
fn relax(positions: &[DVec3], normals: &[DVec3], seam: &[bool], ring: &[Vec<usize>]) -> Vec<DVec3> {
    let moved = |i: usize| {
        let p = positions[i];
        // The mirror images of neighbors cancel in x and count twice in y and z, save those on the plane.
        let weight = |j: usize| if seam[i] && !seam[j] { 2.0 } else { 1.0 };
        let total: f64 = ring[i].iter().map(|j| weight(*j)).sum();
        let sum = ring[i].iter().fold(DVec3::ZERO, |s, j| s + positions[*j] * weight(*j));
        let step = sum / total.max(1.0) - p;
        p + (step - normals[i] * step.dot(normals[i])) * 0.6
    };
    (0..positions.len()).map(moved).collect()
}

/// Draws each vertex to the surface, seam vertices within the plane of symmetry.
fn settle(shape: &Shape, positions: &mut [DVec3], normals: &mut [DVec3], seam: &[bool]) {
    for ((p, normal), seam) in positions.iter_mut().zip(normals).zip(seam) {
        let from = if *seam { p.with_x(0.0) } else { *p };
        (*p, *normal) = on_seam(shape.project(from), *seam);
    }
}

fn on_seam((p, normal): (DVec3, DVec3), seam: bool) -> (DVec3, DVec3) {
    if seam { (p.with_x(0.0), normal.with_x(0.0).normalize_or(DVec3::Y)) } else { (p, normal) }
}

/// Two triangles along the shorter diagonal.
fn split(positions: &[DVec3], [a, b, c, d]: [usize; 4]) -> [[usize; 3]; 2] {
    let square = |i: usize, j: usize| (positions[i] - positions[j]).length_squared();
    if square(a, c) <= square(b, d) { [[a, b, c], [a, c, d]] } else { [[a, b, d], [b, c, d]] }
}
