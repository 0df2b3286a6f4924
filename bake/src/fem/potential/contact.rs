//! A body that does not pass through itself.
//!
//! ```text
//! E = Σ Eₖ,   Eₖ ≥ 0, infinite where pair k touches, 0 where it is farther apart than d̂ₖ
//! ```
//!
//! Over [pairs](crate::fem::collision::pair) of points and triangles and of edges and edges of a surface, which has no
//! friction. The surface must not cross itself when it begins to move, but for triangles that cross at rest: those never feel
//! each other. Which pairs there are changes from place to place: they are this potential's
//! [`touching`](Potential::touching) stencils, and [`limit`](Potential::limit) keeps steps from jumping over them.
//!
//! A list of all pairs nearby is kept until a point moved half of `d̂`; what it says does not depend on where it was made,
//! so neither does a result.

use super::Potential;
use crate::cage::layers::crossing::crossings;
use crate::fem::assembly::Assembly;
use crate::fem::blocks::Blocks;
use crate::fem::collision::advance::advance;
use crate::fem::collision::near::Finder;
use crate::fem::collision::pair::{Pair, Touch};
use crate::fem::surface::Surface;
use glam::DVec3;
use rayon::prelude::*;
use std::sync::{Arc, Mutex, PoisonError};

/// Pairs at a time: bounds the memory for their matrices.
const CHUNK: usize = 2048;
/// How far points may move until pairs are looked for again, as a part of `d̂`.
const SLACK: f64 = 0.5;

/// How a surface keeps off itself.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Barrier {
    /// `d̂`, m: nearer than that its parts feel each other.
    pub reach: f64,
    /// `κ`, Pa: about Young's modulus of what it bounds.
    pub stiffness: f64,
}

/// Settings that cannot be.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error("contact with {0:?}; both must be above 0 and finite: a tenth of an edge, Young's modulus")]
pub struct BarrierError(pub Barrier);

/// Contact of a surface with itself.
///
/// ```
/// use glam::DVec3;
/// use sinew_bake::fem::surface::Surface;
/// use sinew_bake::fem::potential::{Potential, contact::{Barrier, Contact}};
/// let plate = [DVec3::ZERO, DVec3::X, DVec3::Y];
/// let rest: Vec<DVec3> = plate.into_iter().chain(plate.map(|x| x + DVec3::Z)).collect();
/// let plates = Surface::of_nodes(&rest, vec![[0, 2, 1], [3, 4, 5]])?;
/// let contact = Contact::new(plates, Barrier { reach: 0.1, stiffness: 1e4 })?;
/// let lowered = |by: f64| (0..6).map(|i| rest[i] - by * f64::from(u8::from(i > 2)) * DVec3::Z).collect::<Vec<_>>();
/// assert_eq!(contact.energy(&lowered(0.75)), 0.0);
/// assert!(contact.energy(&lowered(0.95)) > 0.0);
/// let down: Vec<DVec3> = lowered(2.0).iter().zip(&rest).map(|(to, from)| *to - *from).collect();
/// assert!((0.45..0.5).contains(&contact.limit(&rest, &down)));
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Debug)]
pub struct Contact {
    /// What collides.
    pub surface: Surface,
    barrier: Barrier,
    finder: Finder,
    near: Mutex<Option<Arc<Near>>>,
}

/// Pairs nearer than `d̂` wherever no point is farther than [`SLACK`] from where it was.
#[derive(Debug)]
struct Near {
    points: Vec<DVec3>,
    pairs: Vec<Pair>,
}

impl Contact {
    /// Of a surface with itself.
    ///
    /// # Errors
    ///
    /// If a setting is not above 0 and finite.
    pub fn new(surface: Surface, barrier: Barrier) -> Result<Self, BarrierError> {
        let Barrier { reach, stiffness } = barrier;
        if !(reach > 0.0 && reach.is_finite() && stiffness > 0.0 && stiffness.is_finite()) {
            return Err(BarrierError(barrier));
        }
        let finder = Finder::new(&surface, reach);
        Ok(Self { surface, barrier, finder, near: Mutex::new(None) })
    }

