//! The geometric skeleton: nodes of a cage that follow the bones, and those that are pulled to where the bones would
//! take them.
//!
//! ```text
//! d: distance from the bone,  r: distance from there to the surface,  ρ = d / r
//! ρ ≤ inner: fixed      inner < ρ < outer: a spring of coefficient 1 − s²(3 − 2s), s = (ρ − inner)/(outer − inner)
//! ```
//!
//! Flesh that is farther than the surface is on the near side of the bone has ρ > 1: a belly, not a back.

use super::Cage;
use super::surface::{Row, Surface};
use super::weights::NodeWeights;
use crate::recipe::bone;
use crate::recipe::{Recipe, flesh};
use crate::{Error, Model};
use glam::DVec3;
use rayon::prelude::*;

/// Nodes closer to a bone than this many edges are fixed: around any point of a cube there is one.
const CORNER: f64 = 0.867;
/// A bone holds a node that it moves by this share at least.
const HOLDS: f64 = 0.1;
/// Share of the weight on wholly bound bones from which a node is bound.
const BOUND: f64 = 0.5;
/// A head softer than this on the mean has flesh.
const HARD: f64 = 0.05;
/// Share of a bone's skin that is closer than its reach.
const REACH: f64 = 0.8;

/// How much of a body follows the bones.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hold {
    /// Up to this share of the local thickness nodes are fixed.
    pub inner: f64,
    /// From this share on they are free.
    pub outer: f64,
    /// A bone whose flesh is thinner than this share of the character's thickest is wholly bound.
    pub thin: f64,
}

impl Default for Hold {
    fn default() -> Self {
        Self { inner: 0.4, outer: 0.9, thin: 0.2 }
    }
}

/// What holds a cage to its bones.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Binding {
    /// Nodes that move as their weights say, ascending.
    pub fixed: Vec<u32>,
    /// Nodes that a spring of no length pulls there, ascending, with a coefficient between 0 and 1.
    pub springs: Vec<(u32, f64)>,
    /// Skin weights of all nodes.
    pub weights: Vec<Row>,
    /// What a person may want to know, a sentence each.
    pub notes: Vec<String>,
}

/// A bone, measured.
struct Bone {
    segments: Vec<[DVec3; 2]>,
    /// Follows wholly.
    bound: bool,
}

/// Decides what follows the bones. Painted softness overrides: 0 is fixed, 1 is free but for the bone itself, and in
/// between a spring of 1 minus it pulls.
///
/// # Errors
///
/// Those of the recipe, which says where a head has flesh.
///
/// # Panics
///
/// If `surface`, `cage` and `weights` are not of this model.
pub fn bind(
    model: &Model,
    surface: &Surface,
    cage: &Cage,
    weights: NodeWeights,
    hold: Hold,
) -> Result<Binding, Error> {
    let bones = bones(model, surface, cage.edge, hold)?;
    let holds: Vec<f64> = (0..cage.rest.len())
        .into_par_iter()
        .map(|i| coefficient(surface, &bones, &weights.rows[i], cage.rest[i], cage.edge, hold))
        .collect();
    let mut out = Binding { weights: weights.rows, ..Binding::default() };
    let mut held = vec![false; cage.components];
    holds.iter().zip(&cage.component).filter(|(h, _)| **h > 0.0).for_each(|(_, c)| held[*c as usize] = true);
    for (i, h) in (0_u32..).zip(holds) {
        if h >= 1.0 || !held[cage.component[i as usize] as usize] {
            out.fixed.push(i);
        } else if h > 0.0 {
            out.springs.push((i, h));
        }
    }
    let loose = held.iter().filter(|h| !**h).count();
    if loose > 0 {
        out.notes.push(format!("{loose} parts have no bone inside and follow their skin weights wholly"));
    }
    Ok(out)
}

