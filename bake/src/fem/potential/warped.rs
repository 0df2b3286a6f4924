//! Linear flesh in frames that are given: co-rotated elasticity for one linear solve.
//!
//! ```text
//! ψ = μ|ε|² + λ/2 tr(ε)²,   ε = sym(RᵀF) − I
//! ∂²E/∂xᵢ∂xⱼ = Σ_e V_e (μ (gᵢ·gⱼ I + R gⱼ (R gᵢ)ᵀ) + λ R gᵢ (R gⱼ)ᵀ)
//! ```
//!
//! Stiffness warping (Müller, Gross 2004). With the rotations of skinning it is the co-rotated baseline of neural
//! deformation gradients: quadratic, so that a single step of Newton's method ends it. Where each `R` is the rotation of
//! its own `F` it has the forces of [`Corotated`](crate::fem::energy::corotated::Corotated).

use super::Potential;
use crate::fem::assembly::Assembly;
use crate::fem::element::{Elements, outer};
use crate::fem::material::Lame;
use crate::fem::svd::Svd;
use glam::{DMat3, DVec3};

/// Elements in turned frames.
#[derive(Clone, Debug)]
pub struct Warped<'a, const N: usize> {
    /// The elements.
    pub elements: &'a Elements<N>,
    /// Rotation of each.
    pub rotations: Vec<DMat3>,
    /// What they are made of.
    pub material: Lame,
}

impl<'a, const N: usize> Warped<'a, N> {
    /// In the rotations nearest to the elements' gradients where the nodes are at `x`.
    #[must_use]
    pub fn at(elements: &'a Elements<N>, material: Lame, x: &[DVec3]) -> Self {
        let nearest = |e: usize| Svd::new(&elements.deformation(e, x)).compose([1.0; 3]);
        Self { elements, rotations: (0..elements.len()).map(nearest).collect(), material }
    }

    /// `ε` of element `e`.
    fn strain(&self, e: usize, x: &[DVec3]) -> DMat3 {
        let turned = self.rotations[e].transpose() * self.elements.deformation(e, x);
        (turned + turned.transpose()) * 0.5 - DMat3::IDENTITY
    }
}

/// `tr(ε)`.
fn trace(e: &DMat3) -> f64 {
    e.x_axis.x + e.y_axis.y + e.z_axis.z
}

impl<const N: usize> Potential for Warped<'_, N> {
    fn stencils(&self, visit: &mut dyn FnMut(&[u32])) {
        self.elements.nodes.iter().for_each(|nodes| visit(nodes));
    }

    fn energy(&self, x: &[DVec3]) -> f64 {
        let Lame { mu, lambda } = self.material;
        let of = |e: usize| {
            let strain = self.strain(e, x);
            let square: f64 = strain.to_cols_array().iter().map(|s| s * s).sum();
            self.elements.volumes[e] * (mu * square + 0.5 * lambda * trace(&strain) * trace(&strain))
        };
        (0..self.elements.len()).map(of).sum()
    }

    fn gradient(&self, x: &[DVec3], out: &mut [DVec3]) {
        let Lame { mu, lambda } = self.material;
        for e in 0..self.elements.len() {
            let strain = self.strain(e, x);
            let even = DMat3::from_diagonal(DVec3::splat(lambda * trace(&strain)));
            let stress = self.elements.volumes[e] * (self.rotations[e] * (strain * (2.0 * mu) + even));
            for (i, g) in self.elements.nodes[e].iter().zip(&self.elements.gradients[e]) {
                out[*i as usize] += stress * *g;
            }
        }
    }

    fn hessian(&self, _x: &[DVec3], _projected: bool, out: &mut Assembly<'_>) {
        let Lame { mu, lambda } = self.material;
        for e in 0..self.elements.len() {
            let (nodes, volume) = (&self.elements.nodes[e], self.elements.volumes[e]);
            let turned = self.elements.gradients[e].map(|g| self.rotations[e] * g);
            for i in 0..N {
                for j in 0..=i {
                    let (a, b) = (turned[i], turned[j]);
                    let even = DMat3::from_diagonal(DVec3::splat(mu * a.dot(b)));
                    out.add(nodes[i], nodes[j], volume * (even + outer(b, a) * mu + outer(a, b) * lambda));
                }
            }
        }
    }
}
