//! The surface in a cage: each point by the corners of its tetrahedron.
//!
//! ```text
//! x = Σ wᵢ xᵢ,   wᵢ = det(…p in the place of xᵢ…) / det(x₁−x₀  x₂−x₀  x₃−x₀)
//! ```

use super::Cage;
use crate::Error;
use core::ops::Range;
use glam::DVec3;

/// A weight below minus this is outside.
const OUTSIDE: f64 = 1e-9;

/// A point in a tetrahedron.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Place {
    /// The tetrahedron.
    pub tet: u32,
    /// Weights of its corners, at least -1e-9, sum 1.
    pub weights: [f64; 4],
}

/// A point in a tetrahedron, in ten bytes. The weight of the first corner is what is missing to 1.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Packed {
    /// The tetrahedron.
    pub tet: u32,
    /// Weights of the other corners, in 65535ths.
    pub weights: [u16; 3],
}

/// Finds the tetrahedron of each point; of equals the one in which the point lies deepest, then the first.
///
/// # Errors
///
/// [`Error::Unusable`] for a point that is in no tetrahedron; `name` is for the error.
pub fn embed(name: &str, cage: &Cage, points: &[DVec3]) -> Result<Vec<Place>, Error> {
    let boxes = Boxes::new(cage);
    let find = |(i, p): (usize, &DVec3)| match boxes.find(cage, *p) {
        Some(place) if place.weights.iter().all(|w| *w >= -OUTSIDE) => Ok(place),
        _ => {
            let problem = format!("{p} is outside of the cage");
            Err(Error::unusable(name, format!("point {i}"), problem, "make the cage of the same surface"))
        }
    };
    points.iter().enumerate().map(find).collect()
}

/// Places of embedded points where the nodes are at `nodes`.
///
/// # Panics
///
/// If `nodes` are fewer than the cage's or `places` are of another cage.
#[must_use]
pub fn apply(cage: &Cage, places: &[Place], nodes: &[DVec3]) -> Vec<DVec3> {
    places.iter().map(|place| at(cage, place, nodes)).collect()
}

fn at(cage: &Cage, place: &Place, nodes: &[DVec3]) -> DVec3 {
    let tet = cage.tets[place.tet as usize];
    tet.iter().zip(place.weights).map(|(i, w)| nodes[*i as usize] * w).sum()
}

/// How far packing moves points where the nodes are at `nodes`, m: the worst.
///
/// At most `1.5 / 65535` of the longest edge of a tetrahedron: three weights are off by half a step at most, and each
/// pulls along an edge from the first corner.
///
/// # Panics
///
/// As [`apply`].
#[must_use]
pub fn packing_error(cage: &Cage, places: &[Place], nodes: &[DVec3]) -> f64 {
    let moved =
        |place: &Place| at(cage, place, nodes).distance(at(cage, &Packed::from(*place).into(), nodes));
    places.iter().map(moved).fold(0.0, f64::max)
}

impl From<Place> for Packed {
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped")]
    fn from(place: Place) -> Self {
        let [_, weights @ ..] = place.weights;
        Self { tet: place.tet, weights: weights.map(|w| (w * 65535.0).round().clamp(0.0, 65535.0) as u16) }
    }
}

impl From<Packed> for Place {
    fn from(packed: Packed) -> Self {
        let [a, b, c] = packed.weights.map(|w| f64::from(w) / 65535.0);
        Self { tet: packed.tet, weights: [1.0 - (a + b + c), a, b, c] }
    }
}

impl Packed {
    /// Little-endian: the tetrahedron, then the weights.
    #[must_use]
    pub fn to_bytes(self) -> [u8; 10] {
        let ([a, b, c, d], [e, f, g]) = (self.tet.to_le_bytes(), self.weights.map(u16::to_le_bytes));
        [a, b, c, d, e[0], e[1], f[0], f[1], g[0], g[1]]
    }

