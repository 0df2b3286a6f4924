//! Energies of isotropic materials, by principal stretches.
//!
//! ```text
//! F = U diag(σ) Vᵀ,   P = ∂ψ/∂F = U diag(ψᵢ) Vᵀ,   ψᵢ = ∂ψ/∂σᵢ
//!
//! ∂²ψ/∂F² = Σᵢⱼ ψᵢⱼ Dᵢ Dⱼᵀ + Σ_pairs flip·S Sᵀ + twist·A Aᵀ,   Dᵢ = uᵢvᵢᵀ
//! flip  = (ψᵢ − ψⱼ)/(σᵢ − σⱼ)   on   S = (uᵢvⱼᵀ + uⱼvᵢᵀ)/√2
//! twist = (ψᵢ + ψⱼ)/(σᵢ + σⱼ)   on   A = (uᵢvⱼᵀ − uⱼvᵢᵀ)/√2
//! ```
//!
//! The Hessian's eigenvectors are those of every isotropic energy (Smith, De Goes, Kim 2019: Analytic Eigensystems for
//! Isotropic Distortion Energies), so that an energy gives seven numbers of its own in closed form and is projected to
//! the positive semi-definite ones without a 9×9 eigenvalue problem. Only `ψᵢⱼ` needs one, 3×3.

pub mod arap;
pub mod bending;
pub mod corotated;
pub mod neo_hookean;
pub mod stretching;
pub mod stvk;
mod symmetric;

#[cfg(test)]
pub(crate) mod cases;

use super::svd::Svd;
use glam::{DMat3, DVec3};

/// Columns of `∂²ψ/∂F²`, `F` as nine numbers by columns.
pub type Hessian = [[f64; 9]; 9];

/// Density of energy, J/m³, of a deformation gradient `F`.
pub trait Energy: Sync {
    /// `ψ(σ)`, Pa.
    fn density(&self, s: [f64; 3]) -> f64;

    /// `ψᵢ`, Pa.
    fn gradient(&self, s: [f64; 3]) -> [f64; 3];

    /// `ψᵢⱼ`, Pa.
    fn second(&self, s: [f64; 3]) -> [[f64; 3]; 3];

    /// `(ψᵢ − ψⱼ)/(σᵢ − σⱼ)` of the two that are not `k`, in a form without a division by what may vanish.
    fn flip(&self, s: [f64; 3], k: usize) -> f64;

    /// `(ψᵢ + ψⱼ)/(σᵢ + σⱼ)` of the two that are not `k`.
    fn twist(&self, s: [f64; 3], k: usize) -> f64;

    /// `ψ(F)`, Pa.
    fn of(&self, f: &DMat3) -> f64 {
        self.density(Svd::new(f).s)
    }

    /// First Piola–Kirchhoff stress `P`, Pa.
    fn stress(&self, f: &Svd) -> DMat3 {
        f.compose(self.gradient(f.s))
    }

    /// `∂²ψ/∂F²`, or the nearest without negative eigenvalues.
    fn hessian(&self, f: &Svd, projected: bool) -> Hessian {
        let kept = |x: f64| if projected { x.max(0.0) } else { x };
        let mut h = [[0.0; 9]; 9];
        let scaling = self.second(f.s);
        let scaling = if projected { symmetric::positive(scaling) } else { scaling };
        let d = [0, 1, 2].map(|i| outer(f.u.col(i), f.v.col(i)));
        for i in 0..3 {
            for j in 0..3 {
                add(&mut h, scaling[i][j], &d[i], &d[j]);
            }
            let (j, k) = ((i + 1) % 3, (i + 2) % 3);
            let (jk, kj) = (outer(f.u.col(j), f.v.col(k)), outer(f.u.col(k), f.v.col(j)));
            // Of S Sᵀ and A Aᵀ, √2 apart, what is equal and what is not.
            let (flip, twist) = (kept(self.flip(f.s, i)), kept(self.twist(f.s, i)));
            let (same, other) = (0.5 * (flip + twist), 0.5 * (flip - twist));
            add(&mut h, same, &jk, &jk);
            add(&mut h, same, &kj, &kj);
            add(&mut h, other, &jk, &kj);
            add(&mut h, other, &kj, &jk);
        }
        h
    }
}

/// `a bᵀ`, by columns.
fn outer(a: DVec3, b: DVec3) -> [f64; 9] {
    DMat3::from_cols(a * b.x, a * b.y, a * b.z).to_cols_array()
}

/// `H += x·a bᵀ`.
fn add(h: &mut Hessian, x: f64, a: &[f64; 9], b: &[f64; 9]) {
    for (column, b) in h.iter_mut().zip(b) {
        for (h, a) in column.iter_mut().zip(a) {
            *h += x * b * a;
        }
    }
}

/// Product of the two stretches that are not `k`, and their sum.
fn others(s: [f64; 3], k: usize) -> (f64, f64) {
    let (i, j) = ((k + 1) % 3, (k + 2) % 3);
    (s[i] * s[j], s[i] + s[j])
}
