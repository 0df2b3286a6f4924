//! Softness before smoothing: how deep the flesh is, and how far out on a tail or an ear.

use glam::DVec3;

use super::protrusion::{self, Protrusion};
use super::skeleton::{Part, Skeleton};
use super::surface::Surface;

/// Flesh shallower than this share of the character's deepest flesh follows the bone.
const SHALLOW: f64 = 0.3;
/// Least depth that counts as deepest flesh, body sizes.
const LEAST_DEPTH: f64 = 0.04;
/// Along a limb (0 at the trunk, 1 at the fingertips) flesh hardens between these places.
const LIMB: (f64, f64) = (0.4, 0.7);

/// What a point belongs to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Label {
    /// Trunk, limbs, head.
    Body,
    /// [`Skeleton::chains`].
    Chain(usize),
    /// [`Field::protrusions`].
    Protrusion(usize),
}

/// Softness of each point, and what it belongs to.
#[derive(Debug)]
pub(super) struct Field {
    pub(super) soft: Vec<f64>,
    pub(super) label: Vec<Label>,
    pub(super) protrusions: Vec<Protrusion>,
    /// Depth of the deepest flesh, body sizes.
    pub(super) depth: f64,
    /// Share of each point that is on a limb.
    pub(super) limb: Vec<f64>,
}

/// 0 up to `low`, 1 from `high`, without a kink.
pub(super) fn ease(low: f64, high: f64, x: f64) -> f64 {
    let t = ((x - low) / (high - low)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

/// Measures all points.
pub(super) fn measure(surface: &Surface, skeleton: &Skeleton) -> Field {
    let frame = Frame::new(skeleton);
    let depth = deepest(surface, &frame);
    let count = surface.points.len();
    let mut field = Field {
        soft: vec![0.0; count],
        label: vec![Label::Body; count],
        protrusions: Vec::new(),
        depth,
        limb: vec![0.0; count],
    };
    let mut head = vec![false; count];
    for (i, p) in surface.points.iter().enumerate() {
        let (mut rigid, mut best) = (0.0, (0.5, Label::Body));
        for (bone, w) in frame.bones(&surface.weights[i]) {
            match frame.part(bone) {
                Part::Rigid => rigid += w,
                Part::Trunk | Part::Flesh => field.soft[i] += w * frame.flesh(bone, *p, depth),
                Part::Limb => {
                    let length = skeleton.limb_length.get(&bone).copied().unwrap_or(1.0).max(1e-9);
                    let place = skeleton.arc(bone, *p) / length;
                    field.soft[i] += w * frame.flesh(bone, *p, depth) * (1.0 - ease(LIMB.0, LIMB.1, place));
                    field.limb[i] += w;
                }
                Part::Chain(k) => {
                    let place = skeleton.arc(bone, *p) / skeleton.chains[k].length.max(1e-9);
                    field.soft[i] += w * ease(0.0, 0.95, place);
                    let held = frame.chain_share(&surface.weights[i], k);
                    if held > best.0 {
                        best = (held, Label::Chain(k));
                    }
                }
            }
        }
        field.label[i] = best.1;
        head[i] = rigid > 0.5;
    }
    field.protrusions = protrusion::find(surface, &head);
    for (k, protrusion) in field.protrusions.iter().enumerate() {
        for (i, place) in &protrusion.points {
            let soft = ease(0.0, 0.95, *place);
            if soft > field.soft[*i] {
                field.soft[*i] = soft;
            }
            field.label[*i] = Label::Protrusion(k);
        }
    }
    field
}

/// Bones with the segments that flesh is measured from.
struct Frame<'a> {
    skeleton: &'a Skeleton,
    /// Bone that answers for each bone: itself, or the one above flesh controls.
    owner: Vec<usize>,
    segments: Vec<Vec<(DVec3, DVec3)>>,
}

impl<'a> Frame<'a> {
    fn new(skeleton: &'a Skeleton) -> Self {
        let bones = &skeleton.bones;
        let mut owner: Vec<usize> = (0..bones.len()).collect();
        for b in 0..bones.len() {
            if bones[b].part == Part::Flesh {
                owner[b] = bones[b].parent.map_or(b, |p| owner[p]);
            }
        }
        let segments = bones.iter().map(|bone| {
            let solid = bone.children.iter().filter(|c| bones[**c].part != Part::Flesh);
            let mut out: Vec<_> = solid.map(|c| (bone.position, bones[*c].position)).collect();
            if out.is_empty() {
                out.push((bone.position, bone.tip));
            }
            // A parent that moves nothing (a root on the floor) is no bone.
            let above = bone.parent.map(|p| &bones[p]).filter(|p| p.own > 0.02 * bone.own);
            out.extend(above.map(|p| (p.position, bone.position)));
            out
        });
        Self { skeleton, owner, segments: segments.collect() }
    }

    fn bones<'b>(&'b self, row: &'b [(usize, f64)]) -> impl Iterator<Item = (usize, f64)> + 'b {
        row.iter().filter_map(|(node, w)| self.skeleton.bone_of.get(node).map(|b| (self.owner[*b], *w)))
    }

    fn part(&self, bone: usize) -> Part {
        self.skeleton.bones[bone].part
    }

    fn chain_share(&self, row: &[(usize, f64)], chain: usize) -> f64 {
        self.bones(row).filter(|(b, _)| self.part(*b) == Part::Chain(chain)).map(|(_, w)| w).sum()
    }

    fn distance(&self, bone: usize, p: DVec3) -> f64 {
        let to = |(a, b): &(DVec3, DVec3)| {
            let along = *b - *a;
            let t = (along.dot(p - *a) / along.length_squared().max(1e-18)).clamp(0.0, 1.0);
            p.distance(*a + along * t)
        };
        self.segments[bone].iter().map(to).fold(f64::INFINITY, f64::min)
    }

    fn flesh(&self, bone: usize, p: DVec3, depth: f64) -> f64 {
        ease(SHALLOW * depth, depth, self.distance(bone, p))
    }
}

/// Depth that a tenth of the trunk's skin exceeds.
fn deepest(surface: &Surface, frame: &Frame<'_>) -> f64 {
    let mut depths = Vec::new();
    for (i, p) in surface.points.iter().enumerate() {
        let of_trunk = |b: usize| matches!(frame.part(b), Part::Trunk | Part::Flesh);
        let trunk = frame.bones(&surface.weights[i]).filter(|(b, _)| of_trunk(*b));
        let (depth, share) = trunk.fold((0.0, 0.0), |(d, s), (b, w)| (d + w * frame.distance(b, *p), s + w));
        if share > 0.5 {
            depths.push((depth / share, surface.area[i]));
        }
    }
    depths.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut left = depths.iter().map(|(_, area)| area).sum::<f64>() * 0.9;
    let reached = depths.iter().find(|(_, area)| {
        left -= area;
        left <= 0.0
    });
    reached.map_or(LEAST_DEPTH, |(depth, _)| depth.max(LEAST_DEPTH))
}
