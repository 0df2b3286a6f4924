//! What a layered cage is like, counted.

use super::Layers;
use super::crossing::crossings;
use crate::fem::prism;
use glam::DVec3;
use rayon::prelude::*;

/// Counts and thicknesses.
#[derive(Clone, Debug, PartialEq)]
pub struct Quality {
    /// Prisms without a volume above 0.
    pub inverted: usize,
    /// Prisms with a Jacobian that is not above 0 at one of the 18 points of the quadrature, or more.
    pub negative: usize,
    /// Prisms with a Jacobian that might not be above 0 somewhere: a coefficient of its Bernstein form is not.
    pub unsound: usize,
    /// Pairs of triangles that cross in each layer: bone, muscle, skin.
    pub crossings: [usize; 3],
    /// Pairs of triangles that cross between layers: bone and muscle, muscle and skin, bone and skin.
    pub between: [usize; 3],
    /// Distances from skin to bone, m, ascending.
    pub depths: Vec<f64>,
    /// Smallest, and volume of all prisms, m³.
    pub volume: [f64; 2],
}

impl Quality {
    /// The depth that a share `q` of all columns does not reach, m.
    #[must_use]
    #[expect(
        clippy::cast_precision_loss,
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "an index"
    )]
    pub fn depth(&self, q: f64) -> f64 {
        let last = self.depths.len().saturating_sub(1);
        self.depths.get((q.clamp(0.0, 1.0) * last as f64) as usize).copied().unwrap_or(0.0)
    }
}

/// Not so for 0 and NaN.
fn is_above_zero(x: f64) -> bool {
    x > 0.0
}

impl Layers {
    /// Counts what could be wrong. All but `crossings` is 0 in a cage that [`Layers::new`] made; those are 0 unless the
    /// skin crosses itself.
    #[must_use]
    pub fn quality(&self) -> Quality {
        let n = self.columns();
        let nodes = |p: &[u32; 6]| p.map(|i| self.rest[i as usize]);
        let count = |bad: &(dyn Fn(&[DVec3; 6]) -> bool + Sync)| {
            self.prisms.par_iter().filter(|p| bad(&nodes(p))).count()
        };
        let volumes: Vec<f64> = self.prisms.par_iter().map(|p| prism::mean(nodes(p)).1).collect();
        let triangles = self.triangles();
        let layer = |k: usize| &self.rest[k * n..(k + 1) * n];
        let mut depths: Vec<f64> = layer(0).iter().zip(layer(2)).map(|(b, s)| b.distance(*s)).collect();
        depths.sort_by(f64::total_cmp);
        Quality {
            inverted: volumes.iter().filter(|v| !is_above_zero(**v)).count(),
            negative: count(&|p| !is_above_zero(prism::smallest_jacobian(p))),
            unsound: count(&|p| !super::sound::is_sound(p, 0.0)),
            crossings: [0, 1, 2].map(|k| crossings(layer(k), None, &triangles).len()),
            between: [(0, 1), (1, 2), (0, 2)]
                .map(|(k, l)| crossings(layer(k), Some(layer(l)), &triangles).len()),
            depths,
            volume: [volumes.iter().copied().fold(f64::INFINITY, f64::min), volumes.iter().sum()],
        }
    }
}
