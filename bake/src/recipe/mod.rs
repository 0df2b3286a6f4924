//! The "auto" recipe: where flesh is, how soft it is and which parts stay put, from geometry and skin weights.
//!
//! ```text
//! Model ─▶ surface (welded) ─▶ symmetry ─▶ skeleton ─▶ anatomy (trunk, limbs, head, tail, ears)
//!                                                          │
//!        Flesh ◀─ painted, VRM ◀─ region, rules ◀─ smooth ◀─ field (flesh depth, place on tail and ear, protrusion)
//! ```
//!
//! All lengths inside are in body sizes, so that a model scaled 0.01 or 100 has the same flesh. Softness is
//! computed per welded point: vertices that a file splits get the same bits.

#![doc = include_str!("../../../docs/recipe.md")]

mod anatomy;
#[cfg(feature = "simulate")]
pub(crate) mod bone;
mod field;
mod flap;
pub(crate) mod grid;
mod mirror;
mod protrusion;
mod region;
mod rules;
mod skeleton;
mod smooth;
pub(crate) mod surface;

use serde::{Deserialize, Serialize};

use crate::{Error, Model};
use field::ease;
pub use mirror::Mirror;
use mirror::Symmetry;
pub use region::Region;
use region::Regions;
pub use rules::{Recipe, Rule};
use skeleton::Skeleton;
use surface::Surface;

/// The manual: regions, keys of a recipe with units and defaults, and what cannot be told; Markdown.
pub const MANUAL: &str = include_str!("../../../docs/recipe.md");

/// Where flesh is and how it swings.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Flesh {
    /// Softness of each render vertex, `0..=1`; 0 follows skinning exactly.
    pub softness: Vec<f32>,
    /// Region of each render vertex: index into `regions`.
    pub region: Vec<u8>,
    /// At most 16 regions. Where two meet, softness is 0 on both sides (unless it was painted).
    pub regions: Vec<Region>,
    /// Body size, model units: the diagonal of the box around the rest pose's triangles.
    pub body_size: f64,
    /// The plane that maps the character onto itself, if there is one.
    pub mirror: Option<Mirror>,
    /// What a person may want to know, a sentence each.
    pub notes: Vec<String>,
}

/// Decides where a character's flesh is.
///
/// # Errors
///
/// [`Error::Unusable`] if the skin has no vertices or no size, a position is not finite, a painted softness is not
/// in `0..=1`, or the recipe's values are out of range.
pub fn flesh(model: &Model, recipe: &Recipe) -> Result<Flesh, Error> {
    recipe.check()?;
    let surface = Surface::new(model)?;
    let painted = painted(model, &surface)?;
    let symmetry = Symmetry::new(&surface);
    let mut skeleton = Skeleton::new(model, &surface);
    anatomy::classify(&mut skeleton, &surface, &symmetry);
    let mut field = field::measure(&surface, &skeleton, &symmetry);
    // Strays so far away that their distances overflow are no flesh.
    field.soft.iter_mut().filter(|s| !s.is_finite()).for_each(|s| *s = 0.0);
    symmetry.average(&mut field.soft);
    let pieces = smooth::pieces(&surface);
    let mut soft = field.soft.clone();
    smooth::even(&surface, &field.rigid, &mut soft);
    let mut regions = Regions::new(&skeleton, &field, &symmetry, &pieces);
    let shares = region::shares(model, &surface, recipe);
    let mut notes = Vec::new();
    apply_softness(recipe, &shares, &mut soft, &mut notes);
    regions.apply(recipe, &shares);
    smooth::limit_slope(&surface, &mut soft);
    smooth::fade_borders(&surface, &regions.of, &mut soft);
    smooth::unite(&pieces, &mut soft);
    leave_springs(model, &surface, &mut soft, &mut notes);
    smooth::limit_slope(&surface, &mut soft);
    symmetry.average(&mut soft);
    regions.split_limbs(&surface, &field, recipe, &soft);
    let was_painted = painted.iter().flatten().count();
    if was_painted > 0 {
        notes.push(format!("{was_painted} points have painted softness"));
    }
    for (soft, painted) in soft.iter_mut().zip(painted) {
        *soft = painted.unwrap_or(*soft);
    }
    regions.drop_unused(&soft);
    #[expect(clippy::cast_possible_truncation, reason = "softness is f32")]
    let softness = surface.point_of.iter().map(|p| soft[*p] as f32).collect();
    Ok(Flesh {
        softness,
        region: surface.point_of.iter().map(|p| regions.of[*p]).collect(),
        regions: regions.list,
        body_size: surface.size,
        mirror: symmetry.mirror,
        notes,
    })
}

/// Applies the softness of a recipe.
fn apply_softness(recipe: &Recipe, shares: &[Vec<f64>], soft: &mut [f64], notes: &mut Vec<String>) {
    let all = f64::from(recipe.softness);
    soft.iter_mut().for_each(|s| *s = (*s * all).min(1.0));
    for (n, (rule, shares)) in recipe.rules.iter().zip(shares).enumerate() {
        if shares.iter().all(|s| *s <= 0.0) {
            let joints = rule.joints.join(", ");
            notes.push(format!(
                "{}: rule {}: no joint that moves skin is named {joints}",
                recipe.file,
                n + 1
            ));
        }
        for (soft, share) in soft.iter_mut().zip(shares) {
            let wanted = *soft * rule.multiply.map_or(1.0, f64::from);
            let wanted = rule.softness.map_or(wanted, f64::from);
            *soft = (*soft + (wanted - *soft) * share.min(1.0)).clamp(0.0, 1.0);
        }
    }
}

/// Leaves alone what spring bones move already.
fn leave_springs(model: &Model, surface: &Surface, soft: &mut [f64], notes: &mut Vec<String>) {
    let Some(vrm) = &model.vrm else { return };
    let mut springs = vec![false; model.nodes.len()];
    vrm.spring_nodes.iter().filter(|n| **n < model.nodes.len()).for_each(|n| springs[*n] = true);
    let mut left = vec![false; soft.len()];
    for (i, row) in surface.weights.iter().enumerate() {
        let share: f64 = row.iter().filter(|(n, _)| springs[*n]).map(|(_, w)| w).sum();
        soft[i] *= 1.0 - ease(0.0, 0.5, share);
        left[i] = share >= 0.5;
    }
    let vertices = surface.point_of.iter().filter(|p| left[**p]).count();
    notes.push(format!("{vertices} vertices are moved by VRM spring bones and left to them"));
}

/// Painted softness of each point: the mean over its painted vertices.
fn painted(model: &Model, surface: &Surface) -> Result<Vec<Option<f64>>, Error> {
    let mut sums = vec![(0.0, 0.0); surface.points.len()];
    let mut start = 0;
    for primitive in &model.primitives {
        for (v, value) in primitive.painted.iter().flatten().enumerate() {
            if !(0.0..=1.0).contains(value) || v >= primitive.positions.len() {
                return Err(Error::unusable(
                    &model.name,
                    format!("mesh {}, primitive {}, vertex {v}, _SINEW", primitive.mesh, primitive.primitive),
                    format!("painted softness is {value}"),
                    "paint values from 0 to 1, one a vertex",
                ));
            }
            let sum = &mut sums[surface.point_of[start + v]];
            *sum = (sum.0 + f64::from(*value), sum.1 + 1.0);
        }
        start += primitive.positions.len();
    }
    Ok(sums.into_iter().map(|(sum, count)| (count > 0.0).then(|| sum / count)).collect())
}
