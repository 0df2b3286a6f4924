//! Cages fitted to the skin, of tetrahedra without bad angles: isosurface stuffing.
//!
//! Labelle, Shewchuk, Isosurface stuffing: fast tetrahedral meshes with good dihedral angles, 2007: a body-centered
//! cubic lattice is cut by the isosurface `f = 0`; a lattice vertex that a cut comes close to (`α` of the edge) moves
//! there; what remains of each tetrahedron is one to three tetrahedra. All dihedral angles are between 10.78° and
//! 164.74° whatever `f` is, with `α = 0.24999` on long edges and 0.41189 on short ones (table 1).
//!
//! ```text
//! f(x) = offset ± distance from the surface, + inside
//! ```
//!
//! Differs from the paper in how quadrilaterals are halved: from their first corner in one order of all corners (cuts of
//! long edges, vertices of even parity, odd ones, cuts of short edges), so that neighbors agree and no prism is left
//! that cannot be split. Random cuts of all kinds keep within the paper's bounds: 10.88° and 156.01° were the worst.

use super::Cage;
use super::embed::embed;
use super::surface::Surface;
use super::voxel::{Resolution, halve, touched_cubes};
use crate::Error;
use glam::{DVec3, IVec3};
use rayon::prelude::*;
use std::collections::BTreeMap;

/// A vertex moves to a cut closer than this share of a long and of a short edge.
const ALPHA: [f64; 2] = [0.24999, 0.41189];
/// Distances from the skin that are tried, in edges, until all of it is inside.
const OFFSETS: [f64; 5] = [0.25, 0.4, 0.6, 0.8, 1.1];
/// Empty cubes around the skin.
const MARGIN: f64 = 2.5;
/// Most cubes.
const MOST: f64 = 4_194_304.0;

/// A vertex of the lattice, in half cubes: all coordinates even (a corner) or all odd (a middle).
type Vertex = IVec3;

/// A corner of a piece: a vertex, or the cut of the edge between two, the smaller first.
type Corner = (Vertex, Option<Vertex>);

/// A cage fitted to the skin: all of the surface is inside. Parts that touch nowhere stay apart.
///
/// # Errors
///
/// [`Error::Unusable`] if the edge is not above 0 or too small, if no cage has so few nodes, or if no distance makes all
/// of the surface lie inside.
///
/// ```
/// use sinew_bake::{builtin, cage};
/// let surface = cage::Surface::new(&builtin::character())?;
/// let cage = cage::stuffed(&surface, cage::Resolution::Size(surface.size / 20.0))?;
/// assert!(cage.rest.len() > 500 && cage.components == 1);
/// # Ok::<(), sinew_bake::Error>(())
/// ```
pub fn stuffed(surface: &Surface, resolution: Resolution) -> Result<Cage, Error> {
    match resolution {
        Resolution::Size(edge) => around(surface, edge),
        Resolution::Vertices(most) => halve(surface, most, |edge| {
            // A cube has a corner and a middle of its own.
            let hopeless = touched_cubes(surface, edge).is_none_or(|n| 2 * n > most);
            let cage = if hopeless { None } else { around(surface, edge).ok() };
            Ok(cage.filter(|cage| cage.rest.len() <= most))
        }),
    }
}

fn around(surface: &Surface, edge: f64) -> Result<Cage, Error> {
    let refuse = |problem: String| {
        let remedy = format!("ask for an edge of about {:.3}", surface.size / 40.0);
        Err(Error::unusable(&surface.name, "cage", problem, remedy))
    };
    let (low, high) = surface.bounds();
    let cubes = ((high - low) / edge + 2.0 * MARGIN).ceil();
    if !(edge > 0.0 && cubes.element_product() <= MOST) {
        return refuse(format!("cubes of an edge of {edge} are too small for a body of {}", surface.size));
    }
    let lattice = Lattice { corner: 0.5 * (low + high) - 0.5 * edge * cubes, edge, cubes: cubes.as_ivec3() };
    let depths = lattice.depths(surface);
    for offset in OFFSETS {
        let cage = lattice.stuff(&depths, offset * edge);
        if embed(&surface.name, &cage, &surface.points).is_ok() {
            return Ok(cage);
        }
    }
    refuse(format!("the surface has parts too thin for cubes of an edge of {edge}"))
}