    /// How many pairs of triangles cross each other.
    #[must_use]
    pub fn crossings(&self, x: &[DVec3]) -> usize {
        crossings(&self.surface.points(x), None, &self.surface.triangles).len()
    }

    /// How many pairs feel something, and the least distance among them over their `d̂`; 1 without any.
    #[must_use]
    pub fn closest(&self, x: &[DVec3]) -> (usize, f64) {
        let points = self.surface.points(x);
        let near = self.near(&points);
        let touches = self.touches(&near, &points);
        let share = |t: &Touch<'_>| libm::sqrt(t.nearest.squared()) / t.pair.reach;
        (touches.len(), touches.iter().map(share).fold(1.0, f64::min))
    }

    /// Pairs that may be nearer than `d̂`.
    fn near(&self, points: &[DVec3]) -> Arc<Near> {
        let mut kept = self.near.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(near) = kept.as_ref().filter(|near| self.holds(near, points)) {
            return Arc::clone(near);
        }
        let within = (1.0 + 2.0 * SLACK) * self.barrier.reach;
        let mut pairs = self.finder.pairs(&self.surface, points, points, within);
        pairs.retain(|pair| pair.nearest(pair.corners(points)).squared() < within * within);
        Arc::clone(kept.insert(Arc::new(Near { points: points.to_vec(), pairs })))
    }

    /// Whether all pairs that matter at `points` are in the list.
    fn holds(&self, near: &Near, points: &[DVec3]) -> bool {
        let slack = SLACK * self.barrier.reach;
        let moved = |i: &u32| near.points[*i as usize].distance_squared(points[*i as usize]);
        near.points.len() == points.len() && self.surface.corners.iter().all(|i| moved(i) <= slack * slack)
    }

    /// Pairs that feel something, in order.
    fn touches<'a>(&self, near: &'a Near, points: &[DVec3]) -> Vec<Touch<'a>> {
        let of = |pair: &'a Pair| Touch::new(pair, pair.corners(points), self.barrier.stiffness);
        near.pairs.par_iter().with_min_len(256).filter_map(of).collect()
    }
}

impl Potential for Contact {
    fn stencils(&self, _visit: &mut dyn FnMut(&[u32])) {}

    fn energy(&self, x: &[DVec3]) -> f64 {
        let points = self.surface.points(x);
        let near = self.near(&points);
        self.touches(&near, &points).iter().map(Touch::energy).sum()
    }

    fn gradient(&self, x: &[DVec3], out: &mut [DVec3]) {
        let points = self.surface.points(x);
        let near = self.near(&points);
        for touch in self.touches(&near, &points) {
            self.surface.spread(&touch.pair.points, &touch.slopes(), out);
        }
    }

    fn hessian(&self, x: &[DVec3], projected: bool, out: &mut Assembly<'_>) {
        let points = self.surface.points(x);
        let near = self.near(&points);
        for chunk in self.touches(&near, &points).chunks(CHUNK) {
            let matrices: Vec<Blocks<4>> =
                chunk.par_iter().with_min_len(32).map(|touch| touch.hessian(projected)).collect();
            for (touch, h) in chunk.iter().zip(&matrices) {
                self.surface.assemble(&touch.pair.points, h, out);
            }
        }
    }

    fn touching(&self, x: &[DVec3], visit: &mut dyn FnMut(&[u32])) {
        let points = self.surface.points(x);
        let near = self.near(&points);
        let mut nodes = Vec::new();
        for touch in self.touches(&near, &points) {
            self.surface.stencil(&touch.pair.points, &mut nodes, visit);
        }
    }

    fn limit(&self, x: &[DVec3], d: &[DVec3]) -> f64 {
        let (points, step) = (self.surface.points(x), self.surface.points(d));
        let ends: Vec<DVec3> = points.iter().zip(&step).map(|(p, d)| *p + *d).collect();
        let near = self.near(&points);
        let swept;
        let pairs = if self.holds(&near, &ends) {
            &near.pairs
        } else {
            swept = self.finder.pairs(&self.surface, &points, &ends, self.barrier.reach);
            &swept
        };
        let part = |pair: &Pair| advance(pair, pair.corners(&points), pair.corners(&step));
        pairs.par_iter().with_min_len(64).map(part).reduce(|| 1.0, f64::min)
    }
}
