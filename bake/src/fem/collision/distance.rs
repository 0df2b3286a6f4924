//! Squared distances of points and triangles, of edges and edges, with both derivatives.
//!
//! ```text
//! D(x) = min_α |r|²,   r = Σ cᵢ(α) xᵢ,   c linear in α
//!
//! ∂D/∂xᵢ = 2cᵢ r
//! ∂²D/∂xᵢ∂xⱼ = 2cᵢcⱼ I − 2 Σₐ vᵢₐ vⱼₐᵀ,   vᵢₐ = pᵢₐ r + cᵢ eₐ
//! ```
//!
//! One formula serves all cases (point and point, line or plane; line and line): they differ in how many of the
//! coordinates `α` are free at the minimum, 0 to 2. `pₐ = ∂c/∂αₐ`, `eₐ = ∂r/∂αₐ`, and the coordinates are chosen so that
//! the `eₐ` are orthonormal. The second line is the envelope theorem, the third what is left
//! after `α` followed.
//!
//! A function `f(D)` with `f′ ≤ 0 ≤ 4f″D + 2f′`, as a barrier is, has with `r = d n`, `pₐ = σ p̂` the Hessian
//!
//! ```text
//! (4f″D + 2f′) ccᵀ⊗nnᵀ − 2f′ Σₐ [(dσ)² p̂p̂ᵀ⊗nnᵀ + dσ(p̂⊗n)(c⊗eₐ)ᵀ + dσ(c⊗eₐ)(p̂⊗n)ᵀ] + 2f′ ccᵀ⊗(I − nnᵀ − Σₐ eₐeₐᵀ)
//! ```
//!
//! Each bracket has one positive eigenvalue and one negative, in closed form: with `μ = (dσ ± √((dσ)² + 4|c|²))/2` the
//! eigenvector is `μ p̂⊗n + c⊗eₐ`, the eigenvalue `dσμ`. [`Nearest::positive`] leaves out the negative ones and the last
//! term, so that what it gives is positive semi-definite and nowhere below the true Hessian; it is not the nearest such matrix.

use crate::fem::blocks::{Blocks, square};
use glam::{DMat3, DVec3};

/// Edges are parallel, triangles degenerate, where the squared sine is below.
const PARALLEL: f64 = 1e-24;

/// A way in which the nearest points may move: `pₐ` and `eₐ`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Way {
    p: [f64; 4],
    e: DVec3,
}

/// Where two things are nearest to each other.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Nearest {
    /// `cᵢ`: the part of each point in the vector between.
    pub c: [f64; 4],
    /// `r`, m.
    pub between: DVec3,
    ways: [Way; 2],
    free: usize,
}

impl Nearest {
    /// Of a point, the first, and a triangle.
    ///
    /// ```
    /// use glam::DVec3;
    /// use sinew_bake::fem::collision::distance::Nearest;
    /// let above = Nearest::point_triangle([DVec3::new(0.2, 0.3, 2.0), DVec3::ZERO, DVec3::X, DVec3::Y]);
    /// assert_eq!(above.squared(), 4.0);
    /// let beyond = Nearest::point_triangle([DVec3::new(4.0, 0.0, 4.0), DVec3::ZERO, DVec3::X, DVec3::Y]);
    /// assert_eq!(beyond.squared(), 25.0);
    /// ```
    #[must_use]
    pub fn point_triangle(x: [DVec3; 4]) -> Self {
        let (e, f, w) = (x[2] - x[1], x[3] - x[1], x[0] - x[1]);
        let n = e.cross(f);
        let square = n.length_squared();
        if square > PARALLEL * e.length_squared() * f.length_squared() {
            let (u, v) = (w.cross(f).dot(n) / square, e.cross(w).dot(n) / square);
            if u > 0.0 && v > 0.0 && u + v < 1.0 {
                let c = [1.0, u + v - 1.0, -u, -v];
                let ways = [[0.0, 1.0, -1.0, 0.0], [0.0, 1.0, 0.0, -1.0]];
                return Self::free(c, n * (n.dot(w) / square), ways, [-e, -f]);
            }
        }
        nearer([[0, 1, 2], [0, 2, 3], [0, 3, 1]].map(|[p, i, j]| Self::point_edge(x, p, i, j)))
    }

