//! Palette in, targets out: where skinning puts the moving points, and what accelerates them there.

use crate::kernel::load::load;
use crate::kernel::skin::{self, Influences, LinearBlock, Rows};

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
    load(gravity, authored, out.linear, out.accelerations);
}
