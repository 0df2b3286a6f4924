//! Spring bones of VRM 0.x (`VRM`) and 1.0 (`VRMC_vrm`, `VRMC_springBone`).

use serde_json::Value;

use super::node::spread_to_descendants;
use super::source::Source;
use crate::model::{Node, Vrm};

/// What the VRM extensions say; `None` if the file has none. References to nodes that do not exist are left out,
/// as VRM 0.x writes -1 for "none".
pub(super) fn read(source: &Source<'_>, nodes: &[Node]) -> Option<Vrm> {
    let extensions = &source.root.extensions.as_ref()?.others;
    let spring_bone = extensions.get("VRMC_springBone");
    let mut moved = vec![false; nodes.len()];
    let major_version = if spring_bone.is_some() || extensions.contains_key("VRMC_vrm") {
        let springs = spring_bone.into_iter().flat_map(|s| list(&s["springs"]));
        mark(springs.flat_map(|s| list(&s["joints"])).map(|joint| &joint["node"]), &mut moved);
        1
    } else {
        let groups = list(&extensions.get("VRM")?["secondaryAnimation"]["boneGroups"]);
        mark(groups.iter().flat_map(|group| list(&group["bones"])), &mut moved);
        spread_to_descendants(nodes, &mut moved);
        0
    };
    let spring_nodes = (0..nodes.len()).filter(|n| moved[*n]).collect();
    Some(Vrm { major_version, spring_nodes })
}

/// Elements of an array; none if it is not one.
fn list(value: &Value) -> &[Value] {
    value.as_array().map_or(&[], Vec::as_slice)
}

fn mark<'v>(nodes: impl Iterator<Item = &'v Value>, moved: &mut [bool]) {
    for node in nodes.filter_map(Value::as_u64).filter_map(|n| usize::try_from(n).ok()) {
        if let Some(moved) = moved.get_mut(node) {
            *moved = true;
        }
    }
}
