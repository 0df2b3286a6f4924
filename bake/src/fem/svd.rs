//! Singular values of a 3×3 with rotations on both sides.
//!
//! ```text
//! F = U Σ Vᵀ,   det U = det V = 1,   σ₁ ≥ σ₂ ≥ |σ₃|,   sign σ₃ = sign det F
//! ```
//!
//! One-sided Jacobi: columns of `F` are turned against each other until they are orthogonal; their lengths are then the
//! singular values, each with a small relative error, tiny ones too (Demmel, Veselić 1992). An inverted element has a
//! negative `σ₃`, so that its energy goes on smoothly through the flat state (Irving et al. 2004).

use glam::{DMat3, DVec3};

/// `U`, the diagonal of `Σ`, `V`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Svd {
    /// Rotation on the left.
    pub u: DMat3,
    /// Principal stretches: falling, the last with the sign of the determinant.
    pub s: [f64; 3],
    /// Rotation on the right.
    pub v: DMat3,
}

/// Sweeps over the three pairs; each about squares what is left, so that four or five are enough.
const SWEEPS: usize = 12;
/// Columns are orthogonal when their cosine is below.
const COSINE: f64 = 1e-15;

impl Svd {
    /// Of a finite `f`.
    #[must_use]
    pub fn new(f: &DMat3) -> Self {
        // A power of two keeps squares from overflow and underflow, and rounds nothing.
        let largest = f.to_cols_array().into_iter().fold(0.0, |most: f64, x| most.max(x.abs()));
        let scale = if largest > 0.0 { libm::exp2(-f64::from(libm::ilogb(largest))) } else { 1.0 };
        let (mut b, mut v) = (*f * scale, DMat3::IDENTITY);
        for _ in 0..SWEEPS {
            let turned = [(0, 1), (0, 2), (1, 2)].map(|(i, j)| turn(&mut b, &mut v, i, j));
            if turned == [false; 3] {
                break;
            }
        }
        let mut order = [0, 1, 2];
        order.sort_by(|i, j| b.col(*j).length_squared().total_cmp(&b.col(*i).length_squared()));
        let sorted = |m: &DMat3| DMat3::from_cols(m.col(order[0]), m.col(order[1]), m.col(order[2]));
        let (b, mut v) = (sorted(&b), sorted(&v));
        if v.determinant() < 0.0 {
            v.z_axis = -v.z_axis;
        }
        let u = left(&b);
        // Of `F V`, whose last column was perhaps not turned round with that of `V`.
        let third = u.z_axis.dot(*f * scale * v.z_axis);
        let s = [b.x_axis.length(), b.y_axis.length(), third].map(|s| s / scale);
        Self { u, s, v }
    }

    /// `U diag(d) Vᵀ`.
    #[must_use]
    pub fn compose(&self, d: [f64; 3]) -> DMat3 {
        self.u * DMat3::from_diagonal(d.into()) * self.v.transpose()
    }

    /// The rotation nearest to `F`: `U Vᵀ`.
    #[must_use]
    pub fn rotation(&self) -> DMat3 {
        self.u * self.v.transpose()
    }
}

/// Turns columns `i` and `j` of `b`, and of `v` with them, until they are orthogonal; whether they were not.
fn turn(b: &mut DMat3, v: &mut DMat3, i: usize, j: usize) -> bool {
    let (p, q) = (b.col(i), b.col(j));
    let (pp, qq, pq) = (p.length_squared(), q.length_squared(), p.dot(q));
    if pq.abs() <= COSINE * (pp * qq).sqrt() {
        return false;
    }
    let zeta = (qq - pp) / (2.0 * pq);
    let t = zeta.signum() / (zeta.abs() + (1.0 + zeta * zeta).sqrt());
    let c = 1.0 / (1.0 + t * t).sqrt();
    for m in [b, v] {
        let (p, q) = (m.col(i), m.col(j));
        *m.col_mut(i) = c * (p - t * q);
        *m.col_mut(j) = c * (t * p + q);
    }
    true
}

/// A rotation whose first two columns are the directions of those of `b`; any where they have none.
fn left(b: &DMat3) -> DMat3 {
    let x = b.x_axis.try_normalize().unwrap_or(DVec3::X);
    // What rounding left of the first is taken out.
    let across = b.y_axis - x * x.dot(b.y_axis);
    let y = across.try_normalize().unwrap_or_else(|| x.any_orthonormal_vector());
    DMat3::from_cols(x, y, x.cross(y))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fem::energy::cases::deformations;

    #[test]
    fn every_deformation_is_put_together_again() {
        for (name, f) in deformations() {
            let svd = Svd::new(&f);
            let size = f.to_cols_array().into_iter().fold(0.0, |most: f64, x| most.max(x.abs()));
            let off = |a: DMat3, b: DMat3| {
                (a - b).to_cols_array().into_iter().fold(0.0, |m: f64, x| m.max(x.abs()))
            };
            assert!(off(svd.compose(svd.s), f) <= 4e-15 * size, "{name}: {f}");
            for r in [svd.u, svd.v] {
                assert!(off(r * r.transpose(), DMat3::IDENTITY) < 4e-15, "{name}: {r}");
                assert!((r.determinant() - 1.0).abs() < 4e-15, "{name}: {r}");
            }
            let [a, b, c] = svd.s;
            assert!(a >= b && b >= c.abs() * (1.0 - 1e-14), "{name}: {:?}", svd.s);
        }
    }

    /// A stretch of 1e-12 keeps its digits beside one of 1.
    #[test]
    fn small_stretches_are_accurate() {
        let r = DMat3::from_axis_angle(DVec3::new(0.6, 0.0, 0.8), 1.1);
        let f = r * DMat3::from_diagonal(DVec3::new(1.0, 1e-6, 1e-12));
        let s = Svd::new(&f).s;
        for (found, want) in s.into_iter().zip([1.0, 1e-6, 1e-12]) {
            assert!((found / want - 1.0).abs() < 1e-13, "{found} {want}");
        }
    }
}
