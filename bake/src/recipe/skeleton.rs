//! The joints that move skin, as bones with a part to play: trunk, limb, rigid end, chain of an appendage.

use std::collections::BTreeMap;

use glam::DVec3;

use super::surface::Surface;
use crate::Model;

/// What a bone is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Part {
    /// Spine, pelvis, neck: flesh hangs on it.
    Trunk,
    /// Arm or leg: softer near the trunk, rigid at the end.
    Limb,
    /// Head, feet, jaw, eyes.
    Rigid,
    /// Tail, ear: soft towards the tip; index into [`Skeleton::chains`].
    Chain(usize),
    /// A control inside the flesh (belly, breast): belongs to the bone above.
    Flesh,
}

/// A joint that moves skin, or where such joints branch.
#[derive(Clone, Debug)]
pub(super) struct Bone {
    pub(super) parent: Option<usize>,
    pub(super) children: Vec<usize>,
    /// Joint's rest position, body sizes.
    pub(super) position: DVec3,
    pub(super) part: Part,
    /// Skin area that the joint moves.
    pub(super) own: f64,
    /// Skin area that the joint and its descendants move.
    pub(super) below: f64,
    /// Path length from where its limb or chain is attached, body sizes.
    pub(super) along: f64,
    /// Where the bone points to: its heaviest child, or the farthest skin of a last joint.
    pub(super) tip: DVec3,
    /// The pelvis: the first joint that legs are attached to.
    pub(super) seat: bool,
    /// Joints from the top of the skeleton.
    pub(super) depth: usize,
}

/// An appendage moved by joints of its own.
#[derive(Clone, Copy, Debug)]
pub(super) struct Chain {
    /// Longest way along the chain to its skin, body sizes.
    pub(super) length: f64,
    /// Hangs on the head and has a twin.
    pub(super) ear: bool,
}

/// Bones, parents before children.
#[derive(Debug, Default)]
pub(super) struct Skeleton {
    pub(super) bones: Vec<Bone>,
    pub(super) chains: Vec<Chain>,
    /// Bone of each node that moves skin.
    pub(super) bone_of: BTreeMap<usize, usize>,
    /// Length of the limb of each limb bone.
    pub(super) limb_length: BTreeMap<usize, f64>,
    /// Bones of the head that carry the skull.
    pub(super) skull: Vec<usize>,
    /// Where the character looks: the sign of z.
    pub(super) front: f64,
}

impl Skeleton {
    /// The bones of a model, all [`Part::Trunk`] so far.
    pub(super) fn new(model: &Model, surface: &Surface) -> Self {
        let own = own_areas(model, surface);
        let depth = depths(model);
        let mut order: Vec<usize> = (0..model.nodes.len()).collect();
        order.sort_by_key(|n| (depth[*n], *n));
        let kept = kept_nodes(model, &own, &order);
        let rest = model.rest_transforms();
        let mut skeleton = Self::default();
        for node in order.into_iter().filter(|n| kept[*n]) {
            let mut above = model.nodes[node].parent;
            while let Some(n) = above.filter(|n| !kept[*n]) {
                above = model.nodes[n].parent.filter(|p| depth[*p] < depth[n]);
            }
            let parent = above.and_then(|n| skeleton.bone_of.get(&n).copied());
            let index = skeleton.bones.len();
            let depth = parent.map_or(0, |p| skeleton.bones[p].depth + 1);
            if let Some(p) = parent {
                skeleton.bones[p].children.push(index);
            }
            let position = (rest[node].w_axis.truncate() - surface.corner) / surface.size;
            skeleton.bone_of.insert(node, index);
            skeleton.bones.push(Bone {
                parent,
                children: Vec::new(),
                position,
                part: Part::Trunk,
                own: own[node],
                below: own[node],
                along: 0.0,
                tip: position,
                seat: false,
                depth,
            });
        }
        for b in (0..skeleton.bones.len()).rev() {
            if let Some(p) = skeleton.bones[b].parent {
                skeleton.bones[p].below += skeleton.bones[b].below;
            }
        }
        skeleton.set_tips(surface);
        skeleton
    }

    /// Distance of a joint from the one above, 0 at the top.
    pub(super) fn start(&self, bone: usize) -> f64 {
        let above = self.bones[bone].parent.unwrap_or(bone);
        self.bones[above].position.distance(self.bones[bone].position)
    }

