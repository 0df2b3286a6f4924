//! The layered cage of a body: skin, muscle and bone wraps of one tessellation, prisms between them.
//!
//! ```text
//! model ─▶ skin (closed, welded) ─▶ unfold ─▶ normal, ball (how thick the body is) ─┐
//!   └────▶ bones ─▶ shrink (targets) ─▶ march (bone wrap) ◀──────────────────────────┘
//!                                         └─▶ muscle ─▶ thin ─▶ interior ─▶ Layers ─▶ embed, section, quality
//! ```
//!
//! The wraps of neural deformation gradients (Nolte et al. 2026) are fitted to scans and then repaired;
//! here the bone wrap *grows* from the skin inwards and no step is taken that would invert a prism (see `march`):
//! only parts that run into each other are drawn apart afterwards. [`Layers::quality`] counts all the same.

mod ball;
mod bones;
pub(crate) mod crossing;
pub mod embed;
mod interior;
mod march;
mod muscle;
mod normal;
mod quality;
mod section;
mod shrink;
mod skin;
mod sound;
mod thin;
mod unfold;

pub use quality::Quality;

use crate::Model;
use glam::DVec3;
use march::March;
use rayon::prelude::*;
use skin::{Skin, unusable};
use std::collections::BTreeMap;

type Outcome<T> = Result<T, crate::Error>;

/// Bones that move one prism at most.
pub const INFLUENCES: usize = 8;

/// How a body is cut into layers; lengths in body sizes: the diagonal of the box around the skin in the rest pose.
#[derive(Clone, Debug, PartialEq)]
pub struct Settings {
    /// Radius of a bone's capsule, as a share of the median distance of its skin, 0 to 1.
    pub bone: f64,
    /// Least depth of flesh, as a share of the distance from skin to bone, 0 to 1.
    pub shallowest: f64,
    /// Greatest depth of flesh, body sizes.
    pub deepest: f64,
    /// A bone farther away than this many inscribed radii says nothing of the flesh below a point: fingers, ears.
    pub reach: f64,
    /// There the depth is this share of the inscribed radius, 0 to 1.
    pub ball: f64,
    /// Share of muscle in the flesh, 0 to 1, by patterns of joint names; the first that fits, else one half.
    pub muscle: Vec<(String, f64)>,
    /// Patterns of the names of joints whose skin, and that of all joints below them, has no layers.
    pub skinned: Vec<String>,
    /// Skin above inscribed balls of a smaller radius has no layers, body sizes.
    pub thinnest: f64,
}

impl Default for Settings {
    /// Layers where there is flesh: without head, hands and feet.
    fn default() -> Self {
        let owned = |names: &[&str]| names.iter().map(|n| (*n).to_owned()).collect();
        let muscle = [("*leg*", 0.7), ("*thigh*", 0.6), ("*shin*", 0.7), ("*calf*", 0.7), ("*arm*", 0.7)];
        Self {
            bone: 0.55,
            shallowest: 0.2,
            deepest: 0.05,
            reach: 2.5,
            ball: 0.4,
            muscle: muscle.map(|(name, share)| (name.to_owned(), share)).to_vec(),
            skinned: owned(&["*head*", "*hand*", "*finger*", "*thumb*", "*foot*", "*toe*"]),
            thinnest: 0.005,
        }
    }
}

impl Settings {
    /// Layers everywhere, however thin.
    #[must_use]
    pub fn everywhere() -> Self {
        Self { skinned: Vec::new(), thinnest: 0.0, ..Self::default() }
    }
}

