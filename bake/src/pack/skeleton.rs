//! Nodes above the joints, parents first, and the clips that move them.

use super::narrow;
use super::writer::{AssetWriter, padded};
use crate::Model;
use crate::model::{Interpolation, Property};
use sinew::Affine;
use sinew::asset::Section;
use sinew::asset::layout::NO_PARENT;
use sinew::kernel::tiny::flush;

/// The skeleton as the asset stores it.
#[derive(Debug, Default)]
pub(super) struct Skeleton {
    pub(super) joint_from_bind: Vec<Affine>,
    pub(super) joint_node: Vec<u32>,
    pub(super) parents: Vec<u32>,
    node_index: Vec<u32>,
    rest: Vec<[f32; 10]>,
    pub(super) clips: Vec<[u32; 4]>,
    names: Vec<[u8; 32]>,
    pub(super) channels: Vec<[u32; 6]>,
    pub(super) times: Vec<f32>,
    pub(super) values: Vec<f32>,
}

fn count(n: usize) -> u32 {
    u32::try_from(n).unwrap_or(u32::MAX)
}

impl Skeleton {
    /// Collects joints, their nodes and those above, and the clips.
    pub(super) fn new(model: &Model) -> Self {
        let order = needed_nodes(model);
        let mut place = vec![None; model.nodes.len()];
        for (i, node) in order.iter().enumerate() {
            place[*node] = Some(i);
        }
        let mut out = Self::default();
        for joint in &model.joints {
            let columns = joint.joint_from_bind.to_cols_array_2d();
            out.joint_from_bind.push(columns.map(|[x, y, z, _]| [x, y, z].map(narrow)));
            out.joint_node.push(place[joint.node].map_or(0, count));
        }
        for node in &order {
            let n = &model.nodes[*node];
            let parent = n.parent.and_then(|p| place[p]);
            out.parents.push(parent.map_or(NO_PARENT, count));
            out.node_index.push(count(*node));
            let [t, s] = [n.translation, n.scale].map(|v| v.to_array().map(narrow));
            let r = n.rotation.normalize().to_array().map(narrow);
            out.rest.push([t[0], t[1], t[2], r[0], r[1], r[2], r[3], s[0], s[1], s[2]]);
        }
        for clip in &model.clips {
            out.add_clip(clip, &place);
        }
        out
    }

    fn add_clip(&mut self, clip: &crate::model::Clip, place: &[Option<usize>]) {
        let first = count(self.channels.len());
        for channel in &clip.channels {
            let Some(node) = place.get(channel.node).copied().flatten() else { continue };
            let property = match channel.property {
                Property::Translation => 0,
                Property::Rotation => 1,
                Property::Scale => 2,
            };
            let interpolation = match channel.interpolation {
                Interpolation::Step => 0,
                Interpolation::Linear => 1,
                Interpolation::CubicSpline => 2,
            };
            let (key, value) = (count(self.times.len()), count(self.values.len()));
            let kind = property + 4 * interpolation;
            self.channels.push([count(node), kind, key, count(channel.times.len()), value, 0]);
            self.times.extend(&channel.times);
            self.values.extend(&channel.values);
        }
        let channels = count(self.channels.len()) - first;
        self.clips.push([first, channels, flush(clip.duration).to_bits(), 0]);
        self.names.push(padded(&clip.name));
    }

    /// Writes the sections from [`Section::Parents`] on.
    pub(super) fn write(&self, w: &mut AssetWriter) {
        w.words(Section::Parents, &self.parents);
        w.words(Section::NodeIndex, &self.node_index);
        w.floats(Section::NodeRest, self.rest.as_flattened());
        w.words(Section::Clips, self.clips.as_flattened());
        w.bytes(Section::ClipNames, self.names.as_flattened());
        w.words(Section::Channels, self.channels.as_flattened());
        w.floats(Section::Times, &self.times);
        w.floats(Section::Values, &self.values);
    }
}

/// Joints' nodes and all above them, parents first, otherwise in file order.
fn needed_nodes(model: &Model) -> Vec<usize> {
    let n = model.nodes.len();
    let mut depth = vec![None; n];
    for joint in &model.joints {
        let mut chain = vec![joint.node];
        while let Some(parent) = model.nodes[chain[chain.len() - 1]].parent {
            if chain.len() > n {
                break; // a cycle, which the importer refuses
            }
            chain.push(parent);
        }
        for (i, node) in chain.iter().rev().enumerate() {
            depth[*node] = Some(i);
        }
    }
    let mut nodes: Vec<usize> = (0..n).filter(|i| depth[*i].is_some()).collect();
    nodes.sort_by_key(|i| (depth[*i], *i));
    nodes
}
