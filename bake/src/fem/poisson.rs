//! Nodes from deformation gradients.
//!
//! ```text
//! min over x of Σ_e V_e |F_e(x) − F*_e|²:   L (x − x₀) = Σ_e V_e (F*_e − F_e(x₀)) gᵢ
//! ```
//!
//! The Poisson system of deformation transfer (Sumner, Popović 2004) and of neural deformation gradients (their
//! Poisson solve), written for the difference, so that nodes that are not free stay where `x₀` has them. Gradients
//! of a map are met exactly, others in the mean of squares.

use super::assembly::Free;
use super::cholesky::FactorError;
use super::element::Elements;
use super::laplacian::Laplacian;
use glam::{DMat3, DVec3};

/// The system of one set of elements.
///
/// ```
/// use glam::{DMat3, DVec3};
/// use sinew_bake::fem::{assembly::Free, element::Elements, poisson::Poisson};
/// let rest = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
/// let tets = Elements::tets(&rest, vec![[0, 1, 2, 3]])?;
/// let turn = DMat3::from_rotation_y(0.3);
/// let mut x = rest;
/// Poisson::new(&tets, Free::new(4, &[0]))?.recover(&[turn], &mut x);
/// assert!(x[2].distance(turn * DVec3::Y) < 1e-15 && x[3].distance(turn * DVec3::Z) < 1e-15);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct Poisson<'a, const N: usize> {
    elements: &'a Elements<N>,
    laplacian: Laplacian,
}

impl<'a, const N: usize> Poisson<'a, N> {
    /// Factors the system.
    ///
    /// # Errors
    ///
    /// If the system is not positive definite, or memory is short. A part of the elements without a fixed node makes it
    /// singular, which rounding may hide.
    pub fn new(elements: &'a Elements<N>, free: Free) -> Result<Self, FactorError> {
        Ok(Self { elements, laplacian: Laplacian::new(elements, free, 1.0, &[])? })
    }

    /// Moves the free nodes of `x` to where the elements' gradients are nearest to `targets`.
    ///
    /// # Panics
    ///
    /// If there are fewer targets than elements.
    pub fn recover(&self, targets: &[DMat3], x: &mut [DVec3]) {
        let mut right = vec![DVec3::ZERO; x.len()];
        for (e, target) in targets[..self.elements.len()].iter().enumerate() {
            let missing = self.elements.volumes[e] * (*target - self.elements.deformation(e, x));
            for (i, g) in self.elements.nodes[e].iter().zip(&self.elements.gradients[e]) {
                right[*i as usize] += missing * *g;
            }
        }
        self.laplacian.correct(x, &right);
    }
}