/// A layered cage; model space, rest pose, m.
///
/// Nodes come in three blocks of [`Layers::columns`]: bone wrap, muscle wrap, skin. Node `i` of each is on column `i`.
/// Prisms come in two blocks of as many as there are triangles: first those between bone and muscle, then those
/// between muscle and skin.
///
/// ```
/// use sinew_bake::cage::layers::{Layers, Settings};
/// use sinew_bake::fem::element::Elements;
/// let layers = Layers::new(&sinew_bake::builtin::character(), &Settings::default())?;
/// assert_eq!(layers.rest.len(), 3 * layers.columns());
/// assert_eq!(layers.quality().unsound, 0);
/// let prisms = Elements::prisms(&layers.rest, layers.prisms.clone()).expect("no prism is inverted");
/// assert_eq!(prisms.len(), 2 * layers.skin.len());
/// # Ok::<(), sinew_bake::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Layers {
    /// Places of all nodes.
    pub rest: Vec<DVec3>,
    /// Prisms: inner triangle, outer triangle of the same winding.
    pub prisms: Vec<[u32; 6]>,
    /// Triangles of the skin's nodes, seen from outside against the clock.
    pub skin: Vec<[u32; 3]>,
    /// Inner ends of the columns, one each: node `3 columns + i` is `core[i]`. All of them follow the skeleton.
    pub core: Vec<DVec3>,
    /// Tetrahedra between the bone wrap and `core`, the fourth node on the side that the first three turn to by the
    /// right hand; those that would be flat or inside out are left out.
    pub tets: Vec<[u32; 4]>,
    /// Whether each node follows the skeleton: the bone wrap, and all layers where the cage ends.
    pub fixed: Vec<bool>,
    /// Nodes of the model that move each column, ascending, with weights that sum to 1.
    pub weights: Vec<Vec<(usize, f64)>>,
    /// Column of each render vertex of the model; `None` where it has none.
    pub column_of: Vec<Option<u32>>,
    /// Skin nodes that are not where their render vertices are: folds, smoothed until a column could leave.
    pub unfolded: usize,
}

impl Layers {
    /// Cuts a model's body into layers: its closed part that encloses most.
    ///
    /// # Errors
    ///
    /// [`crate::Error::Unusable`] if no part of the skin is closed, the body is flat, positions are not finite, the
    /// bones have no length, or nothing is left of the body without its thin parts.
    pub fn new(model: &Model, settings: &Settings) -> Outcome<Self> {
        let mut skin = Skin::new(model)?;
        let bones = bones::Bones::new(model, &skin)?;
        let before = skin.points.clone();
        let (normals, seen) = unfold::unfold(&mut skin);
        let radii = ball::radii(&skin, &normals);
        let targets = shrink::targets(&skin, &bones, &normals, &radii, settings);
        let mut march = March::new(&skin, &normals, &seen).map_err(|folded| {
            let place = folded.first().map_or(DVec3::ZERO, |i| skin.points[*i as usize]);
            let problem = format!("{} points of the skin are folded: no column can leave them", folded.len());
            unusable(model, &format!("skin, near {place:.3}"), &problem, "smooth the mesh there")
        })?;
        march.to(&targets);
        march.along(&normals, &targets);
        march.untangle();
        let shares = muscle_shares(model, &skin, settings);
        let muscle = muscle::wrap(&skin, &march.bone, &shares);
        let kept = thin::kept(model, &skin, &radii, settings);
        if !kept.contains(&true) {
            return Err(unusable(
                model,
                "body",
                "nothing is left of it without its thin parts",
                "lower the thickness or the list of skinned joints in the settings",
            ));
        }
        let mut layers = Self::assembled(&skin, &[&march.bone, &muscle, &skin.points], &kept);
        let (triangles, n) = (layers.triangles(), layers.columns());
        (layers.core, layers.tets) =
            interior::tets(&triangles, &layers.weights, &bones, &layers.rest[..n], number(3 * n));
        layers.unfolded = (0..before.len()).filter(|i| before[*i] != skin.points[*i]).count();
        Ok(layers)
    }

    /// Columns: nodes of one layer.
    #[must_use]
    pub fn columns(&self) -> usize {
        self.rest.len() / 3
    }

    /// The triangles of every layer, by columns.
    #[must_use]
    pub fn triangles(&self) -> Vec<[u32; 3]> {
        let first = number(2 * self.columns());
        self.skin.iter().map(|t| t.map(|i| i - first)).collect()
    }

    /// Weights of the prisms, one list for the two prisms of each triangle: means over their columns, the
    /// [`INFLUENCES`] largest of them, sum 1, ascending by node.
    #[must_use]
    pub fn prism_weights(&self) -> Vec<Vec<(usize, f64)>> {
        self.triangles().iter().map(|t| blended(t.map(|i| &self.weights[i as usize]))).collect()
    }

