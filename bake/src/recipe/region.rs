//! Regions: flesh that hangs together shares its parameters.
//!
//! Two regions never touch where there is softness, so no surface tears between them. The farther
//! flesh reaches from its bones, the slower it swings, as pendulums do: `f ∝ 1/√reach`.

use super::rules::Recipe;
use super::surface::Surface;
use crate::Model;
use crate::pack::narrow;
use serde::{Deserialize, Serialize};
use sinew::asset::layout::MAX_REGIONS;
use std::collections::BTreeMap;

/// Parameters of a region.
#[derive(Clone, Debug, Default, Deserialize, PartialEq, Serialize)]
pub struct Region {
    /// Name: that of the joint that moves most of it.
    pub name: String,
    /// Frequency, Hz.
    pub frequency: f32,
    /// Damping ratio.
    pub damping: f32,
    /// Factor of the offset.
    pub gain: f32,
    /// Largest offset, body sizes.
    pub max_offset: f32,
}

/// A patch of connected flesh.
#[derive(Default)]
struct Patch {
    weight_of_joint: BTreeMap<usize, f64>,
    reach: f64,
    mass: f64,
}

/// Region of each point, and the regions.
pub(super) fn regions(
    model: &Model,
    surface: &Surface,
    softness: &[f64],
    recipe: &Recipe,
) -> (Vec<u8>, Vec<Region>) {
    let patch_of_point = surface.patches(softness);
    let nodes = model.rest_transforms();
    let mut patches: BTreeMap<usize, Patch> = BTreeMap::new();
    for (i, s) in softness.iter().enumerate().filter(|(_, s)| **s > 0.0) {
        let patch = patches.entry(patch_of_point[i]).or_default();
        let joint = surface.dominant(i);
        let at = nodes[model.joints[joint].node].w_axis.truncate();
        patch.reach = patch.reach.max(s * (surface.points[i] - at).length() / surface.size);
        patch.mass += s;
        for (j, w) in &surface.weights[i] {
            *patch.weight_of_joint.entry(*j).or_default() += w * s;
        }
    }
    number(model, &patches, &patch_of_point, recipe)
}

/// Patches of nearly the same parameters and of the same joint name share a region.
fn number(
    model: &Model,
    patches: &BTreeMap<usize, Patch>,
    patch_of_point: &[usize],
    recipe: &Recipe,
) -> (Vec<u8>, Vec<Region>) {
    let mut order: Vec<(&usize, &Patch)> = patches.iter().collect();
    order.sort_by(|a, b| b.1.mass.total_cmp(&a.1.mass).then(a.0.cmp(b.0)));
    let mut regions: Vec<Region> = Vec::new();
    let mut region_of_patch = BTreeMap::new();
    for (id, patch) in order {
        let region = parameters(model, patch, recipe);
        let same = |r: &Region| Region { name: String::new(), ..r.clone() };
        let known = regions.iter().position(|r| same(r) == same(&region));
        let index = match known {
            Some(index) => index,
            None if regions.len() < MAX_REGIONS => {
                regions.push(region);
                regions.len() - 1
            }
            None => MAX_REGIONS - 1,
        };
        region_of_patch.insert(*id, u8::try_from(index).unwrap_or(0));
    }
    if regions.is_empty() {
        regions.push(Region {
            name: "none".into(),
            frequency: 3.0,
            damping: 0.3,
            gain: 1.0,
            max_offset: 0.1,
        });
    }
    unique_names(&mut regions);
    let of_point = patch_of_point.iter().map(|p| region_of_patch.get(p).copied().unwrap_or(0)).collect();
    (of_point, regions)
}

fn parameters(model: &Model, patch: &Patch, recipe: &Recipe) -> Region {
    let heaviest = patch.weight_of_joint.iter().max_by(|a, b| a.1.total_cmp(b.1).then(b.0.cmp(a.0)));
    let node = heaviest.map_or(0, |(j, _)| model.joints[*j].node);
    let name = match model.nodes[node].name.as_str() {
        "" => format!("node {node}"),
        name => name.to_owned(),
    };
    // A tenth of the body swings at 2.6 Hz; steps of a fifth of a hertz let twins share a region.
    let hertz = (2.6 * libm::sqrt(0.1 / patch.reach.max(0.01))).clamp(1.4, 4.5);
    let steps = libm::round(hertz * 5.0) / 5.0;
    let mut region = Region {
        name,
        frequency: narrow(steps),
        damping: 0.22,
        gain: 1.0,
        max_offset: narrow(libm::round((0.45 * patch.reach).clamp(0.02, 0.12) * 200.0) / 200.0),
    };
    recipe.tune(&mut region);
    region
}

/// Numbers names that occur twice, within the 16 bytes of the format.
fn unique_names(regions: &mut [Region]) {
    for i in 0..regions.len() {
        let mut name: String = regions[i].name.chars().take(14).collect();
        while name.len() > 14 {
            name.pop();
        }
        if regions[..i].iter().any(|r| r.name == name) {
            name = format!("{} {}", name.chars().take(11).collect::<String>(), i + 1);
            while name.len() > 16 {
                name.remove(0);
            }
        }
        regions[i].name = name;
    }
}
