//! Where the bone wrap would like to be: the skin drawn towards capsules around the bones.
//!
//! ```text
//! p ← q(p) + R (p − q)/|p − q|            onto the capsule: q the foot of p on its bones, blended by weights
//! p ← p + 0.4 Σⱼ (pⱼ − p)/lⱼ / Σⱼ 1/lⱼ     smoothing by inverse lengths of the skin's edges
//! ```
//!
//! in turns, as in *Fast Projective Skinning* (Komaritzan, Botsch 2019); points beyond the ends of last bones
//! stay where the first projection put them. Unlike there `R` belongs to a column and not to a bone, so that flesh is
//! never deeper than a bound and never deeper than the body is thick.

use super::Settings;
use super::bones::Bones;
use super::skin::Skin;
use glam::DVec3;

/// Turns of projection and smoothing.
const TURNS: usize = 20;
/// Step of the smoothing.
const STEP: f64 = 0.4;
/// The radius of a capsule is a share of this quantile of the distances of its skin.
const QUANTILE: f64 = 0.5;

/// Targets of all points of the skin; `radii` are those of the inscribed balls.
pub(super) fn targets(
    skin: &Skin,
    bones: &Bones,
    normals: &[DVec3],
    radii: &[f64],
    settings: &Settings,
) -> Vec<DVec3> {
    let feet: Vec<_> = skin.points.iter().zip(&skin.weights).map(|(p, w)| bones.foot(*p, w)).collect();
    let distances: Vec<f64> = skin.points.iter().zip(&feet).map(|(p, f)| p.distance(f.place)).collect();
    let capsules = capsules(skin, &distances, settings);
    // Where the bones are outside the nearest ball by far, they say nothing of the flesh here.
    let inside = |i: usize| distances[i] <= settings.reach * radii[i];
    let depth = |i: usize| {
        let bound = settings.deepest * skin.size;
        let to_bone = (distances[i] - capsules[i]).max(settings.shallowest * distances[i]);
        if inside(i) { to_bone.min(bound) } else { (settings.ball * radii[i]).min(bound) }
    };
    let mut depths: Vec<f64> = (0..skin.points.len()).map(depth).collect();
    for _ in 0..TURNS {
        depths = smoothed(skin, &depths);
    }
    let project = |i: usize, p: DVec3| {
        let foot = bones.foot(p, &skin.weights[i]).place;
        let away = (p - foot).normalize_or(normals[i]);
        foot + (distances[i] - depths[i]).max(0.0) * away
    };
    let mut places: Vec<DVec3> = (0..skin.points.len())
        .map(|i| if inside(i) { project(i, skin.points[i]) } else { skin.points[i] - depths[i] * normals[i] })
        .collect();
    for _ in 0..TURNS {
        places = (0..places.len())
            .map(|i| {
                let smooth = places[i] + STEP * (mean(skin, i, |j| places[j]) - places[i]);
                if feet[i].at_end {
                    places[i]
                } else if inside(i) {
                    project(i, smooth)
                } else {
                    smooth
                }
            })
            .collect();
    }
    places
}

/// Radius of the capsules around the bones of each point, blended by weights.
fn capsules(skin: &Skin, distances: &[f64], settings: &Settings) -> Vec<f64> {
    let mut of_bone: std::collections::BTreeMap<usize, Vec<(f64, f64)>> = std::collections::BTreeMap::new();
    for (i, row) in skin.weights.iter().enumerate() {
        for (node, w) in row {
            of_bone.entry(*node).or_default().push((distances[i], w * skin.areas[i]));
        }
    }
    let radius = |list: &mut Vec<(f64, f64)>| {
        list.sort_by(|a, b| a.0.total_cmp(&b.0));
        let half = QUANTILE * list.iter().map(|(_, w)| w).sum::<f64>();
        let mut sum = 0.0;
        let at = list.iter().find(|(_, w)| {
            sum += w;
            sum >= half
        });
        settings.bone * at.map_or(0.0, |(d, _)| *d)
    };
    let radii: std::collections::BTreeMap<usize, f64> =
        of_bone.into_iter().map(|(node, mut list)| (node, radius(&mut list))).collect();
    skin.weights.iter().map(|row| row.iter().map(|(node, w)| w * radii[node]).sum()).collect()
}

fn smoothed(skin: &Skin, values: &[f64]) -> Vec<f64> {
    let one = |i: usize| {
        let (sum, weight) =
            skin.edges[i].iter().fold((0.0, 0.0), |(s, w), (j, l)| (s + values[*j] / l, w + 1.0 / l));
        values[i] + STEP * (sum / weight - values[i])
    };
    (0..values.len()).map(one).collect()
}

/// Mean of the neighbors by inverse edge lengths.
pub(super) fn mean(skin: &Skin, i: usize, place: impl Fn(usize) -> DVec3) -> DVec3 {
    let (sum, weight) =
        skin.edges[i].iter().fold((DVec3::ZERO, 0.0), |(s, w), (j, l)| (s + place(*j) / *l, w + 1.0 / l));
    sum / weight
}
