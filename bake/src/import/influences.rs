//! Joint weights of vertices.

use super::source::Source;
use crate::Error;

/// Which joints move each vertex, and how much.
#[derive(Debug, Default, PartialEq)]
pub(super) struct Influences {
    /// Influences a vertex: a multiple of 4, at least 4.
    pub(super) stride: usize,
    /// Rows of the model's joints.
    pub(super) joints: Vec<u16>,
    /// Weights, descending, sum 1.
    pub(super) weights: Vec<f32>,
}

/// One set of four influences a vertex: joints of the skin, and their weights.
pub(super) type Set = (Vec<[u32; 4]>, Vec<[f32; 4]>);

/// Why a vertex cannot be used, and the remedy.
type Reason = (String, &'static str);

const NORMALIZE: &str = "assign the vertex to a joint and normalize its weights where the character was made";

/// Joins the sets `JOINTS_n`, `WEIGHTS_n` (4 influences a vertex each). `rows` are the model's joints of the skin.
///
/// Entries with a weight of 0 are dropped whatever joint they name, a joint named twice counts once with the sum,
/// and the stride is as small as the vertex with the most influences allows.
pub(super) fn join(
    source: &Source<'_>,
    sets: &[Set],
    vertices: usize,
    rows: &[u16],
    place: &str,
) -> Result<Influences, Error> {
    // All blends one after the other, and where each ends.
    let (mut flat, mut ends) = (Vec::with_capacity(4 * vertices), Vec::with_capacity(vertices));
    let mut most = 0;
    for vertex in 0..vertices {
        let entries =
            sets.iter().flat_map(|(joints, weights)| joints[vertex].into_iter().zip(weights[vertex]));
        let blend = blend(entries, rows).map_err(|(problem, remedy)| {
            source.error(format!("{place}, vertex {vertex}"), problem, remedy)
        })?;
        most = most.max(blend.len());
        flat.extend(blend);
        ends.push(flat.len());
    }
    let stride = most.next_multiple_of(4).max(4);
    source.charge(2 * stride as u64 * vertices as u64, place)?;
    let mut out = Influences { stride, ..Influences::default() };
    let mut start = 0;
    for end in ends {
        let blend = &flat[start..end];
        start = end;
        // Unused places repeat the dominant joint: a valid row that is read anyway.
        let unused = blend.first().map_or(0, |(row, _)| *row);
        let padded = blend.iter().copied().chain(core::iter::repeat((unused, 0.0)));
        for (row, weight) in padded.take(stride) {
            out.joints.push(row);
            out.weights.push(weight);
        }
    }
    Ok(out)
}

/// Influences of one vertex: rows and weights, descending, sum 1.
fn blend(entries: impl Iterator<Item = (u32, f32)>, rows: &[u16]) -> Result<Vec<(u16, f32)>, Reason> {
    let mut blend: Vec<(u16, f64)> = Vec::with_capacity(4);
    for (joint, weight) in entries {
        if !weight.is_finite() || weight < 0.0 {
            return Err((format!("its weight {weight} for joint {joint} is not a share"), NORMALIZE));
        }
        if weight > 0.0 {
            let row = rows.get(joint as usize).ok_or_else(|| {
                (
                    format!("joint {joint} is out of range: the skin has {}", rows.len()),
                    super::source::EXPORT_AGAIN,
                )
            })?;
            match blend.iter_mut().find(|(known, _)| known == row) {
                Some((_, sum)) => *sum += f64::from(weight),
                None => blend.push((*row, f64::from(weight))),
            }
        }
    }
    if blend.is_empty() {
        return Err(("its weights sum to 0".to_owned(), NORMALIZE));
    }
    blend.sort_by(|(row_a, a), (row_b, b)| b.total_cmp(a).then(row_a.cmp(row_b)));
    let sum: f64 = blend.iter().map(|(_, weight)| weight).sum();
    #[expect(clippy::cast_possible_truncation, reason = "rounding to f32 is meant")]
    let shares = blend.into_iter().map(|(row, weight)| (row, (weight / sum) as f32));
    Ok(shares.collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(entries: &[(u32, f32)], rows: &[u16]) -> Result<Vec<(u16, f32)>, Reason> {
        blend(entries.iter().copied(), rows)
    }

    #[test]
    fn weights_come_out_descending_with_sum_one() {
        assert_eq!(
            of(&[(0, 0.25), (1, 0.5), (2, 1.25)], &[7, 8, 9]).unwrap(),
            [(9, 0.625), (8, 0.25), (7, 0.125)]
        );
    }

    #[test]
    fn equal_weights_are_ordered_by_row() {
        assert_eq!(of(&[(0, 0.5), (1, 0.5)], &[9, 3]).unwrap(), [(3, 0.5), (9, 0.5)]);
    }

    #[test]
    fn a_joint_named_twice_counts_once() {
        assert_eq!(of(&[(0, 0.25), (1, 0.5), (0, 0.25)], &[0, 1]).unwrap(), [(0, 0.5), (1, 0.5)]);
    }

    #[test]
    fn garbage_joints_are_accepted_where_the_weight_is_zero() {
        assert_eq!(of(&[(0, 1.0), (999, 0.0)], &[4]).unwrap(), [(4, 1.0)]);
        assert!(of(&[(0, 1.0), (999, 0.1)], &[4]).unwrap_err().0.contains("joint 999 is out of range"));
    }

    #[test]
    fn unusable_weights_are_refused() {
        for bad in [f32::NAN, f32::INFINITY, -0.5] {
            assert!(of(&[(0, 1.0), (0, bad)], &[0]).is_err(), "{bad}");
        }
        assert!(of(&[(0, 0.0), (0, 0.0)], &[0]).is_err());
        assert!(of(&[(0, f32::MAX), (1, f32::MAX)], &[0, 1]).is_ok(), "the sum is taken in f64");
    }
}
