//! What nodes weigh.
//!
//! ```text
//! consistent: mᵢⱼ = ρ∫NᵢNⱼ,  of a tetrahedron ρV(1 + δᵢⱼ)/20        lumped: mᵢ = Σⱼ mᵢⱼ
//! ```

use super::element::Elements;
use super::prism;
use glam::DVec3;

/// A symmetric matrix of masses, kg.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mass {
    /// Of each node.
    pub diagonal: Vec<f64>,
    /// Of pairs of nodes, the smaller first, in order; each stands for both sides of the diagonal.
    pub pairs: Vec<(u32, u32, f64)>,
}

impl Mass {
    /// Of `count` nodes without mass.
    #[must_use]
    pub fn new(count: usize) -> Self {
        Self { diagonal: vec![0.0; count], pairs: Vec::new() }
    }

    /// With tetrahedra of `density`, kg/m³.
    ///
    /// ```
    /// use glam::DVec3;
    /// use sinew_bake::fem::{element::Elements, mass::Mass};
    /// let rest = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
    /// let tets = Elements::tets(&rest, vec![[0, 1, 2, 3]])?;
    /// let mass = Mass::new(4).with_tets(&tets, 1200.0);
    /// assert!((mass.total() - 200.0).abs() < 1e-12);
    /// assert!((mass.lumped().diagonal[0] - 50.0).abs() < 1e-12);
    /// # Ok::<(), sinew_bake::fem::element::ElementError<4>>(())
    /// ```
    #[must_use]
    pub fn with_tets(self, tets: &Elements<4>, density: f64) -> Self {
        self.with(tets, |e| {
            let m = density * tets.volumes[e] / 20.0;
            let mut out = [[m; 4]; 4];
            (0..4).for_each(|i| out[i][i] = 2.0 * m);
            out
        })
    }

    /// With prisms of `density`, kg/m³; `rest` is where their nodes are.
    #[must_use]
    pub fn with_prisms(self, prisms: &Elements<6>, rest: &[DVec3], density: f64) -> Self {
        self.with(prisms, |e| {
            let nodes = prisms.nodes[e].map(|i| rest[i as usize]);
            prism::mass(nodes).map(|row| row.map(|m| density * m))
        })
    }

    fn with<const N: usize>(mut self, elements: &Elements<N>, of: impl Fn(usize) -> [[f64; N]; N]) -> Self {
        for (e, nodes) in elements.nodes.iter().enumerate() {
            let m = of(e);
            for i in 0..N {
                self.diagonal[nodes[i] as usize] += m[i][i];
                let below = (0..i).map(|j| (nodes[i].min(nodes[j]), nodes[i].max(nodes[j]), m[i][j]));
                self.pairs.extend(below);
            }
        }
        self.pairs.sort_by_key(|(i, j, _)| (*i, *j));
        self.pairs.dedup_by(|next, kept| {
            let same = (next.0, next.1) == (kept.0, kept.1);
            if same {
                kept.2 += next.2;
            }
            same
        });
        self
    }

    /// The same with all mass on the diagonal.
    #[must_use]
    pub fn lumped(&self) -> Self {
        let mut diagonal = self.diagonal.clone();
        for (i, j, m) in &self.pairs {
            diagonal[*i as usize] += m;
            diagonal[*j as usize] += m;
        }
        Self { diagonal, pairs: Vec::new() }
    }

    /// All of it, kg.
    #[must_use]
    pub fn total(&self) -> f64 {
        self.lumped().diagonal.iter().sum()
    }

    /// `M v`.
    #[must_use]
    pub fn times(&self, v: &[DVec3]) -> Vec<DVec3> {
        let mut out: Vec<DVec3> = self.diagonal.iter().zip(v).map(|(m, v)| *m * *v).collect();
        for (i, j, m) in &self.pairs {
            out[*i as usize] += *m * v[*j as usize];
            out[*j as usize] += *m * v[*i as usize];
        }
        out
    }
}
