//! Projective dynamics: rotations by element, then one linear solve with a matrix that never changes.
//!
//! ```text
//! local:   R_e = the rotation nearest to F_e(x)
//! global:  (w L + M/h²) Δx = Σ_e w V_e (R_e − F_e(x)) gᵢ + M/h² (y − x),   y = x₀ + h v₀
//! ```
//!
//! Bouaziz et al., *Projective dynamics*, 2014, for the energy [`Arap`](super::energy::arap::Arap); without the masses
//! it is the equilibrium of projective skinning (Komaritzan, Botsch 2018). Both steps lower the same energy, so that it
//! never grows, but the end comes slowly: linearly, where Newton's method squares.

use super::assembly::Free;
use super::cholesky::FactorError;
use super::element::Elements;
use super::laplacian::Laplacian;
use super::svd::Svd;
use glam::DVec3;

/// Flesh of one set of elements.
#[derive(Clone, Debug)]
pub struct Projective<'a, const N: usize> {
    elements: &'a Elements<N>,
    laplacian: Laplacian,
    weight: f64,
    /// `M/h²` of each node; none in equilibrium.
    inertia: Vec<f64>,
}

impl<'a, const N: usize> Projective<'a, N> {
    /// For equilibria, with the weight `weight`, Pa.
    ///
    /// # Errors
    ///
    /// If a part of the elements has no node that is fixed, or memory is short.
    pub fn still(elements: &'a Elements<N>, free: Free, weight: f64) -> Result<Self, FactorError> {
        let laplacian = Laplacian::new(elements, free, weight, &[])?;
        Ok(Self { elements, laplacian, weight, inertia: Vec::new() })
    }

    /// For steps of `h` seconds of nodes with `mass`, kg.
    ///
    /// # Errors
    ///
    /// As [`still`](Self::still).
    pub fn moving(
        elements: &'a Elements<N>,
        free: Free,
        weight: f64,
        mass: &[f64],
        h: f64,
    ) -> Result<Self, FactorError> {
        let inertia: Vec<f64> = mass.iter().map(|m| m / (h * h)).collect();
        let laplacian = Laplacian::new(elements, free, weight, &inertia)?;
        Ok(Self { elements, laplacian, weight, inertia })
    }

    /// One local and one global step from `x`; `coasting` is where the nodes would be by now without forces, and is not
    /// looked at in equilibria.
    ///
    /// # Panics
    ///
    /// If there are fewer places than nodes.
    pub fn iterate(&self, x: &mut [DVec3], coasting: &[DVec3]) {
        let mut right = vec![DVec3::ZERO; x.len()];
        for e in 0..self.elements.len() {
            let f = self.elements.deformation(e, x);
            let missing = self.weight * self.elements.volumes[e] * (Svd::new(&f).compose([1.0; 3]) - f);
            for (i, g) in self.elements.nodes[e].iter().zip(&self.elements.gradients[e]) {
                right[*i as usize] += missing * *g;
            }
        }
        for (((b, m), y), x) in right.iter_mut().zip(&self.inertia).zip(coasting).zip(&*x) {
            *b += *m * (*y - *x);
        }
        self.laplacian.correct(x, &right);
    }
}
