//! The surface of the rest pose with split vertices welded, as a graph.

use crate::{Error, Model};
use glam::DVec3;
use std::collections::BTreeMap;

/// Welding tolerance, body sizes.
const WELD: f64 = 1e-6;
/// Surfaces closer than this belong together, body sizes.
const TOUCH: f64 = 0.012;
/// Parts smaller than this are moved as one, body sizes.
const SMALL: f64 = 0.12;
/// Softness is smoothed over about this length, body sizes.
const BLUR: f64 = 0.035;

/// Points of the welded rest pose, model space.
#[derive(Debug)]
pub(super) struct Surface {
    /// Diagonal of the bounding box.
    pub(super) size: f64,
    /// Positions of points.
    pub(super) points: Vec<DVec3>,
    /// Point of each render vertex.
    pub(super) point_of_vertex: Vec<usize>,
    /// Joints and weights of each point.
    pub(super) weights: Vec<Vec<(usize, f64)>>,
    /// Neighbours of each point by edges, ascending.
    pub(super) neighbours: Vec<Vec<usize>>,
    /// Connected part of each point.
    pub(super) part: Vec<usize>,
}

impl Surface {
    /// Welds the rest pose.
    pub(super) fn new(model: &Model) -> Result<Self, Error> {
        let positions = model.rest_positions();
        let low = positions.iter().copied().reduce(DVec3::min).unwrap_or_default();
        let high = positions.iter().copied().reduce(DVec3::max).unwrap_or_default();
        let size = (high - low).length();
        if !(size > 0.0 && size.is_finite()) {
            return Err(Error::unusable(
                model.name.as_str(),
                "rest pose",
                "the skinned mesh has no extent",
                "check the scale of the armature",
            ));
        }
        let mut known: BTreeMap<[i64; 3], usize> = BTreeMap::new();
        let (mut points, mut point_of_vertex) = (Vec::new(), Vec::new());
        for p in &positions {
            let next = points.len();
            let point = *known.entry(cell(*p - low, WELD * size)).or_insert(next);
            if point == next {
                points.push(*p);
            }
            point_of_vertex.push(point);
        }
        let weights = weights(model, &point_of_vertex, points.len());
        let neighbours = neighbours(model, &point_of_vertex, points.len());
        let part = parts(&neighbours);
        Ok(Self { size, points, point_of_vertex, weights, neighbours, part })
    }

    /// A value of each point, spread to the render vertices.
    pub(super) fn spread<T: Copy>(&self, values: &[T]) -> impl Iterator<Item = T> {
        self.point_of_vertex.iter().map(|p| values[*p])
    }

    /// Heaviest joint of a point.
    pub(super) fn dominant(&self, point: usize) -> usize {
        let heavier = |a: &&(usize, f64), b: &&(usize, f64)| a.1.total_cmp(&b.1).then(b.0.cmp(&a.0));
        self.weights[point].iter().max_by(heavier).map_or(0, |(j, _)| *j)
    }

    /// Connected patches of flesh: a number for each point, by itself where there is no softness.
    pub(super) fn patches(&self, softness: &[f64]) -> Vec<usize> {
        let soft = |i: &usize| softness[*i] > 0.0;
        let around = |(i, n): (usize, &Vec<usize>)| {
            if soft(&i) { n.iter().copied().filter(soft).collect() } else { Vec::new() }
        };
        parts(&self.neighbours.iter().enumerate().map(around).collect::<Vec<Vec<usize>>>())
    }

    /// Gives each small part (an eye, a button) one softness: that of the large surface nearest to it.
    pub(super) fn join_small_parts(&self, softness: &mut [f64]) {
        let count = self.part.iter().max().map_or(0, |p| p + 1);
        let mut bounds = vec![(DVec3::INFINITY, DVec3::NEG_INFINITY); count];
        for (p, part) in self.points.iter().zip(&self.part) {
            bounds[*part] = (bounds[*part].0.min(*p), bounds[*part].1.max(*p));
        }
        let small: Vec<bool> = bounds.iter().map(|(a, b)| (*b - *a).length() < SMALL * self.size).collect();
        if small.iter().all(|s| *s) {
            return;
        }
        for (part, (a, b)) in bounds.iter().enumerate().filter(|(i, _)| small[*i]) {
            let center = (*a + *b) * 0.5;
            let large = (0..self.points.len()).filter(|i| !small[self.part[*i]]);
            let distance = |i: usize| (self.points[i] - center).length_squared();
            let nearest = large.min_by(|a, b| distance(*a).total_cmp(&distance(*b)));
            let value = nearest.map_or(0.0, |i| softness[i]);
            for (i, s) in softness.iter_mut().enumerate().filter(|(i, _)| self.part[*i] == part) {
                debug_assert!(self.part[i] == part, "filtered");
                *s = value;
            }
        }
    }

