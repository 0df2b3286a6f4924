//! A character with its cage and all that holds them together.

use super::embed::{Place, embed};
use super::skeleton::{Binding, Hold, bind};
use super::stuffing::stuffed;
use super::surface::Surface;
use super::voxel::{Joining, Resolution, voxels};
use super::weights::weights;
use super::{Cage, STRAY};
use crate::{Error, Model};
use glam::DVec3;

/// What a cage is made of.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Shape {
    /// Whole cubes, six tetrahedra each; see [`voxels`].
    #[default]
    Cubes,
    /// Tetrahedra that end near the skin; see [`stuffed`]. Parts that touch nowhere stay apart.
    Fitted,
}

/// What a body is made with.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Options {
    /// Whether the cage is of cubes or fitted to the skin.
    pub shape: Shape,
    /// How fine the cage is.
    pub resolution: Resolution,
    /// What becomes of parts that touch nowhere.
    pub joining: Joining,
    /// How much follows the bones.
    pub hold: Hold,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            shape: Shape::default(),
            resolution: Resolution::Vertices(2000),
            joining: Joining::default(),
            hold: Hold::default(),
        }
    }
}

/// A surface in a cage that bones hold.
#[derive(Clone, Debug)]
pub struct Body {
    /// The skin.
    pub surface: Surface,
    /// Tetrahedra around it.
    pub cage: Cage,
    /// Where each point of the surface is in the cage.
    pub places: Vec<Place>,
    /// What follows the bones.
    pub binding: Binding,
}

impl Body {
    /// Makes the cage of a character.
    ///
    /// # Errors
    ///
    /// Those of [`Surface::new`], [`voxels`], [`stuffed`] and [`bind`].
    ///
    /// ```
    /// use sinew_bake::{builtin, cage::{Body, Options}};
    /// let body = Body::new(&builtin::character(), &Options::default())?;
    /// let belly_up = body.cage.rest.iter().map(|x| *x + glam::DVec3::Y).collect::<Vec<_>>();
    /// let skin = body.apply(&belly_up);
    /// assert!((skin[0] - body.surface.points[0] - glam::DVec3::Y).length() < 1e-12);
    /// # Ok::<(), sinew_bake::Error>(())
    /// ```
    pub fn new(model: &Model, options: &Options) -> Result<Self, Error> {
        let surface = Surface::new(model)?;
        let cage = match options.shape {
            Shape::Cubes => voxels(&surface, options.resolution, options.joining)?,
            Shape::Fitted => stuffed(&surface, options.resolution)?,
        };
        let places = embed(&surface.name, &cage, &surface.points)?;
        let weights = weights(&surface, &cage);
        let binding = bind(model, &surface, &cage, weights, options.hold)?;
        Ok(Self { surface, cage, places, binding })
    }

    /// Points of the surface where the nodes of the cage are at `nodes`.
    ///
    /// # Panics
    ///
    /// If `nodes` are fewer than the cage's.
    #[must_use]
    pub fn apply(&self, nodes: &[DVec3]) -> Vec<DVec3> {
        super::embed::apply(&self.cage, &self.places, nodes)
    }

    /// How much each node is held: 1 fixed, 0 free.
    #[must_use]
    pub fn holds(&self) -> Vec<f64> {
        let mut out = vec![0.0; self.cage.rest.len()];
        self.binding.fixed.iter().for_each(|i| out[*i as usize] = 1.0);
        self.binding.springs.iter().for_each(|(i, h)| out[*i as usize] = *h);
        out
    }

    /// Render vertices that are embedded; the others have no triangle.
    #[must_use]
    pub fn embedded(&self) -> usize {
        self.surface.point_of.iter().filter(|p| **p != STRAY).count()
    }

    /// All that a person may want to know, a sentence each.
    pub fn notes(&self) -> impl Iterator<Item = &str> {
        self.surface.notes.iter().chain(&self.cage.notes).chain(&self.binding.notes).map(String::as_str)
    }
}
