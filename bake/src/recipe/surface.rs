//! The skin as one surface: render vertices welded by position, in units of the body size.

use std::collections::{BTreeMap, BTreeSet};

use glam::DVec3;

use super::grid::Grid;
use crate::{Error, Model};

/// Render vertices closer than this (body sizes) are one point.
const WELD: f64 = 1e-6;
/// Points of different shells closer than this (body sizes) move together.
const BRIDGE: f64 = 0.015;

/// A welded surface; lengths in body sizes, areas in body sizes squared.
#[derive(Debug)]
pub(crate) struct Surface {
    /// Body size in model units: diagonal of the box around all triangles.
    pub(crate) size: f64,
    /// Where that box has its smallest coordinates, model units.
    pub(crate) corner: DVec3,
    /// Point of each render vertex.
    pub(crate) point_of: Vec<usize>,
    /// Rest positions; the box's corner with the smallest coordinates is the origin.
    pub(crate) points: Vec<DVec3>,
    /// Position in bind space of the first render vertex of each point, model units.
    pub(crate) bind: Vec<DVec3>,
    /// Nodes that move a point, ascending, with weights that sum to 1.
    pub(crate) weights: Vec<Vec<(usize, f64)>>,
    /// A third of the area of the triangles around a point.
    pub(crate) area: Vec<f64>,
    /// A third of the area vectors (area times normal) of the triangles around a point.
    pub(crate) vector: Vec<DVec3>,
    /// Neighbors along triangle edges, ascending, with lengths.
    pub(crate) edges: Vec<Vec<(usize, f64)>>,
    /// `edges`, and bridges between shells that touch.
    pub(crate) links: Vec<Vec<(usize, f64)>>,
    /// Shell (connected component of `edges`) of each point.
    pub(crate) shell: Vec<usize>,
    /// Number of shells.
    pub(crate) shells: usize,
}

impl Surface {
    /// Welds all skinned primitives of a model.
    pub(crate) fn new(model: &Model) -> Result<Self, Error> {
        let rest = model.rest_positions();
        if let Some(vertex) = rest.iter().position(|p| !p.is_finite()) {
            return Err(Error::unusable(
                &model.name,
                format!("vertex {vertex}"),
                "its rest position is not a finite number",
                "repair the node transforms and inverse bind matrices",
            ));
        }
        let (low, high) = bounds(model, &rest);
        let size = (high - low).length();
        if !(size.is_normal() && size > 0.0) {
            return Err(Error::unusable(
                &model.name,
                "rest pose",
                "the skin has no size: all triangles fall on one point",
                "check the scale of the nodes and the inverse bind matrices",
            ));
        }
        let scaled: Vec<DVec3> = rest.iter().map(|p| (*p - low) / size).collect();
        let (point_of, first) = weld(&scaled);
        let points: Vec<DVec3> = first.iter().map(|v| scaled[*v]).collect();
        let bind = bind_positions(model);
        let triangles = triangles(model, &point_of);
        let (area, vector) = areas(&points, &triangles);
        let mut surface = Self {
            size,
            corner: low,
            bind: first.iter().map(|v| bind[*v]).collect(),
            weights: weights(model, &point_of, points.len()),
            area,
            vector,
            edges: edges(&points, &triangles),
            links: Vec::new(),
            shell: Vec::new(),
            shells: 0,
            point_of,
            points,
        };
        (surface.shell, surface.shells) = shells(&surface.edges);
        surface.links = surface.bridged();
        Ok(surface)
    }

    /// Edges plus, from each point, the way to the nearest point of each other shell that touches it.
    fn bridged(&self) -> Vec<Vec<(usize, f64)>> {
        let mut links = self.edges.clone();
        if self.shells < 2 {
            return links;
        }
        let grid = Grid::new(&self.points, BRIDGE);
        let mut bridges = BTreeSet::new();
        for (i, p) in self.points.iter().enumerate() {
            let mut nearest: BTreeMap<usize, (f64, usize)> = BTreeMap::new();
            for j in grid.around(*p).filter(|j| self.shell[*j] != self.shell[i]) {
                let distance = p.distance(self.points[j]);
                let best = nearest.entry(self.shell[j]).or_insert((BRIDGE, usize::MAX));
                if distance < best.0 {
                    *best = (distance, j);
                }
            }
            bridges.extend(nearest.values().filter(|n| n.1 != usize::MAX).map(|n| (i.min(n.1), i.max(n.1))));
        }
        for (i, j) in bridges {
            let length = self.points[i].distance(self.points[j]).max(WELD);
            links[i].push((j, length));
            links[j].push((i, length));
        }
        links
    }
}

