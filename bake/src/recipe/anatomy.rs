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
const OFF_BASE: f64 = 0.2;
/// Shortest ear or tail, body sizes.
const SHORTEST: f64 = 0.03;
/// Smallest ratio of length to width of an ear or tail.
const ELONGATED: f64 = 0.6;

/// The same for a head.
const HEAD_OFF_BASE: f64 = 0.19;
/// A branch that starts farther than this from the joint above (body sizes) is no control inside the flesh.
const CONTROL: f64 = 0.1;
/// A branch's skin is what it holds by half (weights are rounded in files).
const HALF: f64 = 0.499;
/// An ear's middle is above the head's by this share of the head's reach.
const EAR_HEIGHT: f64 = 0.2;
/// Joints of one skull are nearer than this, body sizes.
const SKULL: f64 = 0.065;

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
    skeleton.front = front(surface);
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
        set_limb(skeleton, surface, limb, branches[limb].lowest < GROUND);
    }
    if skeleton.bones.len() == 1 {
        return set_chain(skeleton, surface, top, false);
    }
    let ends = ends(skeleton, &branches, top, &limbs);
    let head = head(skeleton, &branches, &ends, &limbs);
    for end in ends {
        let branch = branches[end];
        let aside = branch.middle[symmetry.axis].abs() > 0.05;
        if Some(end) == head {
            set_head(skeleton, surface, &branches, end);
        } else if aside && branch.reach > ARM {
            set_limb(skeleton, surface, end, branch.lowest < GROUND);
        } else if branch.elongation() > ELONGATED && (branch.protrudes() || limbs.is_empty()) {
            set_chain(skeleton, surface, end, false);
        } else if skeleton.start(end) < CONTROL {
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

/// The end of the largest girth that sticks out; one nearer the front is preferred.
fn head(skeleton: &Skeleton, branches: &[Branch], ends: &[usize], limbs: &[usize]) -> Option<usize> {
    let limb = skeleton.bones[*limbs.first()?].position;
    let score = |b: usize| {
        let ahead = (skeleton.bones[b].tip.z - limb.z) * skeleton.front > 0.05;
        branches[b].area / branches[b].reach.max(1e-9) * if ahead { 1.5 } else { 1.0 }
    };
    let sticking = ends.iter().copied().filter(|b| branches[*b].off_base > HEAD_OFF_BASE);
    sticking.max_by(|x, y| score(*x).total_cmp(&score(*y)).then(y.cmp(x)))
}

/// Neck and head are rigid, but for ears.
fn set_head(skeleton: &mut Skeleton, surface: &Surface, branches: &[Branch], end: usize) {
    set(skeleton, end, Part::Rigid);
    let Some(skull) = skull(skeleton, branches, end) else { return };
    // Ears with joints of their own: pairs that sit high.
    for b in skeleton.subtree(skull).into_iter().skip(1) {
        let branch = branches[b];
        let high = branch.middle.y - branches[end].middle.y > EAR_HEIGHT * branches[end].reach;
        let ear = branch.paired && branch.joints > 1 && branch.reach > SHORTEST && high;
        if ear && skeleton.bones[b].part == Part::Rigid {
            set_chain(skeleton, surface, b, true);
        }
    }
    let rigid = |b: &usize| skeleton.bones[*b].part == Part::Rigid;
    skeleton.skull = skeleton.subtree(skull).into_iter().filter(rigid).collect();
}

/// The first bone of the skull: the one that pairs (ears, eyes) hang on, or the last bulky one.
fn skull(skeleton: &Skeleton, branches: &[Branch], end: usize) -> Option<usize> {
    let inside = skeleton.subtree(end);
    let forks = |b: &usize| skeleton.bones[*b].children.iter().any(|c| branches[*c].paired);
    if let Some(fork) = inside.iter().copied().find(forks) {
        return Some(fork);
    }
    let most = inside.iter().map(|b| skeleton.bones[*b].own).fold(0.0, f64::max);
    let bulky = inside.iter().copied().filter(|b| skeleton.bones[*b].own >= 0.5 * most);
    let mut skull = bulky.max_by_key(|b| (skeleton.bones[*b].depth, *b))?;
    while let Some(p) = skeleton.bones[skull].parent.filter(|p| inside.contains(p)) {
        if skeleton.start(skull) > SKULL || skeleton.bones[p].own < 0.3 * skeleton.bones[skull].own {
            break;
        }
        skull = p;
    }
    Some(skull)
}

fn set_limb(skeleton: &mut Skeleton, surface: &Surface, limb: usize, leg: bool) {
    set(skeleton, limb, Part::Limb);
    let parent = skeleton.bones[limb].parent.unwrap_or(limb);
    let lowest = (0..skeleton.bones.len()).find(|b| skeleton.bones[*b].seat);
    skeleton.bones[parent].seat |= leg && lowest.is_none_or(|b| b == parent);
    let base = skeleton.start(limb);
    let length = skeleton.measure(surface, limb, base);
    for b in skeleton.subtree(limb) {
        skeleton.limb_length.insert(b, length);
    }
}

fn set_chain(skeleton: &mut Skeleton, surface: &Surface, root: usize, ear: bool) {
    let index = skeleton.chains.len();
    set(skeleton, root, Part::Chain(index));
    let length = skeleton.measure(surface, root, 0.0);
    skeleton.chains.push(Chain { length, ear });
}

/// Where the character looks, +1 along z or -1: where its feet point; +1, as glTF has it, where that is not clear.
fn front(surface: &Surface) -> f64 {
    let height = surface.points.iter().map(|p| p.y).fold(f64::MIN_POSITIVE, f64::max);
    let mean = |from: f64, to: f64| {
        let slice =
            surface.points.iter().zip(&surface.area).filter(|(p, _)| (from..to).contains(&(p.y / height)));
        let (sum, area) = slice.fold((0.0, 1e-12), |(sum, all), (p, area)| (sum + p.z * area, all + area));
        sum / area
    };
    if mean(0.0, 0.04) < mean(0.07, 0.2) - 0.004 { -1.0 } else { 1.0 }
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
            let joint = symmetry.mirrored(skeleton.bones[b].tip - skeleton.bones[b].position);
            let turned = joint.distance(skeleton.bones[*s].tip - skeleton.bones[*s].position) < 0.03;
            *s != b
                && (alike && image.distance(other.middle) < 0.03
                    || turned && image.distance(other.middle) < 0.06)
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
        if share[i] > HALF {
            branch.lowest = f64::min(branch.lowest, p.y / height);
            for (j, _) in surface.links[i].iter().filter(|(j, _)| share[*j] <= HALF) {
                base += (*p + surface.points[*j]) / 2.0;
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
    let far = surface.points.iter().zip(&share).filter(|(_, s)| **s > HALF).map(|(p, _)| p.distance(base));
    branch.reach = far.fold(0.0, f64::max);
    branch.off_base = middle.distance(base) / branch.reach.max(1e-9);
    let last = inside.iter().map(|b| skeleton.bones[*b].depth).max().unwrap_or(0);
    branch.joints = last + 1 - skeleton.bones[bone].depth;
    branch
}
