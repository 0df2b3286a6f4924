//! Elements: a gradient of the deformation from positions of nodes.
//!
//! ```text
//! F = Σ xᵢ gᵢᵀ
//! ```
//!
//! Both elements are exact for affine maps: `Σ gᵢ = 0` and `Σ x̄ᵢ gᵢᵀ = I`.

use super::prism;
use glam::{DMat3, DVec3};

/// Elements of `N` nodes each: 4 a tetrahedron, 6 a prism.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Elements<const N: usize> {
    /// Nodes of each.
    pub nodes: Vec<[u32; N]>,
    /// `gᵢ`, 1/m.
    pub gradients: Vec<[DVec3; N]>,
    /// Volumes at rest, m³.
    pub volumes: Vec<f64>,
}

/// An element without a volume at rest.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error("element {element} with the nodes {nodes:?} has a volume of {volume} at rest; it must be above 0")]
pub struct ElementError<const N: usize> {
    /// Its index.
    pub element: usize,
    /// Its nodes.
    pub nodes: [u32; N],
    /// What was found, m³.
    pub volume: f64,
}

impl<const N: usize> Elements<N> {
    /// Of rest positions; `shape` gives gradients and signed volume of one.
    fn build(
        rest: &[DVec3],
        nodes: Vec<[u32; N]>,
        shape: impl Fn([DVec3; N]) -> ([DVec3; N], f64),
    ) -> Result<Self, ElementError<N>> {
        let mut out = Self::default();
        for (element, of) in nodes.iter().enumerate() {
            let (gradients, volume) = shape(of.map(|i| rest[i as usize]));
            if !(volume > 0.0 && gradients.iter().all(|g| g.is_finite())) {
                return Err(ElementError { element, nodes: *of, volume });
            }
            out.gradients.push(gradients);
            out.volumes.push(volume);
        }
        out.nodes = nodes;
        Ok(out)
    }

    /// How many there are.
    #[must_use]
    pub fn len(&self) -> usize {
        self.nodes.len()
    }

    /// Whether there is none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.nodes.is_empty()
    }

    /// `F` of element `e` where the nodes are at `x`.
    #[must_use]
    pub fn deformation(&self, e: usize, x: &[DVec3]) -> DMat3 {
        let parts = self.nodes[e].iter().zip(&self.gradients[e]);
        parts.fold(DMat3::ZERO, |f, (i, g)| f + outer(x[*i as usize], *g))
    }
}

impl Elements<4> {
    /// Tetrahedra, the fourth node on the side that the first three turn to by the right hand.
    ///
    /// # Errors
    ///
    /// At the first that is flat or inside out.
    ///
    /// # Panics
    ///
    /// If a node is past the end of `rest`.
    ///
    /// ```
    /// use glam::{DMat3, DVec3};
    /// use sinew_bake::fem::element::Elements;
    /// let rest = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
    /// let tets = Elements::tets(&rest, vec![[0, 1, 2, 3]])?;
    /// let stretched = rest.map(|x| x * DVec3::new(2.0, 1.0, 1.0));
    /// assert_eq!(tets.deformation(0, &stretched), DMat3::from_diagonal(DVec3::new(2.0, 1.0, 1.0)));
    /// # Ok::<(), sinew_bake::fem::element::ElementError<4>>(())
    /// ```
    pub fn tets(rest: &[DVec3], nodes: Vec<[u32; 4]>) -> Result<Self, ElementError<4>> {
        Self::build(rest, nodes, tet)
    }
}

impl Elements<6> {
    /// Prisms: an inner triangle, and an outer one of the same winding, seen from outside against the clock.
    ///
    /// # Errors
    ///
    /// At the first that has no volume or is inside out.
    ///
    /// # Panics
    ///
    /// If a node is past the end of `rest`.
    pub fn prisms(rest: &[DVec3], nodes: Vec<[u32; 6]>) -> Result<Self, ElementError<6>> {
        Self::build(rest, nodes, prism::mean)
    }
}

/// `a bᵀ`.
pub(super) fn outer(a: DVec3, b: DVec3) -> DMat3 {
    DMat3::from_cols(a * b.x, a * b.y, a * b.z)
}

/// `gᵢ` and volume of a tetrahedron.
fn tet([a, b, c, d]: [DVec3; 4]) -> ([DVec3; 4], f64) {
    let edges = DMat3::from_cols(b - a, c - a, d - a);
    // Rows of the inverse.
    let g = edges.inverse().transpose();
    ([-(g.x_axis + g.y_axis + g.z_axis), g.x_axis, g.y_axis, g.z_axis], edges.determinant() / 6.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn affine_maps_are_exact() {
        let p = |x, y, z| DVec3::new(x, y, z);
        let rest = [
            p(0.0, 0.0, 0.0),
            p(1.0, 0.0, 0.0),
            p(0.0, 1.0, 0.0),
            p(0.1, 0.0, 1.0),
            p(0.9, 0.1, 1.2),
            p(0.0, 0.8, 0.9),
        ];
        let map = DMat3::from_cols_array(&[0.3, -1.0, 2.0, 0.5, 0.0, -0.7, 1.1, 0.4, -0.2]);
        let moved = rest.map(|x| map * x + p(5.0, -3.0, 1.0));
        let tets = Elements::tets(&rest, vec![[0, 1, 2, 3], [1, 2, 3, 5]]).expect("tetrahedra");
        let prisms = Elements::prisms(&rest, vec![[0, 1, 2, 3, 4, 5]]).expect("a prism");
        for f in [tets.deformation(0, &moved), tets.deformation(1, &moved), prisms.deformation(0, &moved)] {
            assert!((f - map).to_cols_array().iter().all(|x| x.abs() < 1e-14), "{f}");
        }
    }

    #[test]
    fn elements_without_volume_are_refused() {
        let rest = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z, DVec3::ONE, DVec3::NAN];
        let refused = |nodes| Elements::tets(&rest, vec![[0, 1, 2, 3], nodes]).expect_err("refused").element;
        assert_eq!([[0, 1, 2, 2], [0, 2, 1, 3], [0, 1, 2, 5]].map(refused), [1; 3]);
        let error = Elements::prisms(&rest, vec![[3, 3, 3, 0, 1, 2]]).expect_err("refused");
        assert_eq!(error.nodes, [3, 3, 3, 0, 1, 2]);
    }
}
