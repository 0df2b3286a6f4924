//! A character's surface: welded points and triangles in model space, in the rest pose.

use super::orient::{Repairs, orient};
use super::tree::Tree;
use crate::recipe::grid::Grid;
use crate::{Error, Model};
use glam::DVec3;
use std::collections::BTreeMap;

/// Vertices closer than this (body sizes) are one point.
const WELD: f64 = 1e-6;
/// A surface thinner than this (body sizes) is flat.
const FLAT: f64 = 1e-6;

/// Point of a render vertex that no triangle uses.
pub const STRAY: u32 = u32::MAX;

/// Numbers that are kept where they are not 0: `(what, number)`, ascending.
pub type Row = Vec<(u32, f64)>;

/// A welded triangle soup, turned right side out, that can be asked what is inside and what is near.
#[derive(Clone, Debug)]
pub struct Surface {
    /// Name of the character, for errors.
    pub name: String,
    /// Points that triangles use, m.
    pub points: Vec<DVec3>,
    /// Triangles that have an area, each once, seen from outside against the clock.
    pub triangles: Vec<[u32; 3]>,
    /// Skin weights of points: nodes of the model, above 0, sum 1; no rows where there is no skin.
    pub weights: Vec<Row>,
    /// Painted softness of points, `0..=1`.
    pub painted: Vec<Option<f64>>,
    /// Point of each render vertex, or [`STRAY`].
    pub point_of: Vec<u32>,
    /// Diagonal of the box around all points, m.
    pub size: f64,
    /// What was repaired, a sentence each.
    pub notes: Vec<String>,
    pub(super) tree: Tree,
}

/// Vertices with what hangs on them, before welding.
#[derive(Debug, Default)]
struct Soup {
    positions: Vec<DVec3>,
    triangles: Vec<[u32; 3]>,
    weights: Vec<Row>,
    painted: Vec<Option<f64>>,
    /// Place of the first vertex of each primitive, for errors.
    places: Vec<(usize, String)>,
}

impl Surface {
    /// All skinned primitives of a character.
    ///
    /// Weights name nodes, not joints: cages are in model space, where two skins with one node are moved alike.
    ///
    /// # Errors
    ///
    /// [`Error::Unusable`] if there is no triangle with an area, all are in one plane, a position is not finite, a
    /// vertex has a joint that is not there or no weight, or a painted softness is not in `0..=1`.
    ///
    /// ```
    /// use sinew_bake::{builtin, cage::Surface};
    /// let surface = Surface::new(&builtin::character())?;
    /// assert!(surface.winding(surface.points.iter().sum::<glam::DVec3>() / surface.points.len() as f64) > 0.9);
    /// # Ok::<(), sinew_bake::Error>(())
    /// ```
    pub fn new(model: &Model) -> Result<Self, Error> {
        let mut soup = Soup::default();
        for primitive in &model.primitives {
            let start = soup.positions.len();
            let place = format!("mesh {}, primitive {}", primitive.mesh, primitive.primitive);
            let painted = primitive.painted.as_deref();
            for v in 0..primitive.positions.len() {
                let wrong = |problem: String, remedy: &str| {
                    Err(Error::unusable(&model.name, format!("{place}, vertex {v}"), problem, remedy))
                };
                let row = row(model, primitive, v);
                let Some(row) = row.filter(|r| !r.is_empty()) else {
                    return wrong(
                        "it has no weight, or one on a joint that is missing".into(),
                        "bind it to a joint",
                    );
                };
                let softness = painted.and_then(|p| p.get(v)).map(|s| f64::from(*s));
                if let Some(s) = softness.filter(|s| !(0.0..=1.0).contains(s)) {
                    return wrong(
                        format!("painted softness is {s}"),
                        "paint values from 0 to 1, one a vertex",
                    );
                }
                soup.weights.push(row);
                soup.painted.push(softness);
            }
            soup.triangles
                .extend(primitive.indices.iter().map(|t| t.map(|i| i.saturating_add(index(start)))));
            soup.positions.resize(start + primitive.positions.len(), DVec3::ZERO);
            soup.places.push((start, place));
        }
        // Weights are known to be good only now.
        soup.positions = model.rest_positions();
        Self::weld(&model.name, soup)
    }

