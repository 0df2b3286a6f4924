//! The recipe: where a character's flesh is and how soft, from geometry and skin weights alone.
//!
//! ```text
//! weld ─▶ depth over the bones ─▶ smooth over the surface ─▶ mirror ─▶ regions
//! ```
//!
//! Flesh is what lies deeper over its bone than the joint's own bony radius (bellies, cheeks), or hangs
//! far beyond the last joint of a chain (ears, tails). Everything is measured in body sizes. A painted
//! `_SINEW` attribute or rules by joint name override it.

mod depth;
mod mirror;
mod region;
mod rules;
mod surface;

pub use region::Region;
pub use rules::{Recipe, Rule};

use crate::{Error, Model};
use surface::Surface;

/// Softness below this is smoothing's rim, not flesh.
const RIM: f64 = 0.03;

/// Where flesh is.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Flesh {
    /// Softness of each render vertex, `0..=1`; 0 follows skinning exactly.
    pub softness: Vec<f32>,
    /// Region of each render vertex, an index into `regions`.
    pub region: Vec<u8>,
    /// Regions, at most 16.
    pub regions: Vec<Region>,
    /// Diagonal of the rest pose's bounding box, model units.
    pub body_size: f64,
    /// Whether the rest pose mirrors at `x = 0`.
    pub symmetric: bool,
    /// What a person should know.
    pub notes: Vec<String>,
}

/// Finds the flesh of `model`.
///
/// # Errors
///
/// [`Error::Unusable`] for a model without extent or without vertices.
pub fn flesh(model: &Model, recipe: &Recipe) -> Result<Flesh, Error> {
    let surface = Surface::new(model)?;
    let mut notes = Vec::new();
    let mut softness = depth::softness(model, &surface);
    surface.join_small_parts(&mut softness);
    surface.smooth(&mut softness);
    stretch(&surface, &mut softness);
    let partners = mirror::partners(&surface);
    if let Some(partners) = &partners {
        mirror::average(&mut softness, partners);
    }
    let painted = paint(model, &surface, &mut softness);
    rules::apply(model, &surface, recipe, &mut softness);
    leave_spring_bones(model, &surface, &mut softness, &mut notes);
    if painted > 0 {
        notes.push(format!("{painted} vertices are painted by _SINEW"));
    }
    for s in &mut softness {
        *s = (*s * f64::from(recipe.softness)).clamp(0.0, 1.0);
        *s = if *s < 1e-3 { 0.0 } else { *s };
    }
    let (region_of_point, regions) = region::regions(model, &surface, &softness, recipe);
    if softness.iter().all(|s| *s <= 0.0) {
        notes.push("no flesh was found: paint _SINEW or add a rule".to_owned());
    }
    Ok(Flesh {
        softness: surface.spread(&softness).map(crate::pack::narrow).collect(),
        region: surface.spread(&region_of_point).collect(),
        regions,
        body_size: surface.size,
        symmetric: partners.is_some(),
        notes,
    })
}

/// Cuts off the faint rim of smoothing; each patch of flesh then reaches the cube root of what it had.
fn stretch(surface: &Surface, softness: &mut [f64]) {
    softness.iter_mut().for_each(|s| *s = (*s - RIM).max(0.0));
    let patch = surface.patches(softness);
    let mut most = vec![0.0_f64; patch.iter().max().map_or(0, |p| p + 1)];
    for (p, s) in patch.iter().zip(&*softness) {
        most[*p] = most[*p].max(*s);
    }
    for (p, s) in patch.iter().zip(softness) {
        if most[*p] > 0.0 {
            *s = (*s / most[*p] * libm::cbrt(most[*p])).clamp(0.0, 1.0);
        }
    }
}

/// Replaces the softness where the file is painted; how many render vertices are.
fn paint(model: &Model, surface: &Surface, softness: &mut [f64]) -> usize {
    let (mut vertex, mut painted) = (0, 0);
    for p in &model.primitives {
        for i in 0..p.positions.len() {
            if let Some(value) = p.painted.as_ref().and_then(|v| v.get(i)) {
                softness[surface.point_of_vertex[vertex]] = f64::from(value.clamp(0.0, 1.0));
                painted += 1;
            }
            vertex += 1;
        }
    }
    painted
}

/// Lets VRM's own spring bones alone: their share of a vertex's weights is taken from its softness.
fn leave_spring_bones(model: &Model, surface: &Surface, softness: &mut [f64], notes: &mut Vec<String>) {
    let Some(vrm) = &model.vrm else { return };
    let springs: Vec<bool> = model.joints.iter().map(|j| vrm.spring_nodes.contains(&j.node)).collect();
    let mut left = 0;
    for (point, s) in softness.iter_mut().enumerate() {
        let share: f64 = surface.weights[point].iter().filter(|(j, _)| springs[*j]).map(|(_, w)| w).sum();
        left += usize::from(share > 0.5);
        *s *= if share > 0.5 { 0.0 } else { 1.0 - 2.0 * share };
    }
    notes.push(format!("{left} points follow VRM spring bones: they are left to them"));
}
