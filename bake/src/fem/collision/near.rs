//! Which parts of a surface are near each other.
//!
//! Boxes around what points, edges and triangles sweep over, in R-trees; what has overlapping ones is looked at. Parts that share
//! a point never count. Neither do those that are in one place at rest: nothing could hold them apart. Others that are
//! nearer than `d̂` at rest (lips, armpits, the two sides of an ear) have a `d̂` of their own, half their distance at rest:
//! so the rest is without force, and they still cannot pass.

use super::distance::Nearest;
use super::mollifier;
use super::pair::{Kind, Pair};
use crate::cage::layers::crossing::crossings;
use crate::fem::surface::Surface;
use glam::DVec3;
use rayon::prelude::*;
use rstar::primitives::{GeomWithData, Rectangle};
use rstar::{AABB, RTree};

/// A pair's `d̂` over its distance at rest, at most.
const OF_REST: f64 = 0.5;
/// Parts of which `d̂` would be below this part of the usual one are in one place.
const JOINED: f64 = 1e-4;

type Boxes = RTree<GeomWithData<Rectangle<[f64; 3]>, u32>>;

/// Finds pairs of one surface.
#[derive(Clone, Debug)]
pub struct Finder {
    /// `d̂`, m.
    reach: f64,
    /// Pairs of triangles that cross at rest, both ways round, in order.
    crossed: Vec<(u32, u32)>,
    /// Begin of each point's triangles, and the end of the last's.
    starts: Vec<usize>,
    /// Triangles around points.
    around: Vec<u32>,
}

impl Finder {
    /// For pairs nearer than `reach`, m.
    #[must_use]
    pub fn new(surface: &Surface, reach: f64) -> Self {
        let mut crossed = crossings(&surface.rest, None, &surface.triangles);
        let back: Vec<(u32, u32)> = crossed.iter().map(|(t, u)| (*u, *t)).collect();
        crossed.extend(back);
        crossed.sort_unstable();
        let mut around: Vec<(u32, u32)> =
            (0..).zip(&surface.triangles).flat_map(|(t, of)| of.map(|i| (i, t))).collect();
        around.sort_unstable();
        let count = |i: usize| around.partition_point(|(point, _)| (*point as usize) < i);
        let starts = (0..=surface.rest.len()).map(count).collect();
        Self { reach, crossed, starts, around: around.into_iter().map(|(_, t)| t).collect() }
    }

    /// All pairs that come nearer than `within`, m, to each other while the points move evenly from `from` to `to`, and maybe
    /// some that do not: points with triangles, then edges with edges, each in order.
    #[must_use]
    pub fn pairs(&self, surface: &Surface, from: &[DVec3], to: &[DVec3], within: f64) -> Vec<Pair> {
        let swept = |points: &[u32]| {
            let both = points.iter().flat_map(|i| [from[*i as usize], to[*i as usize]]);
            both.fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(l, h), p| (l.min(p), h.max(p)))
        };
        let triangles = boxes(surface.triangles.iter().map(|t| swept(t)));
        let edges = boxes(surface.edges.iter().map(|e| swept(e)));
        let near = |tree: &Boxes, points: &[u32]| {
            let (low, high) = swept(points);
            let (low, high) = ((low - within).to_array(), (high + within).to_array());
            let mut found: Vec<u32> = tree
                .locate_in_envelope_intersecting(&AABB::from_corners(low, high))
                .map(|found| found.data)
                .collect();
            found.sort_unstable();
            found
        };
        let of_point = |i: &u32| {
            let found = near(&triangles, &[*i]).into_iter().filter_map(|t| self.point(surface, *i, t));
            found.collect::<Vec<_>>()
        };
        let of_edge = |e: u32| {
            let found = near(&edges, &surface.edges[e as usize]).into_iter().filter(|f| *f > e);
            found.filter_map(|f| self.edge(surface, e, f)).collect::<Vec<_>>()
        };
        let mut out: Vec<Pair> =
            surface.corners.par_iter().with_min_len(64).flat_map_iter(of_point).collect();
        let count = u32::try_from(surface.edges.len()).unwrap_or(u32::MAX);
        out.par_extend((0..count).into_par_iter().with_min_len(64).flat_map_iter(of_edge));
        out
    }

    /// Point `i` and triangle `t`, unless they share a point or are one at rest.
    fn point(&self, surface: &Surface, i: u32, t: u32) -> Option<Pair> {
        let [a, b, c] = surface.triangles[t as usize];
        if [a, b, c].contains(&i) || self.around(i).iter().any(|u| self.cross(*u, t)) {
            return None;
        }
        let points = [i, a, b, c];
        let rest = Nearest::point_triangle(points.map(|i| surface.rest[i as usize]));
        let area = surface.areas[i as usize];
        Some(Pair { points, kind: Kind::PointTriangle, reach: self.reach(&rest)?, area })
    }

    /// Two edges, unless they share a point or are one at rest.
    fn edge(&self, surface: &Surface, e: u32, f: u32) -> Option<Pair> {
        let ([a, b], [c, d]) = (surface.edges[e as usize], surface.edges[f as usize]);
        if a == c || a == d || b == c || b == d {
            return None;
        }
        let of = |i: u32, j: u32| self.around(i).iter().filter(move |t| self.around(j).contains(t));
        if of(a, b).any(|t| of(c, d).any(|u| self.cross(*t, *u))) {
            return None;
        }
        let points = [a, b, c, d];
        let rest = points.map(|i| surface.rest[i as usize]);
        let kind = Kind::EdgeEdge { parallel: mollifier::limit(rest) };
        let area = 0.5 * (surface.edge_areas[e as usize] + surface.edge_areas[f as usize]);
        Some(Pair { points, kind, reach: self.reach(&Nearest::edge_edge(rest))?, area })
    }

    /// `d̂` of a pair.
    fn reach(&self, rest: &Nearest) -> Option<f64> {
        let reach = self.reach.min(OF_REST * libm::sqrt(rest.squared()));
        (reach > JOINED * self.reach).then_some(reach)
    }

    /// Triangles around point `i`.
    fn around(&self, i: u32) -> &[u32] {
        &self.around[self.starts[i as usize]..self.starts[i as usize + 1]]
    }

    /// Whether two triangles cross at rest.
    fn cross(&self, t: u32, u: u32) -> bool {
        !self.crossed.is_empty() && self.crossed.binary_search(&(t, u)).is_ok()
    }
}

fn boxes(of: impl Iterator<Item = (DVec3, DVec3)>) -> Boxes {
    let rectangle = |(low, high): (DVec3, DVec3)| Rectangle::from_corners(low.to_array(), high.to_array());
    RTree::bulk_load(of.zip(0..).map(|(b, number)| GeomWithData::new(rectangle(b), number)).collect())
}
