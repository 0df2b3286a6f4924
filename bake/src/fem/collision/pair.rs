//! Two parts of a surface that may touch, and what they feel of each other.
//!
//! ```text
//! E = m(x) b(D(x)),   b of κ, A and d̂
//! ```
//!
//! `b` is the [barrier], `m` the [mollifier](super::mollifier) of nearly parallel edges (1 for points and triangles), `D` the
//! squared [distance](super::distance).

use super::barrier::barrier;
use super::distance::Nearest;
use super::mollifier::Mollifier;
use crate::fem::blocks::{Blocks, product};
use glam::DVec3;

/// What may touch what.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Kind {
    /// The first point, and the triangle of the other three.
    PointTriangle,
    /// The edge of the first two, and that of the last two.
    EdgeEdge {
        /// `εₓ` of the [mollifier](super::mollifier), m⁴.
        parallel: f64,
    },
}

/// Two parts of a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pair {
    /// Points of the surface.
    pub points: [u32; 4],
    /// Which of them belong together.
    pub kind: Kind,
    /// Distance `d̂` from which on they feel nothing of each other, m.
    pub reach: f64,
    /// Area `A` that they stand for, m².
    pub area: f64,
}

impl Pair {
    /// Where its points are.
    #[must_use]
    pub fn corners(&self, points: &[DVec3]) -> [DVec3; 4] {
        self.points.map(|i| points[i as usize])
    }

    /// Where they are nearest to each other.
    #[must_use]
    pub fn nearest(&self, corners: [DVec3; 4]) -> Nearest {
        match self.kind {
            Kind::PointTriangle => Nearest::point_triangle(corners),
            Kind::EdgeEdge { .. } => Nearest::edge_edge(corners),
        }
    }

    /// That of two edges where they are nearly parallel; else it is 1.
    fn mollifier(&self, corners: [DVec3; 4]) -> Option<Mollifier> {
        let Kind::EdgeEdge { parallel } = self.kind else { return None };
        Some(Mollifier::new(corners, parallel)).filter(|m| !m.is_one())
    }
}

/// A pair somewhere.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Touch<'a> {
    /// The pair.
    pub pair: &'a Pair,
    /// Where it is nearest to itself.
    pub nearest: Nearest,
    /// `b`, J, and its derivatives by `D`.
    b: [f64; 3],
    mollifier: Option<Mollifier>,
}

impl<'a> Touch<'a> {
    /// Where its points are at `corners`, with the stiffness `κ`, Pa; none where it feels nothing.
    #[must_use]
    pub fn new(pair: &'a Pair, corners: [DVec3; 4], stiffness: f64) -> Option<Self> {
        let nearest = pair.nearest(corners);
        let squared = nearest.squared();
        (squared < pair.reach * pair.reach).then(|| {
            let b = barrier(squared, pair.reach, stiffness * pair.area);
            Self { pair, nearest, b, mollifier: pair.mollifier(corners) }
        })
    }

    /// `E`, J.
    #[must_use]
    pub fn energy(&self) -> f64 {
        self.mollifier.map_or(self.b[0], |m| m.value() * self.b[0])
    }

    /// `∂E/∂x`, N, by its points.
    #[must_use]
    pub fn slopes(&self) -> [DVec3; 4] {
        let [b, first, _] = self.b;
        let slopes = self.nearest.slopes().map(|slope| first * slope);
        let Some(m) = self.mollifier else { return slopes };
        let of_m = m.slopes();
        [0, 1, 2, 3].map(|i| m.value() * slopes[i] + b * of_m[i])
    }

    /// `∂²E/∂x²`, N/m; or a positive semi-definite matrix above it.
    #[must_use]
    pub fn hessian(&self, projected: bool) -> Blocks<4> {
        let [b, first, second] = self.b;
        let of_b = |w: f64| {
            let (first, second) = (w * first, w * second);
            if projected { self.nearest.positive(first, second) } else { self.nearest.hessian(first, second) }
        };
        let Some(m) = self.mollifier else { return of_b(1.0) };
        let mut h = of_b(m.value());
        for (row, more) in h.iter_mut().zip(m.hessian(b, projected)) {
            row.iter_mut().zip(more).for_each(|(block, more)| *block += more);
        }
        product(&mut h, first, &m.slopes(), &self.nearest.slopes(), projected);
        h
    }
}
