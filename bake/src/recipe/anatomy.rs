//! Which bones are trunk, limbs, head, tail and ears: told from symmetry, reach and shape, not from names.

use glam::DVec3;

use super::mirror::Symmetry;
use super::skeleton::{Chain, Part, Skeleton};
use super::surface::Surface;

/// Shortest arm, body sizes from where it is attached.
const ARM: f64 = 0.12;
/// A paired branch that reaches below this share of the height is a leg.
const GROUND: f64 = 0.08;
/// Share of its own reach by which a branch's middle must be off its base to be an extremity.
const OFF_BASE: f64 = 0.3;
/// Shortest ear or tail, body sizes.
const SHORTEST: f64 = 0.03;
/// Smallest ratio of length to width of an ear or tail.
const ELONGATED: f64 = 0.8;

/// What is known of a branch of the skeleton.
#[derive(Clone, Copy, Debug, Default)]
struct Branch {
    area: f64,
    /// Middle of its skin, in the centered positions of the symmetry.
    middle: DVec3,
    /// Lowest skin, share of the height.
    lowest: f64,
    /// Farthest skin from the base.
    reach: f64,
    /// Its middle's distance from the base, share of the reach.
    off_base: f64,
    paired: bool,
    /// Joints from its first to its last.
    joints: usize,
}

impl Branch {
    fn protrudes(&self) -> bool {
        self.off_base > OFF_BASE && self.reach > SHORTEST
    }

    /// Length by width of a strip of the same area (both sides).
    fn elongation(&self) -> f64 {
        2.0 * self.reach * self.reach / self.area.max(1e-12)
    }
}

/// Names the part of every bone.
pub(super) fn classify(skeleton: &mut Skeleton, surface: &Surface, symmetry: &Symmetry) {
    let branches = survey(skeleton, surface, symmetry);
    let tops: Vec<usize> =
        (0..skeleton.bones.len()).filter(|b| skeleton.bones[*b].parent.is_none()).collect();
    let heaviest = |x: &&usize, y: &&usize| {
        skeleton.bones[**x].below.total_cmp(&skeleton.bones[**y].below).then(y.cmp(x))
    };
    let Some(&top) = tops.iter().max_by(heaviest) else { return };
    // Joints beside the main skeleton are usually goals that feet are bound to.
    for other in tops.into_iter().filter(|t| *t != top) {
        set(skeleton, other, Part::Rigid);
    }
    let limbs = limbs(skeleton, &branches, top);
    for &limb in &limbs {
        set(skeleton, limb, Part::Limb);
        let parent = skeleton.bones[limb].parent.unwrap_or(limb);
        let base = skeleton.bones[parent].position.distance(skeleton.bones[limb].position);
        let length = skeleton.measure(surface, limb, base);
        for b in skeleton.subtree(limb) {
            skeleton.limb_length.insert(b, length);
        }
    }
    if skeleton.bones.len() == 1 {
        return set_chain(skeleton, surface, top, false);
    }
    let ends = ends(skeleton, &branches, top, &limbs);
    let head = head(skeleton, &ends, &limbs);
    for end in ends {
        let branch = branches[end];
        if Some(end) == head {
            set_head(skeleton, surface, &branches, end);
        } else if branch.protrudes() && branch.elongation() > ELONGATED {
            set_chain(skeleton, surface, end, false);
        } else {
            set(skeleton, end, Part::Flesh);
        }
    }
}

/// Arms and legs: paired branches that reach the ground, or far, within two places along the spine.
fn limbs(skeleton: &Skeleton, branches: &[Branch], top: usize) -> Vec<usize> {
    let mut limbs: Vec<usize> = Vec::new();
    let mut places: Vec<usize> = Vec::new();
    for b in skeleton.subtree(top).into_iter().skip(1) {
        let Some(parent) = skeleton.bones[b].parent else { continue };
        if limbs.iter().any(|l| skeleton.subtree(*l).contains(&b)) || !branches[b].paired {
            continue;
        }
        let branch = branches[b];
        let leg = branch.lowest < GROUND && branch.reach > SHORTEST;
        let arm = branch.reach > ARM && branch.joints > 1 && (places.len() < 2 || places.contains(&parent));
        if leg || arm {
            limbs.push(b);
            if !places.contains(&parent) {
                places.push(parent);
            }
        }
    }
    limbs
}

/// Branches of the trunk that hold no limb: head, tail, and controls inside the flesh.
fn ends(skeleton: &Skeleton, branches: &[Branch], top: usize, limbs: &[usize]) -> Vec<usize> {
    let mut trunk = vec![false; skeleton.bones.len()];
    trunk[top] = true;
    for &limb in limbs {
        let mut above = skeleton.bones[limb].parent;
        while let Some(b) = above {
            trunk[b] = true;
            above = skeleton.bones[b].parent;
        }
    }
    let mut ends: Vec<usize> = Vec::new();
    for b in skeleton.subtree(top) {
        let hangs = skeleton.bones[b].parent.is_some_and(|p| trunk[p]);
        if hangs && !trunk[b] && !limbs.contains(&b) && branches[b].area > 0.0 {
            ends.push(b);
        }
    }
    ends
}

