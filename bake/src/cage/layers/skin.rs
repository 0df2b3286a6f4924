//! The skin as one closed surface: triangles of a model welded by position, its largest closed component.

use super::Outcome;
use crate::model::Model;
use glam::DVec3;
use std::collections::BTreeMap;

/// Render vertices closer than this (body sizes) are one point.
const WELD: f64 = 1e-6;
/// `36π V²/A³` below which a surface counts as flat; 1 for a sphere, 0.05 to 0.1 for people.
const FLAT: f64 = 1e-6;

/// A closed surface that does not cross itself on purpose; model space, m.
#[derive(Clone, Debug)]
pub(super) struct Skin {
    /// Positions in the rest pose.
    pub(super) points: Vec<DVec3>,
    /// Triangles, seen from outside against the clock.
    pub(super) triangles: Vec<[u32; 3]>,
    /// Nodes that move a point, ascending, with weights that sum to 1.
    pub(super) weights: Vec<Vec<(usize, f64)>>,
    /// Point of each render vertex of the model; `None` on other components.
    pub(super) point_of: Vec<Option<u32>>,
    /// A third of the area around each point, m².
    pub(super) areas: Vec<f64>,
    /// Neighbors of each point along edges, ascending, with lengths.
    pub(super) edges: Vec<Vec<(usize, f64)>>,
    /// Triangles around each point, ascending.
    pub(super) around: Vec<Vec<u32>>,
    /// Diagonal of the box around the points.
    pub(super) size: f64,
}

impl Skin {
    /// The closed component of the greatest volume.
    pub(super) fn new(model: &Model) -> Outcome<Self> {
        let rest = model.rest_positions();
        if let Some(vertex) = rest.iter().position(|p| !p.is_finite()) {
            return Err(unusable(
                model,
                &format!("vertex {vertex}"),
                "its rest position is not a finite number",
                "repair the node transforms and inverse bind matrices",
            ));
        }
        let (point_of, points) = weld(&rest);
        let triangles = triangles(model, &point_of);
        let part = largest_closed(model, &points, &triangles)?;
        Ok(Self::of_part(model, &points, &point_of, part))
    }

    /// Numbers the points of some triangles anew.
    fn of_part(model: &Model, points: &[DVec3], point_of: &[usize], part: Vec<[usize; 3]>) -> Self {
        let mut number = vec![None; points.len()];
        part.iter().flatten().for_each(|p| number[*p] = Some(0));
        let order: Vec<usize> = (0..points.len()).filter(|p| number[*p].is_some()).collect();
        let places: Vec<DVec3> = order.iter().map(|p| points[*p]).collect();
        for (new, old) in (0_u32..).zip(&order) {
            number[*old] = Some(new);
        }
        let triangles: Vec<[u32; 3]> = part.iter().map(|t| t.map(|p| number[p].unwrap_or(0))).collect();
        let point_of: Vec<Option<u32>> = point_of.iter().map(|p| number[*p]).collect();
        let weights = weights(model, &point_of, places.len());
        Self::of(places, triangles, weights, point_of)
    }

    /// Of points and closed triangles that are numbered through.
    pub(super) fn of(
        points: Vec<DVec3>,
        triangles: Vec<[u32; 3]>,
        weights: Vec<Vec<(usize, f64)>>,
        point_of: Vec<Option<u32>>,
    ) -> Self {
        let (low, high) = bounds(&points);
        Self {
            weights,
            areas: areas(&points, &triangles),
            edges: edges(&points, &triangles),
            around: around(points.len(), &triangles),
            size: (high - low).length(),
            points,
            triangles,
            point_of,
        }
    }
}

/// [`crate::Error::unusable`] of a model.
pub(super) fn unusable(model: &Model, place: &str, problem: &str, remedy: &str) -> crate::Error {
    crate::Error::unusable(&model.name, place, problem, remedy)
}

fn bounds(points: &[DVec3]) -> (DVec3, DVec3) {
    let first = points.first().copied().unwrap_or_default();
    points.iter().fold((first, first), |(low, high), p| (low.min(*p), high.max(*p)))
}