/// Cubes with their corners and middles.
struct Lattice {
    corner: DVec3,
    edge: f64,
    cubes: IVec3,
}

/// The lattice, cut.
struct Cut<'a> {
    lattice: &'a Lattice,
    /// `f`; 0 at vertices that moved. By [`Lattice::index`].
    values: Vec<f64>,
    /// Where vertices moved to, by index.
    moved: BTreeMap<usize, DVec3>,
}

impl Lattice {
    fn place(&self, v: Vertex) -> DVec3 {
        self.corner + v.as_dvec3() * (0.5 * self.edge)
    }

    fn has(&self, v: Vertex) -> bool {
        v.cmpge(Vertex::ZERO).all() && v.cmple(2 * self.cubes).all()
    }

    /// Half cubes along each axis, with both ends.
    fn halves(&self) -> [usize; 3] {
        (2 * self.cubes + 1).to_array().map(|n| usize::try_from(n).unwrap_or(0))
    }

    fn index(&self, v: Vertex) -> Option<usize> {
        let ([x, y, z], [nx, ny, _]) = (v.to_array().map(usize::try_from), self.halves());
        self.has(v).then_some(x.ok()? + nx * (y.ok()? + ny * z.ok()?))
    }

    /// All vertices, in the order of their indices; other half cubes are passed over.
    fn vertices(&self) -> impl Iterator<Item = (usize, Vertex)> {
        let [nx, ny, nz] = (2 * self.cubes + 1).to_array();
        let rows = (0..nz).flat_map(move |z| (0..ny).map(move |y| (z, y)));
        let all = rows.flat_map(move |(z, y)| (0..nx).map(move |x| Vertex::new(x, y, z)));
        all.enumerate().filter(|(_, v)| v.x & 1 == v.y & 1 && v.x & 1 == v.z & 1)
    }

    /// Distance from the surface of all vertices, positive inside.
    fn depths(&self, surface: &Surface) -> Vec<f64> {
        let mut out = vec![f64::NAN; self.halves().iter().product()];
        let all: Vec<(usize, Vertex)> = self.vertices().collect();
        let depth = |(i, v): (usize, Vertex)| {
            let p = self.place(v);
            let distance = surface.nearest(p).distance;
            (i, if surface.winding(p) > 0.5 { distance } else { -distance })
        };
        let depths: Vec<(usize, f64)> = all.into_par_iter().map(depth).collect();
        depths.into_iter().for_each(|(i, depth)| out[i] = depth);
        out
    }

    fn stuff(&self, depths: &[f64], offset: f64) -> Cage {
        let values = depths.iter().map(|depth| depth + offset).collect();
        let mut cut = Cut { lattice: self, values, moved: BTreeMap::new() };
        cut.snap();
        cut.cage()
    }
}

/// Vertices that share an edge with one: six along the axes, then eight along the diagonals.
fn neighbors(v: Vertex) -> impl Iterator<Item = (Vertex, usize)> {
    let long =
        [Vertex::X, Vertex::Y, Vertex::Z].into_iter().flat_map(|a| [-2 * a, 2 * a]).map(|step| (step, 0));
    let sign = |bits: i32, k: i32| 2 * (bits >> k & 1) - 1;
    let short = (0..8).map(move |bits| (Vertex::new(sign(bits, 0), sign(bits, 1), sign(bits, 2)), 1));
    long.chain(short).map(move |(step, kind)| (v + step, kind))
}