    /// Positions and triangles without a skin; `name` is for errors.
    ///
    /// # Errors
    ///
    /// As [`new`](Self::new); also for a triangle with a vertex that is not there.
    pub fn plain(name: &str, positions: &[DVec3], triangles: &[[u32; 3]]) -> Result<Self, Error> {
        let soup = Soup {
            painted: vec![None; positions.len()],
            positions: positions.to_vec(),
            triangles: triangles.to_vec(),
            ..Soup::default()
        };
        Self::weld(name, soup)
    }

    fn weld(name: &str, soup: Soup) -> Result<Self, Error> {
        let used = check(name, &soup)?;
        let (low, high) = bounds(used.iter().map(|v| soup.positions[*v]));
        let size = (high - low).length();
        if !(size.is_normal() && size > 0.0) {
            let remedy = "check the scale of the nodes and the inverse bind matrices";
            return Err(Error::unusable(name, "rest pose", "all triangles fall on one point", remedy));
        }
        let scaled: Vec<DVec3> = used.iter().map(|v| (soup.positions[*v] - low) / size).collect();
        let (point_of_used, first) = weld(&scaled);
        let mut point_of = vec![STRAY; soup.positions.len()];
        used.iter().zip(&point_of_used).for_each(|(v, p)| point_of[*v] = *p);
        let points: Vec<DVec3> = first.iter().map(|k| soup.positions[used[*k]]).collect();
        if flat(&points, size) {
            let remedy = "give it thickness; a sheet has no inside to fill";
            return Err(Error::unusable(
                name,
                "rest pose",
                "the surface is flat: all of it is in one plane",
                remedy,
            ));
        }
        let mut triangles: Vec<[u32; 3]> =
            soup.triangles.iter().map(|t| t.map(|i| point_of[i as usize])).collect();
        let repairs = orient(&points, size, &mut triangles);
        let tree = Tree::new(&points, &triangles);
        let (weights, painted) = shared(&soup, &point_of, points.len());
        let notes = notes(&repairs, point_of.iter().filter(|p| **p == STRAY).count());
        let name = name.to_owned();
        Ok(Self { name, points, triangles, weights, painted, point_of, size, notes, tree })
    }

    /// Corners of a triangle.
    pub(super) fn corners(&self, triangle: usize) -> [DVec3; 3] {
        self.triangles[triangle].map(|i| self.points[i as usize])
    }

    /// Box around all points: its corners with the smallest and the largest coordinates.
    #[must_use]
    pub fn bounds(&self) -> (DVec3, DVec3) {
        bounds(self.points.iter().copied())
    }
}

fn index(n: usize) -> u32 {
    u32::try_from(n).unwrap_or(u32::MAX)
}

/// Weights of a vertex on nodes, sum 1; `None` if a joint or its node is missing.
fn row(model: &Model, primitive: &crate::model::Primitive, v: usize) -> Option<Row> {
    let range = v * primitive.stride..(v + 1) * primitive.stride;
    let (joints, weights) = (primitive.joints.get(range.clone())?, primitive.weights.get(range)?);
    let mut sums = BTreeMap::new();
    for (joint, weight) in joints.iter().zip(weights).filter(|(_, w)| **w > 0.0) {
        let node = model.joints.get(usize::from(*joint))?.node;
        model.nodes.get(node)?;
        *sums.entry(index(node)).or_insert(0.0) += f64::from(*weight);
    }
    Some(normalized(sums))
}

fn normalized(sums: BTreeMap<u32, f64>) -> Row {
    let total: f64 = sums.values().sum();
    sums.into_iter().map(|(node, w)| (node, w / total)).collect()
}