/// Point of each vertex, and the points: places of their first vertices.
fn weld(rest: &[DVec3]) -> (Vec<usize>, Vec<DVec3>) {
    let (low, high) = bounds(rest);
    let reach = WELD * (high - low).length();
    let mut order: Vec<usize> = (0..rest.len()).collect();
    order.sort_by(|a, b| rest[*a].x.total_cmp(&rest[*b].x).then(a.cmp(b)));
    // The vertex of least index within reach.
    let mut first: Vec<usize> = (0..rest.len()).collect();
    for (at, &i) in order.iter().enumerate() {
        for &j in order[at + 1..].iter().take_while(|j| rest[**j].x - rest[i].x <= reach) {
            if rest[i].distance(rest[j]) <= reach {
                let least = first[i].min(first[j]);
                (first[i], first[j]) = (least, least);
            }
        }
    }
    let mut point_of = vec![0; rest.len()];
    let mut points = Vec::new();
    for i in 0..rest.len() {
        point_of[i] = if first[i] == i { points.len() } else { point_of[first[i]] };
        if first[i] == i {
            points.push(rest[i]);
        }
    }
    (point_of, points)
}

/// Triangles of all skinned primitives with three different points.
fn triangles(model: &Model, point_of: &[usize]) -> Vec<[usize; 3]> {
    let mut start = 0;
    let mut out = Vec::new();
    for primitive in &model.primitives {
        let welded = primitive.indices.iter().map(|t| t.map(|v| point_of[start + v as usize]));
        out.extend(welded.filter(|[a, b, c]| a != b && b != c && c != a));
        start += primitive.positions.len();
    }
    out
}

/// The component without open edges that encloses most, turned outside out.
fn largest_closed(model: &Model, points: &[DVec3], triangles: &[[usize; 3]]) -> Outcome<Vec<[usize; 3]>> {
    let mut best: Option<(f64, Vec<[usize; 3]>)> = None;
    let mut open: Option<(usize, usize, DVec3)> = None;
    for part in components(points.len(), triangles) {
        let open_edges = open_edges(&part);
        if let Some(edge) = open_edges.first() {
            if open.is_none_or(|(size, ..)| part.len() > size) {
                open = Some((part.len(), open_edges.len(), (points[edge[0]] + points[edge[1]]) / 2.0));
            }
            continue;
        }
        let volume = volume(points, &part);
        if best.as_ref().is_none_or(|(most, _)| volume.abs() > most.abs()) {
            best = Some((volume, part));
        }
    }
    let Some((volume, mut part)) = best else {
        let (place, problem) = match open {
            Some((size, edges, at)) => (
                format!("skin, near {:.3}", at),
                format!(
                    "no part is closed; the largest has {size} triangles and {edges} open or forked edges"
                ),
            ),
            None => ("skin".to_owned(), "there is no triangle with an area".to_owned()),
        };
        return Err(unusable(model, &place, &problem, "close the holes of the body, or use a voxel cage"));
    };
    let area: f64 = part.iter().map(|t| area_vector(points, *t).length()).sum();
    if 36.0 * core::f64::consts::PI * volume * volume <= FLAT * area * area * area {
        let problem = format!("the body is flat: {volume:.3e} m³ inside {area:.3e} m²");
        return Err(unusable(model, "skin", &problem, "give it thickness; a flat body has no layers"));
    }
    if volume < 0.0 {
        part.iter_mut().for_each(|t| t.swap(1, 2));
    }
    Ok(part)
}

/// Triangles of each connected component, in order of their first points.
fn components(points: usize, triangles: &[[usize; 3]]) -> Vec<Vec<[usize; 3]>> {
    let mut root: Vec<usize> = (0..points).collect();
    fn find(root: &mut [usize], mut i: usize) -> usize {
        while root[i] != i {
            root[i] = root[root[i]];
            i = root[i];
        }
        i
    }
    for [a, b, c] in triangles {
        for other in [b, c] {
            let (x, y) = (find(&mut root, *a), find(&mut root, *other));
            let least = x.min(y);
            (root[x], root[y]) = (least, least);
        }
    }
    let mut parts: BTreeMap<usize, Vec<[usize; 3]>> = BTreeMap::new();
    for t in triangles {
        parts.entry(find(&mut root, t[0])).or_default().push(*t);
    }
    parts.into_values().collect()
}

/// Directed edges that do not have exactly one twin in the other direction.
fn open_edges(triangles: &[[usize; 3]]) -> Vec<[usize; 2]> {
    let mut count: BTreeMap<[usize; 2], usize> = BTreeMap::new();
    for [a, b, c] in triangles {
        for edge in [[*a, *b], [*b, *c], [*c, *a]] {
            *count.entry(edge).or_default() += 1;
        }
    }
    let twin = |[a, b]: [usize; 2]| count.get(&[b, a]).copied().unwrap_or(0);
    count.iter().filter(|(edge, n)| **n != 1 || twin(**edge) != 1).map(|(edge, _)| *edge).collect()
}