impl Cut<'_> {
    fn value(&self, v: Vertex) -> Option<f64> {
        self.lattice.index(v).map(|i| self.values[i])
    }

    /// Where `f` is 0 between two vertices of unlike sign, as the share of the way.
    fn share(&self, a: Vertex, b: Vertex) -> Option<f64> {
        let (fa, fb) = (self.value(a)?, self.value(b)?);
        (fa * fb < 0.0).then(|| fa / (fa - fb))
    }

    /// Moves vertices to the cuts that are too close, one after the other; its other cuts are gone then.
    fn snap(&mut self) {
        for (i, v) in self.lattice.vertices() {
            let close = |(other, kind): (Vertex, usize)| {
                self.share(v, other).filter(|t| *t < ALPHA[kind]).map(|t| (t, kind, other))
            };
            let length =
                |(t, kind, _): &(f64, usize, Vertex)| t * if *kind == 0 { 1.0 } else { 0.75_f64.sqrt() };
            let closest = neighbors(v).filter_map(close).min_by(|a, b| length(a).total_cmp(&length(b)));
            if let Some((t, _, other)) = closest {
                self.moved.insert(i, self.lattice.place(v).lerp(self.lattice.place(other), t));
                self.values[i] = 0.0;
            }
        }
    }

    fn position(&self, (a, b): Corner) -> DVec3 {
        let moved = |v: Vertex| self.lattice.index(v).and_then(|i| self.moved.get(&i)).copied();
        match b.and_then(|b| Some((b, self.share(a, b)?))) {
            // Cuts are where they were found: on the edge as it was.
            Some((b, t)) => self.lattice.place(a).lerp(self.lattice.place(b), t),
            None => moved(a).unwrap_or_else(|| self.lattice.place(a)),
        }
    }

    /// All pieces, numbered in the order of the lattice.
    fn cage(&self) -> Cage {
        let mut pieces = Vec::new();
        for (_, v) in self.lattice.vertices().filter(|(_, v)| v.x & 1 == 0) {
            tets_at(v, &mut |tet| {
                let values = tet.map(|v| self.value(v).unwrap_or(-1.0));
                if tet.iter().all(|v| self.lattice.has(*v)) {
                    pieces.extend(pieces_of(tet, values));
                }
            });
        }
        let key = |c: &Corner| (c.0.to_array(), c.1.map(|b| b.to_array()));
        let mut corners: Vec<Corner> = pieces.iter().flatten().copied().collect();
        corners.sort_unstable_by_key(key);
        corners.dedup();
        let number = |c: &Corner| {
            u32::try_from(corners.partition_point(|other| key(other) < key(c))).unwrap_or(u32::MAX)
        };
        let rest: Vec<DVec3> = corners.iter().map(|c| self.position(*c)).collect();
        let mut cage = Cage { rest, edge: self.lattice.edge, ..Cage::default() };
        cage.tets = pieces.iter().map(|piece| piece.each_ref().map(number)).collect();
        for tet in 0..cage.tets.len() {
            if cage.volume6(cage.tets[tet]) < 0.0 {
                cage.tets[tet].swap(2, 3);
            }
        }
        cage.connect();
        cage
    }
}

/// Tetrahedra around the long edges that start at a corner of cubes: each has one long edge between corners and one
/// between middles.
fn tets_at(v: Vertex, each: &mut impl FnMut([Vertex; 4])) {
    let axes = [Vertex::X, Vertex::Y, Vertex::Z];
    for k in 0..3 {
        let [along, side, up] = core::array::from_fn(|n| axes[(k + n) % 3]);
        let ring = [side + up, up - side, -side - up, side - up].map(|step| v + along + step);
        (0..4).for_each(|k| each([v, v + 2 * along, ring[k], ring[(k + 1) % 4]]));
    }
}

/// What of a tetrahedron is inside, from the signs of `f` at its vertices.
fn pieces_of(tet: [Vertex; 4], values: [f64; 4]) -> Vec<[Corner; 4]> {
    let of = |keep: &dyn Fn(f64) -> bool| -> Vec<Vertex> {
        tet.iter().zip(values).filter(|(_, f)| keep(*f)).map(|(v, _)| *v).collect()
    };
    let (inside, on, outside) = (of(&|f| f > 0.0), of(&|f| f == 0.0), of(&|f| f < 0.0));
    let whole = |v: &Vertex| (*v, None);
    let cut = |a: &Vertex, b: &Vertex| {
        let (a, b) = if a.to_array() < b.to_array() { (a, b) } else { (b, a) };
        (*a, Some(*b))
    };
    let on: Vec<Corner> = on.iter().map(whole).collect();
    match (inside.as_slice(), on.as_slice(), outside.as_slice()) {
        ([], ..) => Vec::new(),
        (_, _, []) => vec![tet.map(|v| (v, None))],
        ([p], on, outs) => {
            let rest: Vec<Corner> = on.iter().copied().chain(outs.iter().map(|n| cut(p, n))).collect();
            vec![[whole(p), rest[0], rest[1], rest[2]]]
        }
        ([p, q], [z], [n]) => pyramid(*z, [whole(p), whole(q), cut(q, n), cut(p, n)]),
        ([p, q], _, [m, n]) => prism([whole(p), cut(p, m), cut(p, n)], [whole(q), cut(q, m), cut(q, n)]),
        ([p, q, r], _, [n]) => prism([p, q, r].map(whole), [p, q, r].map(|v| cut(v, n))),
        _ => Vec::new(),
    }
}

