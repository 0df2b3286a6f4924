//! Skin weights: each vertex starts at the joint of the nearest part, then heat spreads over the surface.
//!
//! Spreading along the surface, not through the air, keeps an arm's heat out of the belly beside it.

use super::mesh::Half;
use super::shape::Shape;
use super::skeleton::{Bone, JOINTS, Side, index, mirrored};

/// Share of every joint in a vertex.
type Row = [f64; JOINTS];

/// Rounds of diffusion: the blend between two joints is about √rounds · 0.7 edges wide to either side.
const ROUNDS: usize = 28;
/// Further rounds within the torso, where bends are spread wide.
const TORSO_ROUNDS: usize = 50;
/// Influences a vertex.
pub(super) const STRIDE: usize = 4;

/// Joints and weights of a vertex, descending.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Influences {
    pub(super) joints: [usize; STRIDE],
    pub(super) weights: [f64; STRIDE],
}

impl Influences {
    /// One joint alone.
    pub(super) fn only(joint: usize) -> Self {
        Self { joints: [joint, 0, 0, 0], weights: [1.0, 0.0, 0.0, 0.0] }
    }

    /// The mirror image.
    pub(super) fn mirrored(&self) -> Self {
        let mut joints = self.joints;
        for (joint, weight) in joints.iter_mut().zip(self.weights) {
            *joint = if weight > 0.0 { mirrored(*joint) } else { 0 };
        }
        Self { joints, weights: self.weights }
    }

    /// The [`STRIDE`] largest of a row.
    fn of(row: &Row, seam: bool) -> Self {
        let mut order: Vec<usize> = (0..JOINTS).collect();
        // A pair of equal weights on the plane of symmetry is kept or dropped as a whole.
        order.sort_by(|a, b| row[*b].total_cmp(&row[*a]).then(a.cmp(b)));
        order.truncate(STRIDE);
        if seam {
            let kept = order.clone();
            order.retain(|j| kept.contains(&mirrored(*j)));
        }
        order.retain(|j| row[*j] > 0.01);
        let sum: f64 = order.iter().map(|j| row[*j]).sum();
        let mut out = Self::only(0);
        for k in 0..STRIDE {
            let joint = order.get(k);
            out.joints[k] = joint.copied().unwrap_or(0);
            out.weights[k] = joint.map_or(0.0, |j| row[*j] / sum);
        }
        out
    }
}

/// Weights of the half's vertices.
pub(super) fn weights(shape: &Shape, half: &Half) -> Vec<Influences> {
    let ring = half.neighbors();
    let mut rows: Vec<Row> = Vec::with_capacity(ring.len());
    let mut torso = Vec::with_capacity(ring.len());
    for p in &half.positions {
        let bone = shape.nearest(*p).bone;
        torso.push(matches!(bone, Bone::Hips | Bone::Spine | Bone::Chest | Bone::Neck | Bone::Shoulder));
        let mut row = [0.0; JOINTS];
        row[index(bone, Side::Left)] = 1.0;
        rows.push(row);
    }
    for (i, row) in rows.iter_mut().enumerate() {
        if half.seam[i] {
            symmetrize(row);
        }
    }
    // The limbs' heat stays outside meanwhile.
    let within = |i: usize| {
        if torso[i] { ring[i].iter().copied().filter(|j| torso[*j]).collect() } else { Vec::new() }
    };
    let inner: Vec<Vec<usize>> = (0..ring.len()).map(within).collect();
    for round in 0..TORSO_ROUNDS + ROUNDS {
        let ring = if round < TORSO_ROUNDS { &inner } else { &ring };
        rows = (0..rows.len()).map(|i| spread(&rows, i, &ring[i], &half.seam)).collect();
    }
    rows.iter().zip(&half.seam).map(|(row, seam)| Influences::of(row, *seam)).collect()
}

/// A step of diffusion at vertex `i`; beyond the plane of symmetry are the mirror images.
fn spread(rows: &[Row], i: usize, ring: &[usize], seam: &[bool]) -> Row {
    if ring.is_empty() {
        return rows[i];
    }
    let mut sum = [0.0; JOINTS];
    let mut total = 0.0;
    for &j in ring {
        total += 1.0;
        for (s, w) in sum.iter_mut().zip(&rows[j]) {
            *s += w;
        }
        if seam[i] && !seam[j] {
            total += 1.0;
            for (k, w) in rows[j].iter().enumerate() {
                sum[mirrored(k)] += w;
            }
        }
    }
    let mut out = rows[i];
    for (w, s) in out.iter_mut().zip(sum) {
        *w = 0.5 * *w + 0.5 * s / total;
    }
    if seam[i] {
        symmetrize(&mut out);
    }
    out
}

fn symmetrize(row: &mut Row) {
    let old = *row;
    for (k, w) in row.iter_mut().enumerate() {
        *w = 0.5 * (old[k] + old[mirrored(k)]);
    }
}