    /// Numbers the columns of the kept triangles.
    fn assembled(skin: &Skin, wraps: &[&[DVec3]; 3], kept: &[bool]) -> Self {
        let triangles = || skin.triangles.iter().zip(kept).filter(|(_, kept)| **kept).map(|(t, _)| *t);
        let mut column = vec![None; skin.points.len()];
        triangles().flatten().for_each(|i| column[i as usize] = Some(0));
        let points: Vec<usize> = (0..column.len()).filter(|i| column[*i].is_some()).collect();
        for (number, i) in (0_u32..).zip(&points) {
            column[*i] = Some(number);
        }
        let n = number(points.len());
        let triangles: Vec<[u32; 3]> =
            triangles().map(|t| t.map(|i| column[i as usize].unwrap_or_default())).collect();
        let prisms = [0, n].into_iter().flat_map(|inner| {
            triangles.iter().map(move |[a, b, c]| {
                let outer = inner + n;
                [a + inner, b + inner, c + inner, a + outer, b + outer, c + outer]
            })
        });
        let rim = |i: &usize| skin.around[*i].iter().any(|t| !kept[*t as usize]);
        let rim: Vec<bool> = points.iter().map(rim).collect();
        Self {
            rest: wraps.iter().flat_map(|wrap| points.iter().map(|i| wrap[*i])).collect(),
            prisms: prisms.collect(),
            skin: triangles.iter().map(|t| t.map(|i| i + 2 * n)).collect(),
            core: Vec::new(),
            tets: Vec::new(),
            fixed: core::iter::repeat_n(true, points.len())
                .chain(rim.iter().copied())
                .chain(rim.iter().copied())
                .collect(),
            weights: points.iter().map(|i| skin.weights[*i].clone()).collect(),
            column_of: skin.point_of.iter().map(|p| p.and_then(|p| column[p as usize])).collect(),
            unfolded: 0,
        }
    }
}

/// A node's number as elements hold it.
fn number(i: usize) -> u32 {
    u32::try_from(i).unwrap_or(u32::MAX)
}

/// Mean of three rows of weights, cut to the largest.
fn blended(rows: [&Vec<(usize, f64)>; 3]) -> Vec<(usize, f64)> {
    let mut sums: BTreeMap<usize, f64> = BTreeMap::new();
    rows.into_iter().flatten().for_each(|(node, w)| *sums.entry(*node).or_default() += w / 3.0);
    let mut row: Vec<(usize, f64)> = sums.into_iter().collect();
    row.sort_by(|a, b| b.1.total_cmp(&a.1).then(a.0.cmp(&b.0)));
    row.truncate(INFLUENCES);
    row.sort_unstable_by_key(|(node, _)| *node);
    let sum: f64 = row.iter().map(|(_, w)| w).sum();
    row.into_iter().map(|(node, w)| (node, w / sum)).collect()
}

/// The share of muscle that is wished for below each point.
fn muscle_shares(model: &Model, skin: &Skin, settings: &Settings) -> Vec<f64> {
    let patterns: Vec<(wildmatch::WildMatch, f64)> = settings
        .muscle
        .iter()
        .map(|(name, share)| (wildmatch::WildMatch::new_case_insensitive(name), share.clamp(0.05, 0.95)))
        .collect();
    let share = |node: usize| {
        let name = &model.nodes[node].name;
        patterns.iter().find(|(p, _)| p.matches(name)).map_or(muscle::HALF, |(_, share)| *share)
    };
    skin.weights.par_iter().map(|row| row.iter().map(|(node, w)| w * share(*node)).sum()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_prism_keeps_the_eight_largest_weights() {
        // Nodes 0 to 11; node 2 in two rows.
        let rows: [Vec<(usize, f64)>; 3] = [
            vec![(0, 0.4), (1, 0.3), (2, 0.2), (3, 0.1)],
            vec![(4, 0.55), (5, 0.35), (6, 0.06), (7, 0.04)],
            vec![(2, 0.5), (8, 0.25), (9, 0.15), (10, 0.07), (11, 0.03)],
        ];
        let [a, b, c] = &rows;
        let row = blended([a, b, c]);
        assert_eq!(row.iter().map(|(node, _)| *node).collect::<Vec<_>>(), [0, 1, 2, 3, 4, 5, 8, 9]);
        let kept = 3.0 - 0.06 - 0.04 - 0.07 - 0.03;
        assert!((row[2].1 - 0.7 / kept).abs() < 1e-15, "{row:?}");
        assert!((row.iter().map(|(_, w)| w).sum::<f64>() - 1.0).abs() < 1e-15, "{row:?}");
    }
}
