//! Ground truth of a character: flesh in equilibrium, or in motion, in a cage that its pose moves.
//!
//! ```text
//! Model ─▶ cage::Body ─▶ Simulation ◀─ Pose (clips, BVH, random)
//!                          │ settle: equilibrium     ─▶ Equilibria ─┐
//!                          └ step: backward Euler    ─▶ Motions    ─┴─▶ Job ─▶ dataset
//! ```
//!
//! Lengths are in the file's units (metres), energies in joules of a character as large as the file says.

pub mod job;
pub mod motion;
#[cfg(feature = "render")]
pub mod preview;
pub mod sample;

mod settings;
pub mod settle;
pub mod source;

use crate::cage::surface::Row;
use crate::fem::assembly::Free;
use crate::fem::dynamics::{BackwardEuler, Rayleigh, State};
use crate::fem::element::Elements;
use crate::fem::energy::neo_hookean::NeoHookean;
use crate::fem::mass::Mass;
use crate::fem::newton::{Newton, Tolerance};
use crate::fem::potential::load::Load;
use crate::fem::potential::pull::{Pull, Spring};
use crate::fem::potential::{Potential, solid::Solid};
use crate::fem::solver::Method;
use crate::fem::stiffness::FIXED;
use crate::pose::Pose;
use crate::{Error, Model, cage};
use glam::{DMat3, DMat4, DVec3};

pub use settings::Settings;

/// Largest step of Newton's method, edges of the cage, that counts as none.
const STILL: f64 = 1e-5;
/// Iterations of Newton's method before a shorter way is taken.
const PATIENCE: usize = 40;

/// A character's flesh, in a pose.
///
/// ```
/// use sinew_bake::{builtin, pose::Pose, simulate::{Settings, Simulation}};
/// let model = builtin::character();
/// let mut flesh = Simulation::new(&model, &Settings::draft())?;
/// let pose = Pose::of_clip(&model, &model.clips[0], 0.2);
/// assert!(flesh.settle(&pose).equilibrium.converged);
/// assert_eq!(flesh.skin().len(), flesh.body.surface.points.len());
/// # Ok::<(), sinew_bake::Error>(())
/// ```
#[derive(Debug)]
pub struct Simulation<'m> {
    model: &'m Model,
    /// Skin, cage, and what holds it.
    pub body: cage::Body,
    /// All elements of the cage.
    elements: Elements<4>,
    /// Those with a free node.
    flesh: Solid<4, NeoHookean>,
    weight: Load,
    pull: Pull,
    mass: Mass,
    damping: Rayleigh,
    newton: Newton,
    /// What a first step of motion makes.
    steps: Option<BackwardEuler>,
    tolerance: Tolerance,
    rest: Vec<DMat4>,
    pose: Pose,
    /// Skinning matrix of each node of the cage, from rest to `pose`.
    blend: Vec<DMat4>,
    state: State,
}

impl<'m> Simulation<'m> {
    /// Of a character at rest.
    ///
    /// # Errors
    ///
    /// Those of [`cage::Body::new`]; [`Error::Unusable`] for a setting out of range.
    pub fn new(model: &'m Model, settings: &Settings) -> Result<Self, Error> {
        let body = cage::Body::new(model, &settings.cage)?;
        Self::in_cage(model, body, settings)
    }

    /// Of a character in a cage that stands already.
    ///
    /// # Errors
    ///
    /// [`Error::Unusable`] for a setting out of range.
    pub fn in_cage(model: &'m Model, body: cage::Body, settings: &Settings) -> Result<Self, Error> {
        let refused = |what: String| Error::unusable(&model.name, "simulation", what, "change the settings");
        let (lame, scale) = settings.material(&model.name, &body.surface)?;
        let cage = &body.cage;
        let elements = Elements::tets(&cage.rest, cage.tets.clone()).map_err(|e| refused(e.to_string()))?;
        let mass = Mass::new(cage.rest.len()).with_tets(&elements, settings.density);
        let weight = Load::weight(&mass, scale * settings.gravity);
        let free = Free::new(cage.rest.len(), &body.binding.fixed);
        let moving = cage.tets.iter().filter(|t| t.iter().any(|i| free.row[*i as usize] != FIXED));
        let moving =
            Elements::tets(&cage.rest, moving.copied().collect()).map_err(|e| refused(e.to_string()))?;
        let flesh = Solid::new(moving, NeoHookean::new(lame));
        let spring = |(node, strength): &(u32, f64)| Spring {
            node: *node,
            stiffness: strength * lame.young() * cage.edge,
            to: cage.rest[*node as usize],
        };
        let pull = Pull { springs: body.binding.springs.iter().map(spring).collect() };
        let newton = Newton::new(free, &[&flesh, &pull, &weight], Method::DIRECT)
            .map_err(|e| refused(e.to_string()))?;
        Ok(Self {
            model,
            elements,
            flesh,
            weight,
            pull,
            mass,
            damping: settings.damping,
            newton,
            steps: None,
            tolerance: Tolerance { step: STILL * cage.edge, iterations: PATIENCE },
            rest: model.rest_transforms(),
            pose: Pose::rest(model),
            blend: vec![DMat4::IDENTITY; cage.rest.len()],
            state: State { x: cage.rest.clone(), v: vec![DVec3::ZERO; cage.rest.len()] },
            body,
        })
    }