fn area_vector(points: &[DVec3], [a, b, c]: [usize; 3]) -> DVec3 {
    0.5 * (points[b] - points[a]).cross(points[c] - points[a])
}

/// Volume inside, by the divergence theorem about the first point.
fn volume(points: &[DVec3], triangles: &[[usize; 3]]) -> f64 {
    let origin = triangles.first().map_or(DVec3::ZERO, |t| points[t[0]]);
    triangles.iter().map(|t| area_vector(points, *t).dot(points[t[0]] - origin) / 3.0).sum()
}

/// Means over the render vertices of each point.
fn weights(model: &Model, point_of: &[Option<u32>], points: usize) -> Vec<Vec<(usize, f64)>> {
    let mut sums: Vec<BTreeMap<usize, f64>> = vec![BTreeMap::new(); points];
    let mut vertex = 0;
    for primitive in &model.primitives {
        let joints = primitive.joints.chunks_exact(primitive.stride);
        for (joints, weights) in joints.zip(primitive.weights.chunks_exact(primitive.stride)) {
            if let Some(point) = point_of[vertex] {
                for (joint, weight) in joints.iter().zip(weights).filter(|(_, w)| **w > 0.0) {
                    let node = model.joints[usize::from(*joint)].node;
                    *sums[point as usize].entry(node).or_default() += f64::from(*weight);
                }
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

fn areas(points: &[DVec3], triangles: &[[u32; 3]]) -> Vec<f64> {
    let mut out = vec![0.0; points.len()];
    for t in triangles.iter().map(|t| t.map(|i| i as usize)) {
        let third = area_vector(points, t).length() / 3.0;
        t.iter().for_each(|i| out[*i] += third);
    }
    out
}

fn around(points: usize, triangles: &[[u32; 3]]) -> Vec<Vec<u32>> {
    let mut out = vec![Vec::new(); points];
    for (number, t) in (0_u32..).zip(triangles) {
        t.iter().for_each(|i| out[*i as usize].push(number));
    }
    out
}

fn edges(points: &[DVec3], triangles: &[[u32; 3]]) -> Vec<Vec<(usize, f64)>> {
    let mut rows: Vec<Vec<usize>> = vec![Vec::new(); points.len()];
    for [a, b, c] in triangles.iter().map(|t| t.map(|i| i as usize)) {
        // The surface is closed: each edge is met once in each direction.
        for (i, j) in [(a, b), (b, c), (c, a)] {
            rows[i].push(j);
        }
    }
    let sorted = |(i, mut row): (usize, Vec<usize>)| {
        row.sort_unstable();
        row.into_iter().map(|j| (j, points[i].distance(points[j]))).collect()
    };
    rows.into_iter().enumerate().map(sorted).collect()
}

/// A unit sphere for tests: an octahedron, each triangle cut into `n²`.
#[cfg(test)]
pub(super) fn sphere(n: u32) -> Skin {
    let mut numbers: BTreeMap<[i64; 3], u32> = BTreeMap::new();
    let mut points = Vec::new();
    let mut triangles = Vec::new();
    let n = i64::from(n);
    for [x, y, z] in
        [[1, 1, 1], [-1, 1, 1], [1, -1, 1], [1, 1, -1], [-1, -1, 1], [-1, 1, -1], [1, -1, -1], [-1; 3]]
    {
        let mut at = |i: i64, j: i64| {
            let key = [x * i, y * j, z * (n - i - j)];
            *numbers.entry(key).or_insert_with(|| {
                #[expect(clippy::cast_precision_loss, reason = "small")]
                points.push(DVec3::from_array(key.map(|c| c as f64)).normalize());
                u32::try_from(points.len() - 1).unwrap_or(u32::MAX)
            })
        };
        for (i, j) in (0..n).flat_map(|i| (0..n - i).map(move |j| (i, j))) {
            let mut add = |t: [u32; 3]| triangles.push(if x * y * z > 0 { t } else { [t[0], t[2], t[1]] });
            add([at(i, j), at(i + 1, j), at(i, j + 1)]);
            if i + j + 1 < n {
                add([at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)]);
            }
        }
    }
    let count = points.len();
    Skin::of(points, triangles, vec![vec![(0, 1.0)]; count], vec![None; count])
}
