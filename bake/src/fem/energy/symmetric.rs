//! Symmetric 3×3 matrices.

use crate::fem::svd::Svd;
use glam::DMat3;

/// The nearest matrix without negative eigenvalues, by the Frobenius norm: `Q max(Λ, 0) Qᵀ`.
///
/// A symmetric matrix is `A = U Σ Vᵀ` with `U` and `V` alike but for signs; `(A + |A|)/2`, `|A| = V |Σ| Vᵀ`, drops the
/// negative part.
pub(super) fn positive(a: [[f64; 3]; 3]) -> [[f64; 3]; 3] {
    let a = DMat3::from_cols_array_2d(&a);
    let svd = Svd::new(&a);
    let absolute = svd.v * DMat3::from_diagonal(svd.s.map(f64::abs).into()) * svd.v.transpose();
    ((a + absolute) * 0.5).to_cols_array_2d()
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;

    #[test]
    fn negative_eigenvalues_are_dropped() {
        let q = DMat3::from_axis_angle(DVec3::new(0.6, 0.0, 0.8), 0.7);
        let with = |d: [f64; 3]| q * DMat3::from_diagonal(d.into()) * q.transpose();
        for (d, want) in [
            ([3.0, -2.0, 1.0], [3.0, 0.0, 1.0]),
            ([-1.0, -1.0, -5.0], [0.0; 3]),
            ([2.0, 2.0, 2.0], [2.0; 3]),
            ([1.0, -1.0, 0.0], [1.0, 0.0, 0.0]),
        ] {
            let found = DMat3::from_cols_array_2d(&positive(with(d).to_cols_array_2d()));
            assert!((found - with(want)).to_cols_array().iter().all(|x| x.abs() < 1e-14), "{d:?}: {found}");
        }
    }
}
