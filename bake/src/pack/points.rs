//! Distinct points of the render mesh: what moves, each once.
//!
//! Render vertices that were split for texture or normals have the same position, influences and
//! softness; the springs of such twins are the same, so one point serves them all.

use crate::Model;
use crate::recipe::Flesh;
use std::collections::BTreeMap;

/// Points, those with flesh first, by region and number of influences, so that kernels meet long equal runs.
#[derive(Debug)]
pub(super) struct Points {
    /// Points with flesh.
    pub(super) active: usize,
    /// Influences a point.
    pub(super) stride: usize,
    /// Rest positions, bind space.
    pub(super) rest: Vec<[f32; 3]>,
    /// `stride` joints a point.
    pub(super) joints: Vec<u16>,
    /// `stride` weights a point.
    pub(super) weights: Vec<f32>,
    /// Region a point.
    pub(super) region: Vec<u8>,
    /// Softness a point.
    pub(super) softness: Vec<f32>,
    /// Point of each render vertex.
    pub(super) of_vertex: Vec<u32>,
}

/// A point before numbering.
struct Candidate {
    rest: [f32; 3],
    influences: Vec<(u16, f32)>,
    region: u8,
    softness: f32,
}

impl Candidate {
    /// Equal for twins.
    fn key(&self) -> Vec<u32> {
        let mut key: Vec<u32> = self.rest.iter().map(|x| (x + 0.0).to_bits()).collect();
        key.extend([self.softness.to_bits(), u32::from(self.region)]);
        key.extend(self.influences.iter().flat_map(|(j, w)| [u32::from(*j), w.to_bits()]));
        key
    }

    /// Order of points.
    fn rank(&self) -> (bool, u8, usize) {
        (self.softness <= 0.0, self.region, self.influences.len())
    }
}

impl Points {
    /// Finds the points of all primitives of `model`.
    pub(super) fn new(model: &Model, flesh: &Flesh) -> Self {
        let mut candidates: Vec<Candidate> = Vec::new();
        let mut known: BTreeMap<Vec<u32>, usize> = BTreeMap::new();
        let mut candidate_of_vertex = Vec::with_capacity(model.vertex_count());
        let mut vertex = 0;
        for p in &model.primitives {
            let rows = p.joints.chunks_exact(p.stride).zip(p.weights.chunks_exact(p.stride));
            for (rest, (joints, weights)) in p.positions.iter().zip(rows) {
                let row = joints.iter().copied().zip(weights.iter().copied());
                let candidate = Candidate {
                    rest: *rest,
                    influences: row.take_while(|(_, w)| *w > 0.0).collect(),
                    region: flesh.region[vertex],
                    softness: flesh.softness[vertex].clamp(0.0, 1.0),
                };
                let next = candidates.len();
                let id = *known.entry(candidate.key()).or_insert(next);
                if id == next {
                    candidates.push(candidate);
                }
                candidate_of_vertex.push(id);
                vertex += 1;
            }
        }
        Self::number(&candidates, &candidate_of_vertex)
    }

    fn number(candidates: &[Candidate], candidate_of_vertex: &[usize]) -> Self {
        let mut order: Vec<usize> = (0..candidates.len()).collect();
        order.sort_by_key(|i| (candidates[*i].rank(), *i));
        let mut point_of_candidate = vec![0_u32; candidates.len()];
        for (point, candidate) in (0..).zip(&order) {
            point_of_candidate[*candidate] = point;
        }
        let sorted = || order.iter().map(|i| &candidates[*i]);
        let stride = sorted().map(|c| c.influences.len()).max().unwrap_or(1).max(1).next_multiple_of(4);
        let padded = |c: &Candidate| {
            let filler = core::iter::repeat((c.influences.first().map_or(0, |i| i.0), 0.0));
            c.influences.clone().into_iter().chain(filler).take(stride).collect::<Vec<_>>()
        };
        Self {
            active: sorted().filter(|c| c.softness > 0.0).count(),
            stride,
            rest: sorted().map(|c| c.rest).collect(),
            joints: sorted().flat_map(padded).map(|(j, _)| j).collect(),
            weights: sorted().flat_map(padded).map(|(_, w)| w).collect(),
            region: sorted().map(|c| c.region).collect(),
            softness: sorted().map(|c| c.softness).collect(),
            of_vertex: candidate_of_vertex.iter().map(|i| point_of_candidate[*i]).collect(),
        }
    }

    /// Whether a point has flesh.
    pub(super) fn is_active(&self, point: u32) -> bool {
        (point as usize) < self.active
    }

    /// Render vertices on points with flesh.
    pub(super) fn moved(&self) -> Vec<u32> {
        (0..).zip(&self.of_vertex).filter(|(_, p)| self.is_active(**p)).map(|(v, _)| v).collect()
    }
}
