//! Softness before smoothing: how deep the flesh is, and how far out on a tail or an ear.

use glam::DVec3;

use super::mirror::Symmetry;
use super::protrusion::{self, Protrusion};
use super::skeleton::{Part, Skeleton};
use super::surface::Surface;

/// Flesh shallower than this share of the character's deepest flesh follows the bone.
const SHALLOW: f64 = 0.3;
/// Least depth that counts as deepest flesh, body sizes.
const LEAST_DEPTH: f64 = 0.04;
/// Along a limb (0 at the trunk, 1 at the fingertips) flesh hardens between these places.
const LIMB: (f64, f64) = (0.3, 0.8);
/// Softness of the back, share of the belly's; of the rump.
const BACK: (f64, f64) = (0.3, 0.8);

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
pub(super) fn measure(surface: &Surface, skeleton: &Skeleton, symmetry: &Symmetry) -> Field {
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
    let skull = skeleton.share(surface, &skeleton.skull);
    let head: Vec<bool> = skull.iter().map(|s| *s > 0.5).collect();
    for (i, p) in surface.points.iter().enumerate() {
        let (mut body, mut best) = (0.0, (0.5, Label::Body));
        for (bone, w) in frame.bones(&surface.weights[i]) {
            match frame.part(bone) {
                Part::Rigid => {}
                Part::Trunk | Part::Flesh => body += w * frame.flesh(bone, *p, depth),
                Part::Limb => {
                    let length = skeleton.limb_length.get(&bone).copied().unwrap_or(1.0).max(1e-9);
                    let place = skeleton.arc(bone, *p) / length;
                    body += w * frame.flesh(bone, *p, depth) * (1.0 - ease(LIMB.0, LIMB.1, place));
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
        // Tails are as soft on all sides, bodies are not.
        field.soft[i] += body * frame.side(*p);
    }
    field.protrusions = protrusion::find(surface, symmetry, &head);
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
        self.nearest(bone, p).0
    }

    /// Distance from a bone, and the way from it.
    fn nearest(&self, bone: usize, p: DVec3) -> (f64, DVec3) {
        let to = |(a, b): &(DVec3, DVec3)| {
            let along = *b - *a;
            let t = (along.dot(p - *a) / along.length_squared().max(1e-18)).clamp(0.0, 1.0);
            let way = p - (*a + along * t);
            (way.length(), way)
        };
        let ways = self.segments[bone].iter().map(to);
        ways.min_by(|a, b| a.0.total_cmp(&b.0)).unwrap_or((f64::INFINITY, DVec3::ZERO))
    }

    /// Bellies are softer than backs: 1 on the side of the belly (below a level spine, in front of an upright one).
    fn side(&self, p: DVec3) -> f64 {
        let bones = &self.skeleton.bones;
        let trunk = (0..bones.len()).filter(|b| bones[*b].part == Part::Trunk);
        let near = trunk.map(|b| (self.nearest(b, p), b)).min_by(|a, b| a.0.0.total_cmp(&b.0.0));
        let Some(((_, way), bone)) = near else { return 1.0 };
        let spine = self.spine(bone);
        let belly = DVec3::new(0.0, -1.0, self.skeleton.front);
        let belly = (belly - spine * belly.dot(spine)).normalize_or_zero();
        let back = if bones[bone].seat { BACK.1 } else { BACK.0 };
        let side = (way - spine * way.dot(spine)).normalize_or_zero().dot(belly);
        back + (1.0 - back) * ease(-0.7, 0.5, side)
    }

    /// Direction of the trunk at a bone: from the bone above to the one below.
    fn spine(&self, bone: usize) -> DVec3 {
        let bones = &self.skeleton.bones;
        let below =
            bones[bone].children.iter().filter(|c| matches!(bones[**c].part, Part::Trunk | Part::Rigid));
        let next = below.max_by(|a, b| bones[**a].below.total_cmp(&bones[**b].below).then(b.cmp(a)));
        let above =
            bones[bone].parent.map_or(bone, |p| if bones[p].own > 0.02 * bones[bone].own { p } else { bone });
        (bones[next.copied().unwrap_or(bone)].position - bones[above].position).normalize_or_zero()
    }

    fn flesh(&self, bone: usize, p: DVec3, depth: f64) -> f64 {
        if self.skeleton.limb_length.is_empty() && !self.skeleton.chains.is_empty() {
            return 0.0; // A tail alone: the root holds it.
        }
        ease(SHALLOW * depth, depth, self.distance(bone, p))
    }
}

/// Depth that a tenth of the trunk's skin exceeds; backs count less, as for softness.
fn deepest(surface: &Surface, frame: &Frame<'_>) -> f64 {
    let mut depths = Vec::new();
    for (i, p) in surface.points.iter().enumerate() {
        let of_trunk = |b: usize| matches!(frame.part(b), Part::Trunk | Part::Flesh);
        let trunk = frame.bones(&surface.weights[i]).filter(|(b, _)| of_trunk(*b));
        let (depth, share) = trunk.fold((0.0, 0.0), |(d, s), (b, w)| (d + w * frame.distance(b, *p), s + w));
        if share > 0.5 {
            depths.push((depth / share * frame.side(*p), surface.area[i]));
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