    /// Of two edges.
    #[must_use]
    pub fn edge_edge(x: [DVec3; 4]) -> Self {
        let (e, f, w) = (x[1] - x[0], x[3] - x[2], x[2] - x[0]);
        let n = e.cross(f);
        let square = n.length_squared();
        if square > PARALLEL * e.length_squared() * f.length_squared() {
            let (s, t) = (w.cross(f).dot(n) / square, w.cross(e).dot(n) / square);
            if s > 0.0 && s < 1.0 && t > 0.0 && t < 1.0 {
                let c = [1.0 - s, s, t - 1.0, -t];
                let ways = [[-1.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, -1.0]];
                return Self::free(c, n * (-n.dot(w) / square), ways, [e, -f]);
            }
        }
        nearer([[0, 2, 3], [1, 2, 3], [2, 0, 1], [3, 0, 1]].map(|[p, i, j]| Self::point_edge(x, p, i, j)))
    }

    /// Of point `p` and the edge from `i` to `j`.
    fn point_edge(x: [DVec3; 4], p: usize, i: usize, j: usize) -> Self {
        let (e, w) = (x[j] - x[i], x[p] - x[i]);
        let t = e.dot(w) / e.length_squared();
        let inside = t > 0.0 && t < 1.0;
        // An edge without length is a point: t is not a number.
        let t = if inside {
            t
        } else if t >= 1.0 {
            1.0
        } else {
            0.0
        };
        let mut c = [0.0; 4];
        (c[p], c[i], c[j]) = (1.0, t - 1.0, -t);
        let between = if t < 1.0 { w - t * e } else { x[p] - x[j] };
        let mut ways = [Way::default(); 2];
        if inside {
            let length = e.length();
            ways[0].e = -e / length;
            (ways[0].p[i], ways[0].p[j]) = (1.0 / length, -1.0 / length);
        }
        Self { c, between, ways, free: usize::from(inside) }
    }

    /// With both coordinates free: made orthonormal by Gram and Schmidt.
    fn free(c: [f64; 4], between: DVec3, [p, q]: [[f64; 4]; 2], [e, f]: [DVec3; 2]) -> Self {
        let length = e.length();
        let (e, p) = (e / length, p.map(|p| p / length));
        let along = f.dot(e);
        let f = f - along * e;
        let rest = f.length();
        let q = [0, 1, 2, 3].map(|i| (q[i] - along * p[i]) / rest);
        Self { c, between, ways: [Way { p, e }, Way { p: q, e: f / rest }], free: 2 }
    }

    /// `D`, m².
    #[must_use]
    pub fn squared(&self) -> f64 {
        self.between.length_squared()
    }

    /// `∂D/∂xᵢ`, m.
    #[must_use]
    pub fn slopes(&self) -> [DVec3; 4] {
        self.c.map(|c| 2.0 * c * self.between)
    }

    /// Hessian of `f(D)` from `f′` and `f″`.
    #[must_use]
    pub fn hessian(&self, first: f64, second: f64) -> Blocks<4> {
        let mut h = [[DMat3::ZERO; 4]; 4];
        square(&mut h, 4.0 * second, &self.c.map(|c| c * self.between));
        for (i, row) in h.iter_mut().enumerate() {
            for (block, c) in row[..=i].iter_mut().zip(self.c) {
                *block += DMat3::from_diagonal(DVec3::splat(2.0 * first * self.c[i] * c));
            }
        }
        for way in &self.ways[..self.free] {
            let v = [0, 1, 2, 3].map(|i| way.p[i] * self.between + self.c[i] * way.e);
            square(&mut h, -2.0 * first, &v);
        }
        h
    }

    /// A positive semi-definite matrix above the Hessian of `f(D)`, where `f′ ≤ 0`.
    #[must_use]
    pub fn positive(&self, first: f64, second: f64) -> Blocks<4> {
        let mut h = [[DMat3::ZERO; 4]; 4];
        let d = self.between.length();
        if d == 0.0 {
            return h;
        }
        let n = self.between / d;
        square(&mut h, (4.0 * second * d * d + 2.0 * first).max(0.0), &self.c.map(|c| c * n));
        let of_c = dot(&self.c, &self.c);
        for way in &self.ways[..self.free] {
            let sigma = libm::sqrt(dot(&way.p, &way.p));
            let mu = 0.5 * (d * sigma + libm::sqrt(d * d * sigma * sigma + 4.0 * of_c));
            let v = [0, 1, 2, 3].map(|i| mu * way.p[i] / sigma * n + self.c[i] * way.e);
            square(&mut h, -2.0 * first * d * sigma * mu / (mu * mu + of_c), &v);
        }
        h
    }
}

/// The one with the smallest distance; of equals the first.
fn nearer<const N: usize>(all: [Nearest; N]) -> Nearest {
    all.into_iter().reduce(|a, b| if b.squared() < a.squared() { b } else { a }).unwrap_or(Nearest {
        c: [0.0; 4],
        between: DVec3::INFINITY,
        ways: [Way::default(); 2],
        free: 0,
    })
}

fn dot(a: &[f64; 4], b: &[f64; 4]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
