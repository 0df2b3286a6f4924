//! A lattice of cubes around a surface, and which cubes a triangle touches.
//!
//! A cube and a triangle are apart if the projections on one of 13 axes are: the cube's three, the triangle's normal,
//! and nine products of an edge and a cube's axis (Akenine-Möller, Fast 3D triangle-box overlap testing, 2001).

use super::surface::Surface;
use crate::Error;
use core::ops::Range;
use glam::DVec3;

/// Cubes are smaller by this share, so that a triangle which only meets the side of one does not touch it.
const SHRINK: f64 = 1e-10;
/// Most cubes of a lattice.
const MOST: f64 = 134_217_728.0;

/// Cubes in rows along x, then y, then z.
#[derive(Clone, Debug)]
pub(super) struct Lattice {
    /// The corner with the smallest coordinates, m.
    pub(super) corner: DVec3,
    /// Edge of a cube, m.
    pub(super) edge: f64,
    /// Cubes along each axis.
    pub(super) cells: [usize; 3],
}

impl Lattice {
    /// The smallest lattice around a surface with the surface in its middle.
    pub(super) fn around(surface: &Surface, edge: f64) -> Result<Self, Error> {
        let (low, high) = surface.bounds();
        // What sticks out by a rounding error needs no cube.
        let cells = ((high - low) / edge - 1e-9).ceil().max(DVec3::ONE);
        if !(edge > 0.0 && cells.element_product() <= MOST) {
            return Err(Error::unusable(
                &surface.name,
                "cage",
                format!("cubes of an edge of {edge} are too small for a body of {}", surface.size),
                format!("ask for an edge of {:.3} or more", surface.size / 256.0),
            ));
        }
        let corner = 0.5 * (low + high) - 0.5 * edge * cells;
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "at most MOST")]
        let cells = cells.to_array().map(|n| n as usize);
        Ok(Self { corner, edge, cells })
    }

    /// How many cubes there are.
    pub(super) fn len(&self) -> usize {
        self.cells.iter().product()
    }

    pub(super) fn index(&self, [x, y, z]: [usize; 3]) -> usize {
        x + self.cells[0] * (y + self.cells[1] * z)
    }

    pub(super) fn place(&self, index: usize) -> [usize; 3] {
        let [nx, ny, _] = self.cells;
        [index % nx, index / nx % ny, index / nx / ny]
    }

    /// Middle of a cube.
    pub(super) fn middle(&self, cell: [usize; 3]) -> DVec3 {
        self.point(cell) + 0.5 * self.edge
    }

    /// A corner of cubes.
    #[expect(clippy::cast_precision_loss, reason = "at most MOST")]
    pub(super) fn point(&self, [x, y, z]: [usize; 3]) -> DVec3 {
        self.corner + self.edge * DVec3::new(x as f64, y as f64, z as f64)
    }

    /// Cubes that share a face with one.
    pub(super) fn beside(&self, cell: usize) -> impl Iterator<Item = usize> + '_ {
        let place = self.place(cell);
        (0..3).flat_map(move |axis| {
            let stride: usize = self.cells[..axis].iter().product();
            let below = (place[axis] > 0).then(|| cell - stride);
            below.into_iter().chain((place[axis] + 1 < self.cells[axis]).then(|| cell + stride))
        })
    }

    /// The cube that holds a point, or the one next to it.
    pub(super) fn cell(&self, p: DVec3) -> usize {
        let at = ((p - self.corner) / self.edge).to_array();
        self.index(core::array::from_fn(|k| inside(at[k], self.cells[k])))
    }

    /// Marks the cubes that a triangle touches. One that lies in a plane between cubes touches those on both sides.
    pub(super) fn mark(&self, triangle: [DVec3; 3], marks: &mut [bool]) {
        let corners = triangle.map(|p| (p - self.corner) / self.edge);
        let low = corners[0].min(corners[1]).min(corners[2]);
        let high = corners[0].max(corners[1]).max(corners[2]);
        let between = |k: usize| {
            let plane = low[k].round();
            (low[k] - plane).abs() <= SHRINK && (high[k] - plane).abs() <= SHRINK
        };
        let half = DVec3::from_array(core::array::from_fn(|k| {
            if between(k) { 0.5 + 2.0 * SHRINK } else { 0.5 - SHRINK }
        }));
        let [xs, ys, zs] = core::array::from_fn(|k| self.span(k, low[k], high[k]));
        for z in zs {
            for y in ys.clone() {
                for x in xs.clone() {
                    #[expect(clippy::cast_precision_loss, reason = "at most MOST")]
                    let middle = DVec3::new(x as f64, y as f64, z as f64) + 0.5;
                    if !apart(corners.map(|c| c - middle), half) {
                        marks[self.index([x, y, z])] = true;
                    }
                }
            }
        }
    }

    /// Cubes along an axis that meet an interval.
    fn span(&self, axis: usize, low: f64, high: f64) -> Range<usize> {
        let n = self.cells[axis];
        inside(low - 2.0 * SHRINK, n)..inside(high + 2.0 * SHRINK, n) + 1
    }
}

#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped")]
#[expect(clippy::cast_precision_loss, reason = "at most MOST")]
fn inside(at: f64, cells: usize) -> usize {
    at.floor().clamp(0.0, (cells - 1) as f64) as usize
}

/// Whether a triangle is apart from a box around the origin.
fn apart([a, b, c]: [DVec3; 3], half: DVec3) -> bool {
    let separates = |axis: DVec3| {
        let (x, y, z) = (a.dot(axis), b.dot(axis), c.dot(axis));
        let reach = half.dot(axis.abs());
        x.min(y).min(z) > reach || x.max(y).max(z) < -reach
    };
    let edges = [b - a, c - b, a - c];
    DVec3::AXES.into_iter().any(separates)
        || separates(edges[0].cross(edges[1]))
        || edges.into_iter().any(|e| DVec3::AXES.into_iter().any(|axis| separates(e.cross(axis))))
}