/// Bones by node of the model; controls inside the flesh have the segments of the bone above.
fn bones(model: &Model, surface: &Surface, edge: f64, hold: Hold) -> Result<Vec<Option<Bone>>, Error> {
    let list = bone::bones(model)?;
    let soft = softness(model, surface)?;
    let mut skins: Vec<Vec<usize>> = vec![Vec::new(); model.nodes.len()];
    for (i, row) in surface.weights.iter().enumerate() {
        row.iter().filter(|(_, w)| *w >= BOUND).for_each(|(node, _)| skins[*node as usize].push(i));
    }
    let reach = |b: &bone::Bone| {
        let skin = &skins[b.node as usize];
        let segments: Vec<_> = b.segments.iter().copied().chain([b.whole]).collect();
        let mut all: Vec<f64> = skin.iter().map(|i| from_bone(&segments, surface.points[*i]).0).collect();
        all.sort_by(f64::total_cmp);
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "an index")]
        #[expect(clippy::cast_precision_loss, reason = "an index")]
        all.get((REACH * all.len() as f64) as usize).copied().unwrap_or(0.0)
    };
    let reaches: Vec<f64> = list.iter().map(reach).collect();
    let thickest = reaches.iter().copied().fold(0.0, f64::max);
    let mut out: Vec<Option<Bone>> = (0..model.nodes.len()).map(|_| None).collect();
    for (b, reach) in list.iter().zip(reaches) {
        let skin = &skins[b.node as usize];
        #[expect(clippy::cast_precision_loss, reason = "a mean over a count")]
        let hard = skin.iter().map(|i| soft[*i]).sum::<f64>() <= HARD * skin.len() as f64;
        let bound = b.owner == b.node && (reach < (hold.thin * thickest).max(edge) || (b.rigid && hard));
        let answers = list.iter().find(|other| other.node == b.owner).unwrap_or(b);
        out[b.node as usize] = Some(Bone { segments: answers.segments.clone(), bound });
    }
    Ok(out)
}

/// Softness of the recipe at each point.
fn softness(model: &Model, surface: &Surface) -> Result<Vec<f64>, Error> {
    let soft = flesh(model, &Recipe::default())?.softness;
    let mut out = vec![0.0; surface.points.len()];
    for (point, s) in surface.point_of.iter().zip(soft) {
        if let Some(out) = out.get_mut(*point as usize) {
            *out = f64::max(*out, f64::from(s));
        }
    }
    Ok(out)
}

/// Distance from the nearest segment, and the point there.
fn from_bone(segments: &[[DVec3; 2]], p: DVec3) -> (f64, DVec3) {
    let to = |[a, b]: &[DVec3; 2]| {
        let along = *b - *a;
        let t = along.dot(p - *a) / along.length_squared();
        let q = *a + along * if t.is_finite() { t.clamp(0.0, 1.0) } else { 0.0 };
        (p.distance(q), q)
    };
    let all = segments.iter().map(to);
    all.min_by(|a, b| a.0.total_cmp(&b.0)).unwrap_or((f64::INFINITY, p))
}

/// How much a node is held: 1 fixed, 0 free.
fn coefficient(surface: &Surface, bones: &[Option<Bone>], row: &Row, p: DVec3, edge: f64, hold: Hold) -> f64 {
    let painted = painted(surface, p);
    let of = || row.iter().filter_map(|(node, w)| bones[*node as usize].as_ref().map(|b| (b, *w)));
    let bound: f64 = of().filter(|(b, _)| b.bound).map(|(_, w)| w).sum();
    if painted.is_none() && bound > BOUND {
        return 1.0;
    }
    let mut most: f64 = 0.0;
    for (bone, _) in of().filter(|(_, w)| *w >= HOLDS) {
        let (d, q) = from_bone(&bone.segments, p);
        if d <= CORNER * edge {
            return 1.0;
        }
        let inside = surface.winding(q) > 0.5;
        let r = if inside { surface.nearest(q).distance } else { 0.0 };
        let s = ((d - hold.inner * r) / ((hold.outer - hold.inner) * r)).clamp(0.0, 1.0);
        // No thickness, no number: nothing is held.
        most = most.max(if s.is_nan() { 0.0 } else { 1.0 - s * s * (3.0 - 2.0 * s) });
    }
    match painted {
        Some(softness) if most < 1.0 => 1.0 - softness,
        _ => most,
    }
}

/// Painted softness of the closest skin.
fn painted(surface: &Surface, p: DVec3) -> Option<f64> {
    if surface.painted.iter().all(Option::is_none) {
        return None;
    }
    let near = surface.nearest(p);
    let corners = surface.triangles[near.triangle as usize].iter().zip(near.at);
    corners.map(|(i, share)| surface.painted[*i as usize].map(|s| s * share)).sum()
}