/// The order in which corners halve quadrilaterals; the smallest first.
fn rank(corner: &Corner) -> (u8, [i32; 3], [i32; 3]) {
    let (a, b) = corner;
    let kind = match b {
        Some(b) if (*b - *a).element_sum().abs() == 2 && (*b - *a).abs().max_element() == 2 => 0,
        Some(_) => 3,
        None => 1 + u8::from((a.element_sum().div_euclid(2)) & 1 != 0),
    };
    (kind, a.to_array(), b.unwrap_or(Vertex::ZERO).to_array())
}

/// A quadrilateral and an apex, in two.
fn pyramid(apex: Corner, quad: [Corner; 4]) -> Vec<[Corner; 4]> {
    let first = (0..4).min_by_key(|k| rank(&quad[*k])).unwrap_or(0);
    let [a, b, c, d] = core::array::from_fn(|k| quad[(first + k) % 4]);
    vec![[apex, a, b, c], [apex, a, c, d]]
}

/// Two triangles whose corners are joined in order, in three.
fn prism(one: [Corner; 3], two: [Corner; 3]) -> Vec<[Corner; 4]> {
    let first = (0..6).min_by_key(|k| rank(if *k < 3 { &one[*k] } else { &two[k - 3] })).unwrap_or(0);
    let (near, far) = if first < 3 { (one, two) } else { (two, one) };
    let [i, j, k] = core::array::from_fn(|n| (first + n) % 3);
    let mut out = pyramid(near[i], [near[j], near[k], far[k], far[j]]);
    out.push([near[i], far[0], far[1], far[2]]);
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Smallest and largest dihedral angle, degrees.
    fn dihedral(corners: [DVec3; 4]) -> [f64; 2] {
        let mut out = [f64::INFINITY, 0.0];
        for [i, j, k, l] in
            [[0, 1, 2, 3], [0, 2, 1, 3], [0, 3, 1, 2], [1, 2, 0, 3], [1, 3, 0, 2], [2, 3, 0, 1]]
        {
            let edge = (corners[j] - corners[i]).normalize();
            let across = |n: usize| {
                let way = corners[n] - corners[i];
                (way - edge * way.dot(edge)).normalize()
            };
            let angle = libm::acos(across(k).dot(across(l)).clamp(-1.0, 1.0)).to_degrees();
            out = [out[0].min(angle), out[1].max(angle)];
        }
        out
    }

    /// Random `f` of all shapes: what is cut never leaves the bounds of the paper's table 1.
    #[test]
    fn angles_are_within_the_paper_whatever_is_cut() {
        let lattice = Lattice { corner: DVec3::ZERO, edge: 2.0, cubes: IVec3::splat(5) };
        let mut state = 9_u64;
        let mut random = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            f64::from(u32::try_from(state >> 32).expect("32 bits")) / 4_294_967_296.0
        };
        let mut worst = [f64::INFINITY, 0.0_f64];
        let near = [0.25, 0.41, 0.42, 0.75, 1.0];
        for round in 0..400 {
            let (normal, bend, shift) = (DVec3::new(random(), random(), random()) - 0.5, random(), random());
            let center = DVec3::new(random(), random(), random()) * 10.0;
            let mut depths = vec![f64::NAN; lattice.halves().iter().product()];
            for (i, v) in lattice.vertices() {
                let p = lattice.place(v) - center;
                depths[i] = match round % 4 {
                    0 => random() - 0.5,
                    1 => p.dot(normal),
                    2 => 1.0 + 3.0 * bend - p.length(),
                    // Many cuts near the limits of moving.
                    _ => (random() - shift).signum() * near[i % near.len()],
                };
            }
            let cage = lattice.stuff(&depths, 0.0);
            for tet in &cage.tets {
                let [low, high] = dihedral(tet.map(|i| cage.rest[i as usize]));
                worst = [worst[0].min(low), worst[1].max(high)];
            }
        }
        println!("dihedral angles from {:.2} to {:.2} degrees", worst[0], worst[1]);
        assert!(worst[0] >= 10.78 && worst[1] <= 164.75, "{worst:?}");
    }
}
