//! Skin: a surface that is stiff against bending and stretching.
//!
//! ```text
//! E = k_b Σ_hinges ½ (l̄²/Ā)(θ − θ̄)² + k_s Σ_edges ½ (l/l̄ − 1)²
//! ```
//!
//! The skin of neural deformation gradients (Nolte et al. 2026: `k_b` 2·10⁻³, `k_s` 3·10⁻² J, of a mesh of the size of theirs: the
//! first does not depend on how fine a mesh is, the second does). A hinge is an edge with one triangle on either side. At the rim, where
//! three or more triangles meet, where two are wound against each other or one has no area at rest, the surface bends freely.

use super::Potential;
use crate::fem::assembly::Assembly;
use crate::fem::blocks::Blocks;
use crate::fem::energy::bending::Bending;
use crate::fem::energy::stretching::Stretching;
use crate::fem::surface::Surface;
use glam::{DMat3, DVec3};
use rayon::prelude::*;

/// Hinges or edges at a time: bounds the memory for their matrices.
const CHUNK: usize = 2048;

/// How stiff skin is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Skin {
    /// `k_b`, J.
    pub bending: f64,
    /// `k_s`, J.
    pub stretching: f64,
}

/// Skin that cannot be.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error("skin with {0:?}; neither may be below 0 or infinite: 0.002 and 0.03 J are usual")]
pub struct SkinError(pub Skin);

/// A surface and how it bends and stretches.
///
/// ```
/// use glam::DVec3;
/// use sinew_bake::fem::potential::{Potential, shell::{Shell, Skin}};
/// use sinew_bake::fem::surface::Surface;
/// let rest = [DVec3::ZERO, DVec3::X, DVec3::Y, -DVec3::Y];
/// let surface = Surface::of_nodes(&rest, vec![[0, 1, 2], [1, 0, 3]])?;
/// let shell = Shell::new(surface, Skin { bending: 2e-3, stretching: 3e-2 })?;
/// assert_eq!((shell.energy(&rest), shell.hinges.len()), (0.0, 1));
/// let folded = [rest[0], rest[1], DVec3::Z, rest[3]];
/// // θ = −π/2, l̄² = 1, Ā = 1/3: all by bending, since no edge is longer.
/// let angle = core::f64::consts::FRAC_PI_2;
/// assert!((shell.energy(&folded) - 2e-3 * 0.5 * 3.0 * angle * angle).abs() < 1e-15);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct Shell {
    /// What is bent.
    pub surface: Surface,
    /// Points and energy of each hinge.
    pub hinges: Vec<([u32; 4], Bending)>,
    /// Ends and energy of each edge that has a length at rest.
    pub edges: Vec<([u32; 2], Stretching)>,
    skin: Skin,
}

impl Shell {
    /// Skin over a surface.
    ///
    /// # Errors
    ///
    /// If a stiffness is below 0 or not finite.
    pub fn new(surface: Surface, skin: Skin) -> Result<Self, SkinError> {
        let sound = |k: f64| k >= 0.0 && k.is_finite();
        if !(sound(skin.bending) && sound(skin.stretching)) {
            return Err(SkinError(skin));
        }
        let rest = |i: u32| surface.rest[i as usize];
        let hinge = |points: [u32; 4]| Some((points, Bending::new(points.map(rest))?));
        let edge = |points: &[u32; 2]| Some((*points, Stretching::new(points.map(rest))?));
        let hinges = hinges(&surface.triangles).into_iter().filter_map(hinge).collect();
        let edges = surface.edges.iter().filter_map(edge).collect();
        Ok(Self { surface, hinges, edges, skin })
    }
}

/// Ends of each edge between two triangles that go along it in opposite directions, and their apexes.
fn hinges(triangles: &[[u32; 3]]) -> Vec<[u32; 4]> {
    let mut sides: Vec<([u32; 2], bool, u32)> = Vec::with_capacity(3 * triangles.len());
    for t in triangles {
        for k in 0..3 {
            let (i, j, apex) = (t[k], t[(k + 1) % 3], t[(k + 2) % 3]);
            sides.push(([i.min(j), i.max(j)], i > j, apex));
        }
    }
    sides.sort_unstable();
    let around = sides.chunk_by(|a, b| a.0 == b.0);
    let hinge = |sides: &[([u32; 2], bool, u32)]| match sides {
        [([i, j], false, left), (_, true, right)] if left != right => Some([*i, *j, *left, *right]),
        _ => None,
    };
    around.filter_map(hinge).collect()
}

/// Calls `each` for all of `of` in order with what `make` makes of it on all threads, and a chunk at a time.
fn in_order<T: Sync, M: Send>(of: &[T], make: impl Fn(&T) -> M + Sync, mut each: impl FnMut(&T, M)) {
    for chunk in of.chunks(CHUNK) {
        let made: Vec<M> = chunk.par_iter().with_min_len(64).map(&make).collect();
        chunk.iter().zip(made).for_each(|(of, made)| each(of, made));
    }
}

impl Potential for Shell {
    fn stencils(&self, visit: &mut dyn FnMut(&[u32])) {
        let mut nodes = Vec::new();
        self.hinges.iter().for_each(|(points, _)| self.surface.stencil(points, &mut nodes, visit));
        self.edges.iter().for_each(|(points, _)| self.surface.stencil(points, &mut nodes, visit));
    }

    fn energy(&self, x: &[DVec3]) -> f64 {
        let points = self.surface.points(x);
        let (mut bending, mut stretching) = (0.0, 0.0);
        let at = |i: u32| points[i as usize];
        in_order(&self.hinges, |(of, hinge)| hinge.density(of.map(at)), |_, psi| bending += psi);
        in_order(&self.edges, |(of, edge)| edge.density(of.map(at)), |_, psi| stretching += psi);
        self.skin.bending * bending + self.skin.stretching * stretching
    }

    fn gradient(&self, x: &[DVec3], out: &mut [DVec3]) {
        let points = self.surface.points(x);
        let (at, Skin { bending, stretching }) = (|i: u32| points[i as usize], self.skin);
        let of_hinge = |(of, hinge): &([u32; 4], Bending)| hinge.slopes(of.map(at)).map(|g| bending * g);
        in_order(&self.hinges, of_hinge, |(of, _), forces| self.surface.spread(of, &forces, out));
        let of_edge = |(of, edge): &([u32; 2], Stretching)| stretching * edge.slope(of.map(at));
        in_order(&self.edges, of_edge, |(of, _), force| self.surface.spread(of, &[-force, force], out));
    }

    fn hessian(&self, x: &[DVec3], projected: bool, out: &mut Assembly<'_>) {
        let points = self.surface.points(x);
        let (at, Skin { bending, stretching }) = (|i: u32| points[i as usize], self.skin);
        let of_hinge = |(of, hinge): &([u32; 4], Bending)| -> Blocks<4> {
            hinge.hessian(of.map(at), projected).map(|row| row.map(|block| block * bending))
        };
        in_order(&self.hinges, of_hinge, |(of, _), h| self.surface.assemble(of, &h, out));
        let of_edge = |(of, edge): &([u32; 2], Stretching)| edge.hessian(of.map(at), projected) * stretching;
        in_order(&self.edges, of_edge, |(of, _), h| {
            self.surface.assemble(of, &[[h, DMat3::ZERO], [-h, h]], out);
        });
    }
}