    /// Where the nodes of the cage are, m.
    #[must_use]
    pub fn nodes(&self) -> &[DVec3] {
        &self.state.x
    }

    /// Where the skin's points are, m.
    #[must_use]
    pub fn skin(&self) -> Vec<DVec3> {
        self.body.apply(&self.state.x)
    }

    /// Where skinning alone puts the skin's points, m.
    #[must_use]
    pub fn skinned(&self) -> Vec<DVec3> {
        let matrices = self.skinning();
        let points = self.body.surface.points.iter();
        matrices.iter().zip(points).map(|(m, p)| m.transform_point3(*p)).collect()
    }

    /// Skinning matrix of each point of the skin, from rest to the pose.
    #[must_use]
    pub fn skinning(&self) -> Vec<DMat4> {
        blended(&self.moved(&self.pose), &self.body.surface.weights)
    }

    /// `F` of each tetrahedron of the cage.
    #[must_use]
    pub fn deformations(&self) -> Vec<DMat3> {
        (0..self.elements.len()).map(|e| self.elements.deformation(e, &self.state.x)).collect()
    }

    /// Energies of flesh, springs to the bones, and weight, J. Elements without a free node do not count.
    #[must_use]
    pub fn energies(&self) -> [f64; 3] {
        self.potentials().map(|p| p.energy(&self.state.x))
    }

    /// Elements that have a free node.
    #[must_use]
    pub fn moving(&self) -> usize {
        self.flesh.elements.len()
    }

    /// Nodes that have a row in the matrix.
    #[must_use]
    pub fn free(&self) -> usize {
        self.newton.free().node.len()
    }

    /// Back to rest.
    pub fn reset(&mut self) {
        self.pose = Pose::rest(self.model);
        self.state.x.copy_from_slice(&self.body.cage.rest);
        self.state.v.fill(DVec3::ZERO);
        self.blend.fill(DMat4::IDENTITY);
    }

    fn potentials(&self) -> [&dyn Potential; 3] {
        [&self.flesh, &self.pull, &self.weight]
    }

    /// What a pose does to points that each node of the model carries, from the rest pose to there.
    fn moved(&self, pose: &Pose) -> Vec<DMat4> {
        let of = |(now, rest): (DMat4, &DMat4)| {
            let moved = now * rest.inverse();
            // A node that has no size at rest carries nothing.
            if moved.is_finite() { moved } else { DMat4::IDENTITY }
        };
        pose.transforms(self.model).into_iter().zip(&self.rest).map(of).collect()
    }

    /// Brings the bones to a pose, and springs with them; where skinning puts the nodes of the cage.
    fn hold(&mut self, pose: &Pose) -> Vec<DVec3> {
        self.blend = blended(&self.moved(pose), &self.body.binding.weights);
        let skinned: Vec<DVec3> =
            self.blend.iter().zip(&self.body.cage.rest).map(|(m, x)| m.transform_point3(*x)).collect();
        for spring in &mut self.pull.springs {
            spring.to = skinned[spring.node as usize];
        }
        self.pose.clone_from(pose);
        skinned
    }
}

/// Blends of matrices of the nodes of a model.
fn blended(moved: &[DMat4], weights: &[Row]) -> Vec<DMat4> {
    let of = |row: &Row| row.iter().fold(DMat4::ZERO, |sum, (n, w)| sum + moved[*n as usize] * *w);
    weights.iter().map(of).collect()
}
