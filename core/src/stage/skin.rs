//! Palette in, targets out: where skinning puts the moving points, and what accelerates them there.
//!
//! ```text
//! f = g − B·g₀
//! ```
//!
//! `g` is gravity and wind in the root's frame, `B·g₀` the gravity that the authored shape already
//! sags under, turned with the flesh: at rest they cancel, bent over they do not.

use crate::kernel::skin::{self, Columns, Influences};
use crate::lanes::{F32x4, Lanes};

/// What [`targets`] writes, one a moving point.
#[derive(Debug)]
pub struct Targets<'a> {
    /// Skinned positions, model space.
    pub positions: &'a mut [[f32; 3]],
    /// Accelerations, model units per s².
    pub accelerations: &'a mut [[f32; 3]],
    /// Columns of the linear parts of the blended matrices.
    pub linear: &'a mut [[[f32; 4]; 3]],
}

/// Skins the moving points and finds their accelerations.
///
/// * `gravity`: acceleration in the root's frame, model units per s²; `authored`: that of the authored shape, bind space.
/// * `out`: one a point of `rest`.
///
/// # Panics
///
/// If the lengths differ.
pub fn targets(
    palette: &[Columns],
    influences: Influences<'_>,
    rest: &[[f32; 3]],
    (gravity, authored): ([f32; 3], [f32; 3]),
    out: Targets<'_>,
) {
    let Targets { positions, accelerations, linear } = out;
    skin::skin(palette, influences, rest, positions, linear);
    assert!(accelerations.len() == linear.len(), "skin: lengths differ");
    let [x, y, z] = authored.map(F32x4::splat);
    let g = F32x4::from_array([gravity[0], gravity[1], gravity[2], 0.0]);
    for (f, m) in accelerations.iter_mut().zip(&*linear) {
        let [a, b, c] = m.map(F32x4::from_array);
        let [fx, fy, fz, _] = (g - ((a * x + b * y) + c * z)).to_array();
        *f = [fx, fy, fz];
    }
}