    /// Diffuses softness over the surface and between parts that touch.
    pub(super) fn smooth(&self, softness: &mut [f64]) {
        let touching = self.touching();
        let edges = self.neighbours.iter().enumerate();
        let lengths: Vec<f64> = edges
            .flat_map(|(i, n)| n.iter().map(move |j| (self.points[i] - self.points[*j]).length()))
            .collect();
        #[allow(clippy::cast_precision_loss, reason = "counts")]
        let mean = lengths.iter().sum::<f64>() / (lengths.len().max(1) as f64);
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped")]
        let rounds = (2.0 * (BLUR * self.size / mean.max(1e-9 * self.size))).clamp(2.0, 12.0) as usize;
        for _ in 0..rounds * rounds / 4 + 2 {
            let old = softness.to_vec();
            for (i, s) in softness.iter_mut().enumerate() {
                let around = self.neighbours[i].iter().chain(&touching[i]);
                let (sum, n) = around.fold((0.0, 0.0), |(sum, n), j| (sum + old[*j], n + 1.0));
                if n > 0.0 {
                    *s = 0.5 * old[i] + 0.5 * sum / n;
                }
            }
        }
    }

    /// For each point, the nearest points of other parts within reach; both ways.
    fn touching(&self) -> Vec<Vec<usize>> {
        let reach = TOUCH * self.size;
        let mut grid: BTreeMap<[i64; 3], Vec<usize>> = BTreeMap::new();
        for (i, p) in self.points.iter().enumerate() {
            grid.entry(cell(*p, reach)).or_default().push(i);
        }
        let mut out = vec![Vec::new(); self.points.len()];
        for (i, p) in self.points.iter().enumerate() {
            let [x, y, z] = cell(*p, reach);
            let around = (0..27).map(|k| [x + k % 3 - 1, y + k / 3 % 3 - 1, z + k / 9 - 1]);
            let others =
                around.filter_map(|c| grid.get(&c)).flatten().filter(|j| self.part[**j] != self.part[i]);
            let distance = |j: usize| (self.points[j] - *p).length();
            let nearest = others.copied().min_by(|a, b| distance(*a).total_cmp(&distance(*b)));
            if let Some(j) = nearest.filter(|j| distance(*j) < reach) {
                out[i].push(j);
                out[j].push(i);
            }
        }
        out
    }
}

/// Cell of a grid of width `width`.
fn cell(p: DVec3, width: f64) -> [i64; 3] {
    #[allow(clippy::cast_possible_truncation, reason = "saturating")]
    (p / width).round().to_array().map(|x| x as i64)
}

/// Influences of each point: those of its first render vertex.
fn weights(model: &Model, point_of_vertex: &[usize], count: usize) -> Vec<Vec<(usize, f64)>> {
    let mut out = vec![Vec::new(); count];
    let mut vertex = 0;
    for p in &model.primitives {
        for (joints, weights) in p.joints.chunks_exact(p.stride).zip(p.weights.chunks_exact(p.stride)) {
            let row: &mut Vec<(usize, f64)> = &mut out[point_of_vertex[vertex]];
            vertex += 1;
            if row.is_empty() {
                let pairs = joints.iter().zip(weights).filter(|(_, w)| **w > 0.0);
                row.extend(pairs.map(|(j, w)| (usize::from(*j), f64::from(*w))));
            }
        }
    }
    out
}

fn neighbours(model: &Model, point_of_vertex: &[usize], count: usize) -> Vec<Vec<usize>> {
    let mut out = vec![Vec::new(); count];
    let mut first = 0;
    for p in &model.primitives {
        for triangle in &p.indices {
            let [a, b, c] = triangle.map(|v| point_of_vertex[first + v as usize]);
            for (i, j) in [(a, b), (b, c), (c, a)] {
                if i != j {
                    out[i].push(j);
                    out[j].push(i);
                }
            }
        }
        first += p.positions.len();
    }
    for n in &mut out {
        n.sort_unstable();
        n.dedup();
    }
    out
}

/// Connected parts of a graph, numbered in order of their first point.
fn parts(neighbours: &[Vec<usize>]) -> Vec<usize> {
    let mut part = vec![usize::MAX; neighbours.len()];
    let mut count = 0;
    for start in 0..neighbours.len() {
        if part[start] != usize::MAX {
            continue;
        }
        let mut stack = vec![start];
        part[start] = count;
        while let Some(i) = stack.pop() {
            for j in &neighbours[i] {
                if part[*j] == usize::MAX {
                    part[*j] = count;
                    stack.push(*j);
                }
            }
        }
        count += 1;
    }
    part
}
