//! Springs along the edges of skin.
//!
//! ```text
//! ψ = ½ (l/l̄ − 1)²
//! H = d̂d̂ᵀ/l̄² + (1 − l̄/l)/l̄² (I − d̂d̂ᵀ)   by the vector from end to end, d̂ its direction
//! ```
//!
//! The stretching of neural deformation gradients' skin (Nolte et al. 2026). That is the eigen-system: of a
//! pressed spring the second eigenvalue is negative, and 0 where projected.

use crate::fem::element::outer;
use glam::{DMat3, DVec3};

/// An edge and its length at rest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stretching {
    /// `l̄`, m.
    pub rest: f64,
}

impl Stretching {
    /// Of an edge from its ends at rest; none where they are in one place.
    #[must_use]
    pub fn new([a, b]: [DVec3; 2]) -> Option<Self> {
        let rest = a.distance(b);
        (rest > 0.0).then_some(Self { rest })
    }

    /// `ψ`.
    #[must_use]
    pub fn density(&self, [a, b]: [DVec3; 2]) -> f64 {
        let strain = a.distance(b) / self.rest - 1.0;
        0.5 * strain * strain
    }

    /// `∂ψ/∂b`, 1/m; by `a` it is the opposite. Zero where both are in one place: there is no direction.
    #[must_use]
    pub fn slope(&self, [a, b]: [DVec3; 2]) -> DVec3 {
        let length = a.distance(b);
        if length == 0.0 {
            return DVec3::ZERO;
        }
        (b - a) * ((length / self.rest - 1.0) / (self.rest * length))
    }

    /// `∂²ψ/∂b²`, 1/m²; by `a` the same, by both the opposite. Where both are in one place that of a spring of no length.
    #[must_use]
    pub fn hessian(&self, [a, b]: [DVec3; 2], projected: bool) -> DMat3 {
        let (length, stiffness) = (a.distance(b), 1.0 / (self.rest * self.rest));
        let all = DMat3::from_diagonal(DVec3::splat(stiffness));
        if length == 0.0 {
            return all;
        }
        let d = (b - a) / length;
        let across = 1.0 - self.rest / length;
        let across = if projected { across.max(0.0) } else { across };
        all * across + outer((1.0 - across) * stiffness * d, d)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{SMatrix, SVector};
    use num_dual::{Dual2SVec64, DualNum, hessian};

    fn cases() -> Vec<DVec3> {
        let d = DVec3::new(0.3, -0.5, 0.81);
        vec![d, 0.1 * d, 1e4 * d, 1e-4 * d, 0.999 * d / d.length(), DVec3::X, DVec3::new(0.0, 3.0, -4.0)]
    }

    #[test]
    fn derivatives_are_those_of_automatic_differentiation() {
        let edge = Stretching::new([DVec3::ZERO, DVec3::X]).expect("an edge");
        let psi = |x: SVector<Dual2SVec64<3>, 3>| {
            let length = (x[0] * x[0] + x[1] * x[1] + x[2] * x[2]).sqrt();
            (length - 1.0).powi(2) * 0.5
        };
        for d in cases() {
            let (value, slopes, second) = hessian(psi, &SVector::from(d.to_array()));
            let ends = [DVec3::ZERO, d];
            let h = SMatrix::<f64, 3, 3>::from(edge.hessian(ends, false).to_cols_array_2d());
            let size = second.amax().max(1.0);
            assert!((edge.density(ends) - value).abs() <= 1e-14 * size * d.length_squared().max(1.0), "{d}");
            let found = edge.slope(ends);
            assert!((0..3).all(|i| (found[i] - slopes[i]).abs() < 1e-14 * size * d.length().max(1.0)), "{d}");
            assert!((h - second).amax() < 1e-13 * size, "{d}: {h} {second}");
            let eigen = second.symmetric_eigen();
            let kept = SMatrix::from_diagonal(&eigen.eigenvalues.map(|x| x.max(0.0)));
            let want = eigen.eigenvectors * kept * eigen.eigenvectors.transpose();
            let found = SMatrix::<f64, 3, 3>::from(edge.hessian(ends, true).to_cols_array_2d());
            assert!((found - want).amax() < 1e-13 * size, "{d}: projected {found} {want}");
        }
    }

    #[test]
    fn an_edge_without_length_is_finite() {
        let edge = Stretching::new([DVec3::ZERO, 2.0 * DVec3::X]).expect("an edge");
        let point = [DVec3::ONE; 2];
        assert_eq!((edge.density(point), edge.slope(point)), (0.5, DVec3::ZERO));
        assert_eq!(edge.hessian(point, false), DMat3::from_diagonal(DVec3::splat(0.25)));
        assert!(Stretching::new(point).is_none());
    }
}
