//! Palette in, targets out: where skinning puts the moving points, and what accelerates them there.
//!
//! ```text
//! f = g − B·g₀
//! ```
//!
//! `g` is gravity and wind in the root's frame, `B·g₀` the gravity that the authored shape already
//! sags under, turned with the flesh: at rest they cancel, bent over they do not.

use crate::dispatch;
use crate::kernel::skin::{self, BLOCK, Influences, LinearBlock, Rows, map_of};
use crate::lanes::block::write;
use crate::math::{affine, vec3};

/// What [`targets`] writes, one a moving point.
#[derive(Debug)]
pub struct Targets<'a> {
    /// Skinned positions, model space.
    pub positions: &'a mut [[f32; 3]],
    /// Accelerations, model units per s².
    pub accelerations: &'a mut [[f32; 3]],
    /// Linear parts of the blended maps, a block of points each.
    pub linear: &'a mut [LinearBlock],
}

/// Skins the moving points and finds their accelerations.
///
/// * `gravity`: acceleration in the root's frame, model units per s²; `authored`: that of the authored shape, bind space.
/// * `out`: one a point of `rest`; the shortest slice decides how many.
pub fn targets(
    palette: &[Rows],
    influences: Influences<'_>,
    rest: &[[f32; 3]],
    (gravity, authored): ([f32; 3], [f32; 3]),
    out: Targets<'_>,
) {
    skin::skin(palette, influences, rest, out.positions, out.linear);
    dispatch::accelerate(gravity, authored, out.linear, out.accelerations);
}

/// The body of each copy of the second half of [`targets`].
#[inline(always)]
pub(crate) fn accelerate_any(
    gravity: [f32; 3],
    authored: [f32; 3],
    linear: &[LinearBlock],
    out: &mut [[f32; 3]],
) {
    let mut lanes = [[0.0; BLOCK]; 3];
    for (linear, out) in linear.iter().zip(out.chunks_mut(BLOCK)) {
        for lane in 0..BLOCK {
            let [a, b, c] = map_of(linear, lane);
            let f = vec3::sub(gravity, affine::rotate(&[a, b, c, [0.0; 3]], authored));
            (lanes[0][lane], lanes[1][lane], lanes[2][lane]) = f.into();
        }
        write(&lanes, out);
    }
}
