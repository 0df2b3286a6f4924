//! The plane that maps a character onto itself, and which points it exchanges.

use glam::DVec3;
use serde::{Deserialize, Serialize};

use super::grid::Grid;
use super::surface::Surface;

/// How far from its mirror image a partner may be, body sizes.
const TOLERANCE: f64 = 0.004;
/// Share of the points that must have a partner.
const SHARE: f64 = 0.9;

/// The plane `normal · x = offset` that maps a character onto itself.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Mirror {
    /// Unit normal: an axis of the model.
    pub normal: [f64; 3],
    /// Distance from the origin along the normal, model units.
    pub offset: f64,
    /// Share of the welded vertices that have a mirror image, `0..=1`.
    pub matched: f64,
    /// Whether the plane is one of the bind pose, because the rest pose is not symmetric.
    pub of_bind_pose: bool,
}

/// A character's symmetry, found or supposed.
#[derive(Debug)]
pub(super) struct Symmetry {
    /// The plane, if the character is symmetric.
    pub(super) mirror: Option<Mirror>,
    /// Partner of each point, mutual; a point on the plane or without partner is its own.
    pub(super) partner: Vec<usize>,
    /// Positions in which left and right are compared, body sizes; the plane goes through the origin.
    pub(super) centered: Vec<DVec3>,
    /// Axis of the normal.
    pub(super) axis: usize,
}

impl Symmetry {
    /// Tries the planes x = 0, x = middle of the box, then z alike, in the rest pose and in the bind pose.
    pub(super) fn new(surface: &Surface) -> Self {
        let mut best: Option<Self> = None;
        for (of_bind_pose, positions) in [(false, &surface.points), (true, &surface.bind)] {
            let (low, high) = span(positions);
            let size = (high - low).length().max(f64::MIN_POSITIVE);
            let scaled: Vec<DVec3> = positions.iter().map(|p| (*p - low) / size).collect();
            // Rest positions count from the box's corner, bind positions from the origin.
            let origin = if of_bind_pose { DVec3::ZERO } else { -surface.corner / surface.size };
            let planes = [0, 2].map(|axis| {
                let extent = high[axis] - low[axis];
                [origin[axis] - low[axis], extent / 2.0].map(|offset| (axis, offset / size))
            });
            for (axis, middle) in planes.into_iter().flatten() {
                let found = Self::at(&scaled, axis, middle, of_bind_pose);
                let matched = found.mirror.map_or(0.0, |m| m.matched);
                // A later plane must be clearly better: the rest pose and x come first.
                if best.as_ref().is_none_or(|b| matched > b.mirror.map_or(0.0, |m| m.matched) + 0.02) {
                    let offset = low[axis] + middle * size;
                    let of_model = surface.corner[axis] + offset * surface.size;
                    let offset = if of_bind_pose { offset } else { of_model };
                    best = Some(Self { mirror: found.mirror.map(|m| Mirror { offset, ..m }), ..found });
                }
            }
        }
        let mut best = best.unwrap_or_else(|| Self::at(&surface.points, 0, 0.5, false));
        if best.mirror.is_none_or(|m| m.matched < SHARE) {
            best.mirror = None;
            best.partner = (0..surface.points.len()).collect();
        }
        best
    }

    fn at(scaled: &[DVec3], axis: usize, middle: f64, of_bind_pose: bool) -> Self {
        let mut center = DVec3::ZERO;
        center[axis] = middle;
        let centered: Vec<DVec3> = scaled.iter().map(|p| *p - center).collect();
        let grid = Grid::new(&centered, TOLERANCE);
        let nearest: Vec<Option<usize>> = centered
            .iter()
            .map(|p| {
                let image = mirrored(*p, axis);
                let near = grid.around(image).map(|j| (image.distance_squared(centered[j]), j));
                let closest = near.min_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
                closest.filter(|(d, _)| *d <= TOLERANCE * TOLERANCE).map(|(_, j)| j)
            })
            .collect();
        let matched = nearest.iter().flatten().count();
        let mutual = |(i, j): (usize, &Option<usize>)| j.filter(|j| nearest[*j] == Some(i)).unwrap_or(i);
        let partner = nearest.iter().enumerate().map(mutual).collect();
        let mut normal = [0.0; 3];
        normal[axis] = 1.0;
        #[expect(clippy::cast_precision_loss, reason = "a share of a count")]
        let matched = matched as f64 / scaled.len().max(1) as f64;
        let mirror = Some(Mirror { normal, offset: 0.0, matched, of_bind_pose });
        Self { mirror, partner, centered, axis }
    }

    /// A position on the other side.
    pub(super) fn mirrored(&self, p: DVec3) -> DVec3 {
        mirrored(p, self.axis)
    }

    /// Gives partners their mean.
    pub(super) fn average(&self, values: &mut [f64]) {
        for (i, j) in self.partner.iter().enumerate().filter(|(i, j)| i < *j) {
            let mean = (values[i] + values[*j]) / 2.0;
            (values[i], values[*j]) = (mean, mean);
        }
    }
}

fn mirrored(mut p: DVec3, axis: usize) -> DVec3 {
    p[axis] = -p[axis];
    p
}

fn span(positions: &[DVec3]) -> (DVec3, DVec3) {
    let first = positions.first().copied().unwrap_or_default();
    positions.iter().fold((first, first), |(low, high), p| (low.min(*p), high.max(*p)))
}
