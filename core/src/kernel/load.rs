//! What accelerates the flesh besides its springs.
//!
//! ```text
//! f = g − B·g₀
//! ```
//!
//! `g` is gravity and wind in the root's frame, `B·g₀` the gravity that the authored shape already
//! sags under, turned with the flesh: at rest they cancel, bent over they do not.

use super::skin::{BLOCK, LinearBlock, map_of};
use crate::dispatch;
use crate::lanes::block::{GROUPS, four, put, write};
use crate::lanes::{Number, three};
use wide::f32x4;

/// Accelerations of points, model units per s².
///
/// * `gravity`: `g`, root's frame, model units per s²; `authored`: `g₀`, bind space.
/// * `linear`: `B`, as [`super::skin::skin`] leaves them; `out`: one a point.
pub fn load(gravity: [f32; 3], authored: [f32; 3], linear: &[LinearBlock], out: &mut [[f32; 3]]) {
    load_at(dispatch::widest(), gravity, authored, linear, out);
}

dispatch::copies!(load_at, load_any, (
    gravity: [f32; 3], authored: [f32; 3], linear: &[LinearBlock], out: &mut [[f32; 3]],
));

/// The body of each copy of [`load`].
#[inline(always)]
fn load_any(gravity: [f32; 3], authored: [f32; 3], linear: &[LinearBlock], out: &mut [[f32; 3]]) {
    let (blocks, rest) = out.as_chunks_mut();
    let last = linear.get(blocks.len());
    for (linear, out) in linear.iter().zip(blocks) {
        let mut f = [[0.0; BLOCK]; 3];
        for group in 0..GROUPS {
            let b = three(|c| four(&linear[c], group));
            put(&mut f, group, felt(gravity.map(f32x4::splat), authored.map(f32x4::splat), b));
        }
        write(&f, out);
    }
    if let Some(linear) = last {
        (0..).zip(rest).for_each(|(lane, out)| *out = felt(gravity, authored, map_of(linear, lane)));
    }
}

/// `g − B·g₀`.
#[inline(always)]
fn felt<T: Number>(gravity: [T; 3], authored: [T; 3], [a, b, c]: [[T; 3]; 3]) -> [T; 3] {
    three(|r| gravity[r] - (a[r] * authored[0] + b[r] * authored[1] + c[r] * authored[2]))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Half a turn about z: what pulled one way when authored pulls the other way now.
    #[test]
    fn gravity_is_felt_by_what_is_turned() {
        let turn = [[-1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, 1.0]];
        let linear = turn.map(|column| column.map(|x| [x; BLOCK]));
        for level in dispatch::levels() {
            let mut out = [[9.0; 3]; BLOCK + 5];
            load_at(level, [0.0, -10.0, 0.0], [0.0, -10.0, 1.0], &[linear; 2], &mut out);
            assert_eq!(out, [[0.0, -20.0, -1.0]; BLOCK + 5], "{level:?}");
        }
    }
}