    /// What [`to_bytes`](Self::to_bytes) made.
    #[must_use]
    pub fn from_bytes([a, b, c, d, e, f, g, h, i, j]: [u8; 10]) -> Self {
        let weights = [[e, f], [g, h], [i, j]].map(u16::from_le_bytes);
        Self { tet: u32::from_le_bytes([a, b, c, d]), weights }
    }
}

/// Weights of a point on the corners of a tetrahedron.
fn barycentric([a, b, c, d]: [DVec3; 4], p: DVec3) -> [f64; 4] {
    let (ab, ac, ad, ap) = (b - a, c - a, d - a, p - a);
    let volume = ab.dot(ac.cross(ad));
    let [u, v, w] = [ap.dot(ac.cross(ad)), ap.dot(ad.cross(ab)), ap.dot(ab.cross(ac))].map(|x| x / volume);
    [1.0 - u - v - w, u, v, w]
}

/// Tetrahedra sorted into cubes.
struct Boxes {
    corner: DVec3,
    edge: f64,
    cells: [usize; 3],
    /// Begin of each cube's tetrahedra.
    starts: Vec<usize>,
    tets: Vec<u32>,
}

impl Boxes {
    fn new(cage: &Cage) -> Self {
        let nothing = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        let (low, high) = cage.rest.iter().fold(nothing, |(l, h), p| (l.min(*p), h.max(*p)));
        // As many cubes as tetrahedra would fill the box.
        #[expect(clippy::cast_precision_loss, reason = "an estimate")]
        let limit = libm::cbrt((high - low).element_product() / (8.0 * cage.tets.len() as f64 + 64.0));
        let edge = cage.edge.max(limit).max(f64::MIN_POSITIVE);
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "limited by edge")]
        let cells = ((high - low) / edge).to_array().map(|n| n.clamp(0.0, 1e6) as usize + 1);
        let mut boxes = Self { corner: low, edge, cells, starts: Vec::new(), tets: Vec::new() };
        let mut pairs = Vec::new();
        for (number, tet) in (0_u32..).zip(&cage.tets) {
            let corners = tet.map(|i| cage.rest[i as usize]);
            let (low, high) = corners.iter().fold(nothing, |(l, h), p| (l.min(*p), h.max(*p)));
            boxes.around(low, high, |cell| pairs.push((cell, number)));
        }
        pairs.sort_unstable();
        let count = cells.iter().product::<usize>();
        boxes.starts = (0..=count).map(|cell| pairs.partition_point(|p| p.0 < cell)).collect();
        boxes.tets = pairs.into_iter().map(|p| p.1).collect();
        boxes
    }

    /// Cubes that meet a box, a little enlarged.
    fn around(&self, low: DVec3, high: DVec3, mut each: impl FnMut(usize)) {
        let rounding = DVec3::splat(OUTSIDE);
        let (low, high) =
            ((low - self.corner) / self.edge - rounding, (high - self.corner) / self.edge + rounding);
        let span = |k: usize| -> Range<usize> {
            #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped")]
            let cell = |x: f64| (x.max(0.0) as usize).min(self.cells[k] - 1);
            cell(low[k])..cell(high[k]) + 1
        };
        for z in span(2) {
            for y in span(1) {
                span(0).for_each(|x| each(x + self.cells[0] * (y + self.cells[1] * z)));
            }
        }
    }

    fn find(&self, cage: &Cage, p: DVec3) -> Option<Place> {
        let mut best: Option<(f64, Place)> = None;
        self.around(p, p, |cell| {
            for &tet in &self.tets[self.starts[cell]..self.starts[cell + 1]] {
                let weights = barycentric(cage.tets[tet as usize].map(|i| cage.rest[i as usize]), p);
                let depth = weights.into_iter().fold(f64::INFINITY, f64::min);
                let first = |(d, place): &(f64, Place)| depth > *d || (depth >= *d && tet < place.tet);
                if best.as_ref().is_none_or(first) {
                    best = Some((depth, Place { tet, weights }));
                }
            }
        });
        best.map(|(_, place)| place)
    }
}
