//! Tangent stencils: how the slope of the offset field is felt by a vertex's normal.
//!
//! Least squares over up to four neighbours, edges `tₖ` projected to the tangent plane:
//! `gₖ = (Σ t·tᵀ)⁻¹·tₖ`, so that `Σ gₖ·(φ(pₖ) − φ(p))` is exact for linear φ.

use super::narrow;
use super::points::Points;
use crate::Model;
use glam::{DMat2, DVec2, DVec3};
use std::collections::BTreeMap;

/// Stencils of all vertices whose normals can turn.
#[derive(Debug, Default)]
pub(super) struct Stencils {
    pub(super) vertices: Vec<u32>,
    pub(super) points: Vec<[u32; 4]>,
    pub(super) tangents: Vec<[[f32; 3]; 4]>,
}

/// Makes the stencils.
pub(super) fn stencils(model: &Model, points: &Points) -> Stencils {
    let (surface, rings) = rings(model, points);
    let mut out = Stencils::default();
    for (vertex, group) in surface.group_of_vertex.iter().enumerate() {
        let own = points.of_vertex[vertex];
        let ring = &rings[*group];
        if !points.is_active(own) && !ring.iter().any(|p| points.is_active(*p)) {
            continue;
        }
        if let Some((neighbours, tangents)) = stencil(points, own, ring, surface.normals[vertex]) {
            out.vertices.push(u32::try_from(vertex).unwrap_or(u32::MAX));
            out.points.push(neighbours);
            out.tangents.push(tangents);
        }
    }
    out
}

/// Render vertices with the same position and normal are one group: a texture seam does not cut a ring.
struct Groups {
    group_of_vertex: Vec<usize>,
    normals: Vec<[f32; 3]>,
}

/// Neighbouring points of each group, by the triangles of all its vertices.
fn rings(model: &Model, points: &Points) -> (Groups, Vec<Vec<u32>>) {
    let mut known: BTreeMap<[u32; 6], usize> = BTreeMap::new();
    let (mut group_of_vertex, mut normals) = (Vec::new(), Vec::new());
    for p in &model.primitives {
        for (position, normal) in p.positions.iter().zip(&p.normals) {
            let [a, b, c] = position.map(|x| (x + 0.0).to_bits());
            let [d, e, f] = normal.map(|x| (x + 0.0).to_bits());
            let next = known.len();
            group_of_vertex.push(*known.entry([a, b, c, d, e, f]).or_insert(next));
            normals.push(*normal);
        }
    }
    let mut rings = vec![Vec::new(); known.len()];
    let mut first = 0;
    for p in &model.primitives {
        for triangle in &p.indices {
            let corners = triangle.map(|v| first + v as usize);
            for (i, corner) in corners.iter().enumerate() {
                for other in [corners[(i + 1) % 3], corners[(i + 2) % 3]] {
                    let point = points.of_vertex[other];
                    let ring: &mut Vec<u32> = &mut rings[group_of_vertex[*corner]];
                    if point != points.of_vertex[*corner] && !ring.contains(&point) {
                        ring.push(point);
                    }
                }
            }
        }
        first += p.positions.len();
    }
    (Groups { group_of_vertex, normals }, rings)
}

/// Stencil of a vertex on point `own`, or `None` where the neighbours span no plane.
fn stencil(points: &Points, own: u32, ring: &[u32], normal: [f32; 3]) -> Option<([u32; 4], [[f32; 3]; 4])> {
    let at = |p: u32| DVec3::from_array(points.rest[p as usize].map(f64::from));
    let n = DVec3::from_array(normal.map(f64::from)).try_normalize()?;
    let e1 = n.any_orthonormal_vector();
    let e2 = n.cross(e1);
    let flat = |p: u32| {
        let edge = at(p) - at(own);
        DVec2::new(edge.dot(e1), edge.dot(e2))
    };
    let chosen = spread(ring, flat);
    let square = |t: DVec2| DMat2::from_cols(t * t.x, t * t.y);
    let sum = chosen.iter().fold(DMat2::ZERO, |sum, p| sum + square(flat(*p)));
    let trace = sum.x_axis.x + sum.y_axis.y;
    if sum.determinant() <= 1e-6 * trace * trace || !trace.is_finite() || trace <= 0.0 {
        return None;
    }
    let inverse = sum.inverse();
    let mut out = ([own; 4], [[0.0; 3]; 4]);
    for (k, p) in chosen.iter().enumerate() {
        let g = inverse * flat(*p);
        out.0[k] = *p;
        out.1[k] = (e1 * g.x + e2 * g.y).to_array().map(narrow);
    }
    out.1.as_flattened().iter().all(|x| x.is_finite()).then_some(out)
}

/// At most four neighbours, spread around: by angle, then every n-th of them.
fn spread(ring: &[u32], flat: impl Fn(u32) -> DVec2) -> Vec<u32> {
    let mut sorted = ring.to_vec();
    let angle = |p: u32| {
        let t = flat(p);
        libm::atan2(t.y, t.x)
    };
    sorted.sort_by(|a, b| angle(*a).total_cmp(&angle(*b)).then(a.cmp(b)));
    let n = sorted.len();
    if n <= 4 { sorted } else { (0..4).map(|k| sorted[k * n / 4]).collect() }
}