/// Box around all vertices of triangles; around all vertices where there is no triangle.
fn bounds(model: &Model, rest: &[DVec3]) -> (DVec3, DVec3) {
    let mut start = 0;
    let mut used = Vec::new();
    for primitive in &model.primitives {
        used.extend(primitive.indices.iter().flatten().map(|v| rest[start + *v as usize]));
        start += primitive.positions.len();
    }
    let seen = if used.is_empty() { rest } else { &used };
    let first = seen.first().copied().unwrap_or_default();
    seen.iter().fold((first, first), |(low, high), p| (low.min(*p), high.max(*p)))
}

/// Point of each vertex, and the first vertex of each point.
fn weld(positions: &[DVec3]) -> (Vec<usize>, Vec<usize>) {
    let grid = Grid::new(positions, WELD);
    let mut point_of = vec![usize::MAX; positions.len()];
    let mut first = Vec::new();
    for (i, p) in positions.iter().enumerate() {
        if point_of[i] != usize::MAX {
            continue;
        }
        for j in grid.around(*p) {
            if point_of[j] == usize::MAX && p.distance(positions[j]) <= WELD {
                point_of[j] = first.len();
            }
        }
        first.push(i);
    }
    (point_of, first)
}

fn bind_positions(model: &Model) -> Vec<DVec3> {
    let positions = model.primitives.iter().flat_map(|p| &p.positions);
    positions.map(|p| DVec3::from_array(p.map(f64::from))).collect()
}

pub(crate) fn triangles(model: &Model, point_of: &[usize]) -> Vec<[usize; 3]> {
    let mut start = 0;
    let mut out = Vec::new();
    for primitive in &model.primitives {
        out.extend(primitive.indices.iter().map(|t| t.map(|v| point_of[start + v as usize])));
        start += primitive.positions.len();
    }
    out
}

fn weights(model: &Model, point_of: &[usize], points: usize) -> Vec<Vec<(usize, f64)>> {
    let mut sums: Vec<BTreeMap<usize, f64>> = vec![BTreeMap::new(); points];
    let mut vertex = 0;
    for primitive in &model.primitives {
        let joints = primitive.joints.chunks_exact(primitive.stride);
        for (joints, weights) in joints.zip(primitive.weights.chunks_exact(primitive.stride)) {
            for (joint, weight) in joints.iter().zip(weights).filter(|(_, w)| **w > 0.0) {
                let node = model.joints[usize::from(*joint)].node;
                *sums[point_of[vertex]].entry(node).or_default() += f64::from(*weight);
            }
            vertex += 1;
        }
    }
    let normalized = |row: BTreeMap<usize, f64>| {
        let sum: f64 = row.values().sum();
        row.into_iter().map(|(node, w)| (node, w / sum)).collect()
    };
    sums.into_iter().map(normalized).collect()
}

fn areas(points: &[DVec3], triangles: &[[usize; 3]]) -> (Vec<f64>, Vec<DVec3>) {
    let mut area = vec![0.0; points.len()];
    let mut vector = vec![DVec3::ZERO; points.len()];
    for [a, b, c] in triangles {
        let third = (points[*b] - points[*a]).cross(points[*c] - points[*a]) / 6.0;
        for v in [a, b, c] {
            area[*v] += third.length();
            vector[*v] += third;
        }
    }
    (area, vector)
}

fn edges(points: &[DVec3], triangles: &[[usize; 3]]) -> Vec<Vec<(usize, f64)>> {
    let mut seen = vec![BTreeSet::new(); points.len()];
    for [a, b, c] in triangles {
        for (i, j) in [(*a, *b), (*b, *c), (*c, *a)].into_iter().filter(|(i, j)| i != j) {
            seen[i].insert(j);
            seen[j].insert(i);
        }
    }
    let lengths = |(i, row): (usize, BTreeSet<usize>)| {
        row.into_iter().map(|j| (j, points[i].distance(points[j]).max(WELD))).collect()
    };
    seen.into_iter().enumerate().map(lengths).collect()
}

/// Connected components: the number of each point's, in order of their first points; and how many.
pub(crate) fn shells(edges: &[Vec<(usize, f64)>]) -> (Vec<usize>, usize) {
    let mut shell = vec![usize::MAX; edges.len()];
    let mut count = 0;
    for start in 0..edges.len() {
        if shell[start] != usize::MAX {
            continue;
        }
        let mut open = vec![start];
        shell[start] = count;
        while let Some(i) = open.pop() {
            for (j, _) in &edges[i] {
                if shell[*j] == usize::MAX {
                    shell[*j] = count;
                    open.push(*j);
                }
            }
        }
        count += 1;
    }
    (shell, count)
}