/// Vertices that triangles use, ascending.
fn check(name: &str, soup: &Soup) -> Result<Vec<usize>, Error> {
    let place = |v: usize| match soup.places.iter().rev().find(|(start, _)| *start <= v) {
        Some((start, place)) => format!("{place}, vertex {}", v - start),
        None => format!("vertex {v}"),
    };
    let mut seen = vec![false; soup.positions.len()];
    for (t, corners) in soup.triangles.iter().enumerate() {
        for v in corners {
            let Some(seen) = seen.get_mut(*v as usize) else {
                let problem = format!("it has the vertex {v} of {}", soup.positions.len());
                return Err(Error::unusable(name, format!("triangle {t}"), problem, "export the mesh again"));
            };
            *seen = true;
        }
    }
    let used: Vec<usize> = (0..seen.len()).filter(|v| seen[*v]).collect();
    if used.is_empty() {
        return Err(Error::unusable(name, "mesh", "it has no triangles", "export the mesh with its faces"));
    }
    match used.iter().find(|v| !soup.positions[**v].is_finite()) {
        Some(v) => {
            let remedy = "repair positions, node transforms and inverse bind matrices";
            Err(Error::unusable(name, place(*v), "its rest position is not a finite number", remedy))
        }
        None => Ok(used),
    }
}

fn bounds(points: impl Iterator<Item = DVec3>) -> (DVec3, DVec3) {
    let nothing = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    points.fold(nothing, |(low, high), p| (low.min(p), high.max(p)))
}

/// Point of each vertex, and the first vertex of each point.
fn weld(scaled: &[DVec3]) -> (Vec<u32>, Vec<usize>) {
    let grid = Grid::new(scaled, WELD);
    let mut point_of = vec![STRAY; scaled.len()];
    let mut first = Vec::new();
    for (i, p) in scaled.iter().enumerate() {
        if point_of[i] != STRAY {
            continue;
        }
        for j in grid.around(*p) {
            if point_of[j] == STRAY && p.distance(scaled[j]) <= WELD {
                point_of[j] = index(first.len());
            }
        }
        first.push(i);
    }
    (point_of, first)
}

/// Whether all points are near the plane through three that are far apart.
fn flat(points: &[DVec3], size: f64) -> bool {
    let farthest = |far: &dyn Fn(DVec3) -> f64| {
        points.iter().copied().max_by(|a, b| far(*a).total_cmp(&far(*b))).unwrap_or_default()
    };
    let a = points[0];
    let b = farthest(&|p| p.distance_squared(a));
    let along = (b - a).normalize_or_zero();
    let c = farthest(&|p| (p - a).cross(along).length_squared());
    let normal = along.cross(c - a).normalize_or_zero();
    points.iter().all(|p| (*p - a).dot(normal).abs() <= FLAT * size)
}

/// Weights and paint of points: the mean of their vertices'.
fn shared(soup: &Soup, point_of: &[u32], points: usize) -> (Vec<Row>, Vec<Option<f64>>) {
    let mut sums: Vec<BTreeMap<u32, f64>> =
        vec![BTreeMap::new(); if soup.weights.is_empty() { 0 } else { points }];
    let mut paint = vec![(0.0, 0.0); points];
    for (v, point) in point_of.iter().enumerate().filter(|(_, p)| **p != STRAY) {
        for (node, w) in soup.weights.get(v).into_iter().flatten() {
            *sums[*point as usize].entry(*node).or_default() += w;
        }
        if let Some(softness) = soup.painted[v] {
            let sum = &mut paint[*point as usize];
            *sum = (sum.0 + softness, sum.1 + 1.0);
        }
    }
    let painted = paint.into_iter().map(|(sum, count)| (count > 0.0).then(|| sum / count)).collect();
    (sums.into_iter().map(normalized).collect(), painted)
}

fn notes(repairs: &Repairs, strays: usize) -> Vec<String> {
    let Repairs { slivers, duplicates, open, crowded, turned, inverted } = *repairs;
    [
        (slivers, "triangles without area are left out"),
        (duplicates, "triangles are there twice; the second is left out"),
        (open, "edges have one triangle: the surface is open there"),
        (crowded, "edges have more than two triangles"),
        (turned, "triangles were wound against their neighbors and are turned"),
        (inverted, "parts were inside out and are turned"),
        (strays, "vertices have no triangle and are left out"),
    ]
    .into_iter()
    .filter(|(n, _)| *n > 0)
    .map(|(n, what)| format!("{n} {what}"))
    .collect()
}
