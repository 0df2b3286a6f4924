//! Flesh: elements of one material.
//!
//! ```text
//! E = Σ_e V_e ψ(F_e),   ∂E/∂xᵢ = Σ_e V_e P_e gᵢ,   ∂²E/∂xᵢ∂xⱼ = Σ_e V_e Σₖₗ gᵢₖ gⱼₗ Hₖₗ
//! ```
//!
//! `Hₖₗ` is the 3×3 block of `∂²ψ/∂F²` that belongs to columns `k` and `l` of `F`. Elements are worked on in parallel
//! and summed up in their order, so that the result does not depend on the number of threads.

use super::Potential;
use crate::fem::assembly::Assembly;
use crate::fem::element::Elements;
use crate::fem::energy::{Energy, Hessian};
use crate::fem::svd::Svd;
use glam::{DMat3, DVec3};
use rayon::prelude::*;

/// Elements at a time: bounds the memory for their matrices, and is enough to share out.
const CHUNK: usize = 2048;

/// Elements and what they are made of.
///
/// ```
/// use glam::DVec3;
/// use sinew_bake::fem::{element::Elements, energy::neo_hookean::NeoHookean, material::Lame};
/// use sinew_bake::fem::potential::{Potential, solid::Solid};
/// let rest = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
/// let fat = NeoHookean::new(Lame::new(15_000.0, 0.47)?);
/// let solid = Solid::new(Elements::tets(&rest, vec![[0, 1, 2, 3]])?, fat);
/// assert!(solid.energy(&rest.map(|x| 1.1 * x)) > solid.energy(&rest));
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct Solid<const N: usize, E> {
    /// Where they are, and their gradients.
    pub elements: Elements<N>,
    /// Material of all.
    pub material: E,
}

impl<const N: usize, E: Energy> Solid<N, E> {
    /// Of elements and their material.
    #[must_use]
    pub const fn new(elements: Elements<N>, material: E) -> Self {
        Self { elements, material }
    }

    /// Forces against the nodes of element `e`: `V P gᵢ`.
    fn forces(&self, e: usize, x: &[DVec3]) -> [DVec3; N] {
        let svd = Svd::new(&self.elements.deformation(e, x));
        let p = self.material.stress(&svd) * self.elements.volumes[e];
        self.elements.gradients[e].map(|g| p * g)
    }

    /// Blocks `∂²E/∂xᵢ∂xⱼ` of element `e`; those with `j ≤ i` alone are set.
    fn stiffness(&self, e: usize, x: &[DVec3], projected: bool) -> [[DMat3; N]; N] {
        let svd = Svd::new(&self.elements.deformation(e, x));
        let h = blocks(&self.material.hessian(&svd, projected));
        let (g, volume) = (&self.elements.gradients[e], self.elements.volumes[e]);
        let mut out = [[DMat3::ZERO; N]; N];
        for (i, row) in out.iter_mut().enumerate() {
            let w = volume * g[i];
            let half = [0, 1, 2].map(|l| h[0][l] * w.x + h[1][l] * w.y + h[2][l] * w.z);
            for (block, g) in row.iter_mut().zip(&g[..=i]) {
                *block = half[0] * g.x + half[1] * g.y + half[2] * g.z;
            }
        }
        out
    }
}

/// Adds elements' blocks, one element after the other.
fn add<const N: usize>(nodes: &[[u32; N]], matrices: &[[[DMat3; N]; N]], out: &mut Assembly<'_>) {
    for (nodes, matrix) in nodes.iter().zip(matrices) {
        for i in 0..N {
            for j in 0..=i {
                out.add(nodes[i], nodes[j], matrix[i][j]);
            }
        }
    }
}

/// `Hₖₗ`: rows of column `k` of `F` against those of column `l`.
fn blocks(h: &Hessian) -> [[DMat3; 3]; 3] {
    [0, 1, 2].map(|k| {
        [0, 1, 2].map(|l| {
            DMat3::from_cols_array_2d(&[0, 1, 2].map(|c| [0, 1, 2].map(|r| h[3 * l + c][3 * k + r])))
        })
    })
}

impl<const N: usize, E: Energy> Potential for Solid<N, E> {
    fn stencils(&self, visit: &mut dyn FnMut(&[u32])) {
        self.elements.nodes.iter().for_each(|nodes| visit(nodes));
    }

    fn energy(&self, x: &[DVec3]) -> f64 {
        let of = |e: usize| self.elements.volumes[e] * self.material.of(&self.elements.deformation(e, x));
        let count = self.elements.len();
        let chunks: Vec<f64> = (0..count.div_ceil(CHUNK))
            .into_par_iter()
            .map(|c| (c * CHUNK..count.min((c + 1) * CHUNK)).map(of).sum())
            .collect();
        chunks.iter().sum()
    }

    fn gradient(&self, x: &[DVec3], out: &mut [DVec3]) {
        let mut forces = vec![[DVec3::ZERO; N]; self.elements.len()];
        forces.par_iter_mut().with_min_len(64).enumerate().for_each(|(e, to)| *to = self.forces(e, x));
        for (nodes, forces) in self.elements.nodes.iter().zip(&forces) {
            for (i, force) in nodes.iter().zip(forces) {
                out[*i as usize] += *force;
            }
        }
    }

    fn hessian(&self, x: &[DVec3], projected: bool, out: &mut Assembly<'_>) {
        let count = self.elements.len();
        let make = |from: usize, matrices: &mut Vec<_>| {
            (from.min(count)..count.min(from + CHUNK))
                .into_par_iter()
                .with_min_len(16)
                .map(|e| self.stiffness(e, x, projected))
                .collect_into_vec(matrices);
        };
        let (mut matrices, mut next) = (Vec::new(), Vec::new());
        make(0, &mut matrices);
        for (c, nodes) in self.elements.nodes.chunks(CHUNK).enumerate() {
            // While one chunk is summed up the next is made.
            rayon::join(|| make((c + 1) * CHUNK, &mut next), || add(nodes, &matrices, out));
            core::mem::swap(&mut matrices, &mut next);
        }
    }

    fn inverted(&self, x: &[DVec3]) -> usize {
        (0..self.elements.len()).filter(|e| self.elements.deformation(*e, x).determinant() <= 0.0).count()
    }
}
