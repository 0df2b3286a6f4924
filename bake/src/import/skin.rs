//! Skins: one list of joints for the whole file.

use std::collections::BTreeMap;

use glam::DMat4;

use super::source::{Source, label};
use crate::Error;
use crate::model::Joint;

/// Joints of all skins.
#[derive(Debug)]
pub(super) struct Skins {
    /// Each pair of node and inverse bind matrix once, in the order of first use.
    pub(super) joints: Vec<Joint>,
    /// For each skin, the row of `joints` of each of its joints.
    pub(super) rows: Vec<Vec<u16>>,
}

/// Reads all skins.
pub(super) fn read(source: &Source<'_>) -> Result<Skins, Error> {
    let mut skins = Skins { joints: Vec::new(), rows: Vec::new() };
    let mut row_of = BTreeMap::new();
    for (index, skin) in source.root.skins.iter().enumerate() {
        let place = label("skin", index, skin.name.as_ref());
        let matrices: Vec<[f32; 16]> = match skin.inverse_bind_matrices {
            Some(accessor) => source.floats(accessor, &format!("{place}, inverse bind matrices"))?,
            None => vec![DMat4::IDENTITY.as_mat4().to_cols_array(); skin.joints.len()],
        };
        if matrices.len() < skin.joints.len() {
            let problem =
                format!("{} inverse bind matrices for {} joints", matrices.len(), skin.joints.len());
            return Err(source.damaged(place, problem));
        }
        let mut rows = Vec::with_capacity(skin.joints.len());
        for (number, (&node, matrix)) in skin.joints.iter().zip(&matrices).enumerate() {
            let place = format!("{place}, joint {number}");
            source.get(&source.root.nodes, node, "node", &place)?;
            if !matrix.iter().all(|m| m.is_finite()) {
                return Err(source.damaged(place, "its inverse bind matrix is not finite"));
            }
            // `+ 0.0` makes -0 and 0 the same.
            let key = (node.value(), matrix.map(|m| (m + 0.0).to_bits()));
            let next = u16::try_from(skins.joints.len()).map_err(|_| {
                source.error(&place, "more than 65,536 joints in the file", "split the file by character")
            })?;
            let row = *row_of.entry(key).or_insert(next);
            if row == next {
                let joint_from_bind = DMat4::from_cols_array(&matrix.map(f64::from));
                skins.joints.push(Joint { node: node.value(), joint_from_bind });
            }
            rows.push(row);
        }
        skins.rows.push(rows);
    }
    Ok(skins)
}
