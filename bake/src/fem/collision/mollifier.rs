//! The smooth end of what edges feel as they become parallel.
//!
//! ```text
//! m = q(2 − q),   q = |e₁ × e₂|²/εₓ   for q < 1, else 1;   εₓ = 10⁻³ |ē₁|² |ē₂|²
//! ```
//!
//! Where edges are parallel the points that are nearest jump along them, and the slope of the distance with them; `m` takes
//! their energy to zero there (Li et al. 2020, section 5.3: Incremental Potential Contact). Points and triangles stand in.

use crate::fem::blocks::{Blocks, square};
use crate::fem::element::outer;
use glam::{DMat3, DVec3};

/// `εₓ` over the squared product of the lengths at rest.
const PART: f64 = 1e-3;

/// Where two edges are, and how nearly parallel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mollifier {
    edges: [DVec3; 2],
    cross: DVec3,
    limit: f64,
    /// `q`, at most 1.
    q: f64,
}

/// `εₓ` of two edges, m⁴, from where their ends are at rest.
#[must_use]
pub fn limit(rest: [DVec3; 4]) -> f64 {
    PART * rest[0].distance_squared(rest[1]) * rest[2].distance_squared(rest[3])
}

impl Mollifier {
    /// Of the edges of the first two and of the last two points, with `εₓ`, m⁴.
    #[must_use]
    pub fn new(x: [DVec3; 4], limit: f64) -> Self {
        let edges = [x[1] - x[0], x[3] - x[2]];
        let cross = edges[0].cross(edges[1]);
        let q = (cross.length_squared() / limit).min(1.0);
        Self { edges, cross, limit, q }
    }

    /// Whether it is 1, without slopes.
    #[must_use]
    pub fn is_one(&self) -> bool {
        self.q >= 1.0
    }

    /// `m`.
    #[must_use]
    pub fn value(&self) -> f64 {
        self.q * (2.0 - self.q)
    }

    /// `∂m/∂(|e₁ × e₂|²)`, 1/m⁴; not negative.
    fn slope(&self) -> f64 {
        2.0 * (1.0 - self.q) / self.limit
    }

    /// `∂m/∂xᵢ`, 1/m.
    #[must_use]
    pub fn slopes(&self) -> [DVec3; 4] {
        let [e, f] = self.edges;
        ends(2.0 * self.slope() * f.cross(self.cross), 2.0 * self.slope() * self.cross.cross(e))
    }

    /// `w ∂²m/∂x²`, `w ≥ 0`; or a positive semi-definite matrix above it.
    ///
    /// `∂²(|n|²)`, `n = e₁ × e₂`, is `2|δn|² + 4 n·(δe₁ × δe₂)`: a square, and a part with the eigenvalues `±2|n|` twice each.
    #[must_use]
    pub fn hessian(&self, w: f64, projected: bool) -> Blocks<4> {
        let [e, f] = self.edges;
        let (length, slope) = (self.cross.length(), w * self.slope());
        let (of_e, of_f) = (crossed(f).transpose(), crossed(e));
        let mixed = if projected { 1.0 } else { 2.0 };
        let mut own = [of_e.transpose() * of_e * 2.0, of_f.transpose() * of_f * 2.0];
        let other = of_e.transpose() * of_f * 2.0 + crossed(self.cross) * (-mixed);
        if projected && length > 0.0 {
            let n = self.cross / length;
            let flat = DMat3::IDENTITY - outer(n, n);
            own = own.map(|own| own + flat * length);
        }
        let [ee, ff] = own.map(|own| own * slope);
        let ef = other * slope;
        let fe = ef.transpose();
        let zero = DMat3::ZERO;
        let mut h = [[ee, zero, zero, zero], [-ee, ee, zero, zero], [fe, -fe, ff, zero], [-fe, fe, -ff, ff]];
        if !projected && !self.is_one() {
            let slopes = ends(2.0 * f.cross(self.cross), 2.0 * self.cross.cross(e));
            square(&mut h, -2.0 * w / (self.limit * self.limit), &slopes);
        }
        h
    }
}

/// A slope by each edge as one by their ends.
fn ends(e: DVec3, f: DVec3) -> [DVec3; 4] {
    [-e, e, -f, f]
}

/// `[a]×`.
fn crossed(a: DVec3) -> DMat3 {
    DMat3::from_cols(DVec3::new(0.0, a.z, -a.y), DVec3::new(-a.z, 0.0, a.x), DVec3::new(a.y, -a.x, 0.0))
}
