//! Triangles that cross triangles: what local soundness cannot see, found by boxes and exact signs.
//!
//! Two triangles cross where an edge of one runs through the inside of the other: the edge's ends are on different
//! sides of the plane, and the corners all turn the same way around the edge (Shewchuk 1997 for the signs). Touching
//! does not count, so neighbors, which share corners, need no exception.

use glam::DVec3;
use rayon::prelude::*;
use robust::{Coord3D, orient3d};
use rstar::primitives::{GeomWithData, Rectangle};
use rstar::{AABB, RTree};

type Boxes = RTree<GeomWithData<Rectangle<[f64; 3]>, u32>>;

/// Pairs `(t, u)` of triangles `t` at `a` and `u` at `b` that cross, ascending; where both are the same surface each
/// pair once, `t < u`.
pub(crate) fn crossings(a: &[DVec3], b: Option<&[DVec3]>, triangles: &[[u32; 3]]) -> Vec<(u32, u32)> {
    let other = b.unwrap_or(a);
    let boxes = triangles.iter().zip(0_u32..).map(|(t, number)| {
        let (low, high) = bounds(&corners(other, *t));
        GeomWithData::new(Rectangle::from_corners(low, high), number)
    });
    let tree: Boxes = RTree::bulk_load(boxes.collect());
    let pairs = |t: u32| {
        let mine = corners(a, triangles[t as usize]);
        let (low, high) = bounds(&mine);
        let near = tree.locate_in_envelope_intersecting(&AABB::from_corners(low, high)).map(|g| g.data);
        let mut found: Vec<(u32, u32)> = near
            .filter(|u| b.is_some() || *u > t)
            .filter(|u| cross(&mine, &corners(other, triangles[*u as usize])))
            .map(|u| (t, u))
            .collect();
        found.sort_unstable();
        found
    };
    let count = u32::try_from(triangles.len()).unwrap_or(u32::MAX);
    (0..count).into_par_iter().flat_map_iter(pairs).collect()
}

fn corners(points: &[DVec3], t: [u32; 3]) -> [DVec3; 3] {
    t.map(|i| points[i as usize])
}

fn bounds([a, b, c]: &[DVec3; 3]) -> ([f64; 3], [f64; 3]) {
    (a.min(*b).min(*c).to_array(), a.max(*b).max(*c).to_array())
}

/// Whether two triangles cross.
fn cross(t: &[DVec3; 3], u: &[DVec3; 3]) -> bool {
    let of_t = t.map(|p| side(u[0], u[1], u[2], p));
    // Most neighbors of a triangle end here: no edge of one has its ends on both sides of the other.
    if is_one_sided(of_t) {
        return false;
    }
    let of_u = u.map(|p| side(t[0], t[1], t[2], p));
    !is_one_sided(of_u) && (pierces(t, of_t, u) || pierces(u, of_u, t))
}

fn is_one_sided(sides: [f64; 3]) -> bool {
    sides.iter().all(|s| *s >= 0.0) || sides.iter().all(|s| *s <= 0.0)
}

/// Whether an edge of `t`, whose corners are on the given sides of `u`, runs through the inside of `u`.
fn pierces(t: &[DVec3; 3], sides: [f64; 3], [a, b, c]: &[DVec3; 3]) -> bool {
    (0..3).any(|i| {
        let (p, q) = (t[i], t[(i + 1) % 3]);
        if sides[i] * sides[(i + 1) % 3] >= 0.0 {
            return false;
        }
        let turns = [side(p, q, *a, *b), side(p, q, *b, *c), side(p, q, *c, *a)];
        turns.iter().all(|s| *s > 0.0) || turns.iter().all(|s| *s < 0.0)
    })
}

/// Sign of the volume of a tetrahedron, exact.
fn side(a: DVec3, b: DVec3, c: DVec3, d: DVec3) -> f64 {
    let [a, b, c, d] = [a, b, c, d].map(|p| Coord3D { x: p.x, y: p.y, z: p.z });
    // The product of two tiny volumes must not vanish.
    match orient3d(a, b, c, d) {
        v if v > 0.0 => 1.0,
        v if v < 0.0 => -1.0,
        _ => 0.0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pairs(points: &[[f64; 3]], triangles: &[[u32; 3]]) -> Vec<(u32, u32)> {
        crossings(&points.iter().map(|p| DVec3::from_array(*p)).collect::<Vec<_>>(), None, triangles)
    }

    #[test]
    fn a_needle_through_a_plate_crosses_it_and_a_touch_does_not() {
        let plate = [[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0]];
        for (tip, crossed) in [(-1e-300, true), (0.0, false), (1e-300, false)] {
            let needle = [[1.0, 1.0, tip], [1.1, 1.0, 2.0], [1.0, 1.1, 2.0]];
            let found = pairs(&[plate, needle].concat(), &[[0, 1, 2], [3, 4, 5]]);
            assert_eq!(!found.is_empty(), crossed, "{tip}");
        }
    }

    #[test]
    fn an_edge_beside_a_plate_runs_through_its_plane_alone() {
        let plate = [[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0]];
        let needle = [[1.0, 3.5, -1.0], [1.0, 3.6, 1.0], [1.1, 3.7, 1.0]];
        assert!(
            pairs(&[plate, needle].concat(), &[[0, 1, 2], [3, 4, 5]]).is_empty(),
            "each is on both sides of the other's plane"
        );
    }

    #[test]
    fn neighbors_cross_only_when_folded_through_each_other() {
        // Two triangles with one common corner; the second passes through the first or beside it.
        let common = [[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [0.0, 2.0, 0.0]];
        let through = [[0.8, 0.5, 1.0], [0.8, 0.5, -1.0]];
        let beside = [[-0.8, 0.5, 1.0], [-0.8, 0.5, -1.0]];
        for (edge, count) in [(through, 1), (beside, 0)] {
            let points = [common.to_vec(), edge.to_vec()].concat();
            assert_eq!(pairs(&points, &[[0, 1, 2], [0, 3, 4]]).len(), count);
        }
    }
}