    /// A bone and all below it, in order.
    pub(super) fn subtree(&self, bone: usize) -> Vec<usize> {
        let mut inside = vec![false; self.bones.len()];
        inside[bone] = true;
        for b in bone + 1..self.bones.len() {
            inside[b] = self.bones[b].parent.is_some_and(|p| inside[p]);
        }
        (0..self.bones.len()).filter(|b| inside[*b]).collect()
    }

    /// Share of each point's weight that the given bones hold.
    pub(super) fn share(&self, surface: &Surface, bones: &[usize]) -> Vec<f64> {
        let mut inside = vec![false; self.bones.len()];
        bones.iter().for_each(|b| inside[*b] = true);
        let held = |row: &Vec<(usize, f64)>| {
            let of = row.iter().filter(|(n, _)| self.bone_of.get(n).is_some_and(|b| inside[*b]));
            of.map(|(_, w)| *w).sum()
        };
        surface.weights.iter().map(held).collect()
    }

    /// Way from the attachment of a limb or chain to where `p` is beside its bone.
    pub(super) fn arc(&self, bone: usize, p: DVec3) -> f64 {
        let bone = &self.bones[bone];
        let direction = (bone.tip - bone.position).normalize_or_zero();
        bone.along + direction.dot(p - bone.position).max(0.0)
    }

    /// Sets `along` in a subtree that starts with `base` at its first bone; returns the longest way to its skin.
    pub(super) fn measure(&mut self, surface: &Surface, root: usize, base: f64) -> f64 {
        let inside = self.subtree(root);
        for &b in &inside {
            let parent = self.bones[b].parent.filter(|_| b != root);
            let way =
                parent.map(|p| self.bones[p].along + self.bones[p].position.distance(self.bones[b].position));
            self.bones[b].along = way.unwrap_or(base);
        }
        let mut longest = base;
        for (p, row) in surface.points.iter().zip(&surface.weights) {
            let main = row.iter().filter(|(_, w)| *w >= 0.5).filter_map(|(n, _)| self.bone_of.get(n));
            for b in main.filter(|b| inside.binary_search(b).is_ok()) {
                longest = f64::max(longest, self.arc(*b, *p));
            }
        }
        longest
    }

    fn set_tips(&mut self, surface: &Surface) {
        let mut farthest: Vec<(f64, DVec3)> = self.bones.iter().map(|b| (0.0, b.position)).collect();
        for (p, row) in surface.points.iter().zip(&surface.weights) {
            for b in row.iter().filter(|(_, w)| *w >= 0.5).filter_map(|(n, _)| self.bone_of.get(n)) {
                let distance = p.distance(self.bones[*b].position);
                if distance > farthest[*b].0 {
                    farthest[*b] = (distance, *p);
                }
            }
        }
        for (b, (_, skin)) in farthest.into_iter().enumerate() {
            let heaviest = self.bones[b]
                .children
                .iter()
                .max_by(|x, y| self.bones[**x].below.total_cmp(&self.bones[**y].below).then(y.cmp(x)));
            self.bones[b].tip = heaviest.map_or(skin, |c| self.bones[*c].position);
        }
    }
}

fn own_areas(model: &Model, surface: &Surface) -> Vec<f64> {
    let mut own = vec![0.0; model.nodes.len()];
    for (row, area) in surface.weights.iter().zip(&surface.area) {
        for (node, weight) in row {
            // Points of no area count a little, so that meshes without triangles have bones too.
            own[*node] += weight * (area + 1e-12);
        }
    }
    own
}

fn depths(model: &Model) -> Vec<usize> {
    let depth = |mut node: usize| {
        let mut depth = 0;
        while let Some(parent) = model.nodes[node].parent.filter(|_| depth < model.nodes.len()) {
            node = parent;
            depth += 1;
        }
        depth
    };
    (0..model.nodes.len()).map(depth).collect()
}

/// Nodes that move skin, and those where two such branches meet.
fn kept_nodes(model: &Model, own: &[f64], order: &[usize]) -> Vec<bool> {
    let mut branches = vec![0_usize; model.nodes.len()];
    let mut moves = vec![false; model.nodes.len()];
    for &node in order.iter().rev() {
        moves[node] = own[node] > 0.0 || branches[node] > 0;
        if let Some(parent) = model.nodes[node].parent.filter(|_| moves[node]) {
            branches[parent] += 1;
        }
    }
    (0..own.len()).map(|n| own[n] > 0.0 || branches[n] > 1).collect()
}