/// The bulkiest end; one nearer the front and farther from the top is preferred.
fn head(skeleton: &Skeleton, ends: &[usize], limbs: &[usize]) -> Option<usize> {
    if limbs.is_empty() {
        return None;
    }
    let height = |b: usize| skeleton.bones[b].tip.y;
    let score = |b: usize| {
        let inside = skeleton.subtree(b);
        let deepest = inside.iter().map(|b| skeleton.bones[*b].depth).max().unwrap_or(0);
        let front = skeleton.bones[b].tip.z - skeleton.bones[limbs[0]].position.z;
        #[expect(clippy::cast_precision_loss, reason = "a small count")]
        let depth = 1.0 + deepest as f64 / 4.0;
        skeleton.bones[b].below * depth * if front > 0.05 { 1.5 } else { 1.0 } * (0.5 + height(b))
    };
    ends.iter().copied().max_by(|x, y| score(*x).total_cmp(&score(*y)).then(y.cmp(x)))
}

/// Neck, skull, and what hangs on it.
fn set_head(skeleton: &mut Skeleton, surface: &Surface, branches: &[Branch], end: usize) {
    let inside = skeleton.subtree(end);
    let skull = inside
        .iter()
        .copied()
        .max_by(|x, y| skeleton.bones[*x].own.total_cmp(&skeleton.bones[*y].own).then(y.cmp(x)));
    let Some(mut skull) = skull else { return };
    let least = 0.2 * skeleton.bones[skull].own;
    while let Some(p) = skeleton.bones[skull].parent.filter(|p| *p >= end && skeleton.bones[*p].own > least) {
        skull = p;
    }
    set(skeleton, skull, Part::Rigid);
    for b in skeleton.subtree(skull).into_iter().skip(1) {
        let branch = branches[b];
        let ear = branch.paired && branch.elongation() > ELONGATED;
        let trunk = !branch.paired && branch.joints > 2 && branch.elongation() > 2.5 * ELONGATED;
        if branch.protrudes() && (ear || trunk) && skeleton.bones[b].part == Part::Rigid {
            set_chain(skeleton, surface, b, ear);
        }
    }
}

fn set_chain(skeleton: &mut Skeleton, surface: &Surface, root: usize, ear: bool) {
    let index = skeleton.chains.len();
    set(skeleton, root, Part::Chain(index));
    let length = skeleton.measure(surface, root, 0.0);
    skeleton.chains.push(Chain { root, ear, length });
}

fn set(skeleton: &mut Skeleton, root: usize, part: Part) {
    for b in skeleton.subtree(root) {
        skeleton.bones[b].part = part;
    }
}

/// Measures the branch below every bone.
fn survey(skeleton: &Skeleton, surface: &Surface, symmetry: &Symmetry) -> Vec<Branch> {
    let mut branches: Vec<Branch> =
        (0..skeleton.bones.len()).map(|b| measure(skeleton, surface, symmetry, b)).collect();
    for b in 0..branches.len() {
        let siblings = skeleton.bones[b].parent.map_or(&[][..], |p| &skeleton.bones[p].children);
        let image = symmetry.mirrored(branches[b].middle);
        let twin = siblings.iter().any(|s| {
            let other = branches[*s];
            let alike = other.area > 0.6 * branches[b].area && branches[b].area > 0.6 * other.area;
            *s != b && alike && image.distance(other.middle) < 0.03
        });
        branches[b].paired = twin && branches[b].middle[symmetry.axis].abs() > 0.01;
    }
    branches
}

fn measure(skeleton: &Skeleton, surface: &Surface, symmetry: &Symmetry, bone: usize) -> Branch {
    let inside = skeleton.subtree(bone);
    let share = skeleton.share(surface, &inside);
    let mut branch = Branch { lowest: 1.0, ..Branch::default() };
    let (mut middle, mut base, mut rim) = (DVec3::ZERO, DVec3::ZERO, 0.0);
    let height = surface.points.iter().map(|p| p.y).fold(f64::MIN_POSITIVE, f64::max);
    for (i, p) in surface.points.iter().enumerate() {
        let area = (surface.area[i] + 1e-12) * share[i];
        branch.area += area;
        branch.middle += symmetry.centered[i] * area;
        middle += *p * area;
        if share[i] > 0.5 {
            branch.lowest = f64::min(branch.lowest, p.y / height);
            if surface.links[i].iter().any(|(j, _)| share[*j] <= 0.5) {
                base += *p;
                rim += 1.0;
            }
        }
    }
    if branch.area <= 0.0 {
        return branch;
    }
    branch.middle /= branch.area;
    middle /= branch.area;
    base = if rim > 0.0 { base / rim } else { skeleton.bones[bone].position };
    let far = surface.points.iter().zip(&share).filter(|(_, s)| **s > 0.5).map(|(p, _)| p.distance(base));
    branch.reach = far.fold(0.0, f64::max);
    branch.off_base = middle.distance(base) / branch.reach.max(1e-9);
    let last = inside.iter().map(|b| skeleton.bones[*b].depth).max().unwrap_or(0);
    branch.joints = last + 1 - skeleton.bones[bone].depth;
    branch
}
