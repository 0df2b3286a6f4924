//! Bones of a character in model space, for simulation cages.

use glam::DVec3;

use super::anatomy;
use super::mirror::Symmetry;
use super::skeleton::{Part, Skeleton};
use super::surface::Surface;
use crate::{Error, Model};

/// Skin that a bone moves by this share is its own.
const OWN: f64 = 0.5;

/// A joint that moves skin, and the segments of bone that go with it.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Bone {
    /// Its node.
    pub(crate) node: u32,
    /// From the joint to those below it, or to the middle of a last joint's skin; model units.
    pub(crate) segments: Vec<[DVec3; 2]>,
    /// From the joint to its farthest skin, or to the heaviest joint below it.
    pub(crate) whole: [DVec3; 2],
    /// Head, feet, jaw, eyes: no flesh unless there is softness.
    pub(crate) rigid: bool,
    /// The node of the bone that answers for it: its own, or for a control inside the flesh the one above.
    pub(crate) owner: u32,
}

/// Bones of a model, parents before children.
pub(crate) fn bones(model: &Model) -> Result<Vec<Bone>, Error> {
    let surface = Surface::new(model)?;
    let symmetry = Symmetry::new(&surface);
    let mut skeleton = Skeleton::new(model, &surface);
    anatomy::classify(&mut skeleton, &surface, &symmetry);
    let mut nodes = vec![0_u32; skeleton.bones.len()];
    skeleton.bone_of.iter().for_each(|(node, b)| nodes[*b] = u32::try_from(*node).unwrap_or(u32::MAX));
    let place = |p: DVec3| surface.corner + p * surface.size;
    let mut owners = nodes.clone();
    let mut out = Vec::new();
    for (b, bone) in skeleton.bones.iter().enumerate() {
        if bone.part == Part::Flesh {
            owners[b] = bone.parent.map_or(owners[b], |p| owners[p]);
        }
        let solid = bone.children.iter().filter(|c| skeleton.bones[**c].part != Part::Flesh);
        let mut segments: Vec<_> =
            solid.map(|c| [place(bone.position), place(skeleton.bones[*c].position)]).collect();
        if segments.is_empty() {
            segments.push([place(bone.position), place(middle(&surface, nodes[b]).unwrap_or(bone.tip))]);
        }
        let whole = [place(bone.position), place(bone.tip)];
        out.push(Bone { whole, node: nodes[b], segments, rigid: bone.part == Part::Rigid, owner: owners[b] });
    }
    Ok(out)
}

/// Middle of the skin of a node, by area; body sizes.
fn middle(surface: &Surface, node: u32) -> Option<DVec3> {
    let (mut sum, mut total) = (DVec3::ZERO, 0.0);
    for (i, row) in surface.weights.iter().enumerate() {
        if row.iter().any(|(n, w)| *n == node as usize && *w >= OWN) {
            sum += surface.points[i] * surface.area[i];
            total += surface.area[i];
        }
    }
    (total > 0.0).then(|| sum / total)
}
