//! Palette in, targets out: where skinning puts the moving points, and what accelerates them there.
//!
//! ```text
//! f = g − B·g₀
//! ```
//!
//! `g` is gravity and wind in the root's frame, `B·g₀` the gravity that the authored shape already
//! sags under, turned with the flesh: at rest they cancel, bent over they do not.

use crate::kernel::skin::{self, Influences, LinearBlock, Rows};
use crate::lanes::four::{self, three};
use crate::lanes::{F32x4, Lanes};

/// What [`targets`] writes, one a moving point.
#[derive(Debug)]
pub struct Targets<'a> {
    /// Skinned positions, model space.
    pub positions: &'a mut [[f32; 3]],
    /// Accelerations, model units per s².
    pub accelerations: &'a mut [[f32; 3]],
    /// Linear parts of the blended maps, a block of four points each.
    pub linear: &'a mut [LinearBlock],
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
    palette: &[Rows],
    influences: Influences<'_>,
    rest: &[[f32; 3]],
    (gravity, authored): ([f32; 3], [f32; 3]),
    out: Targets<'_>,
) {
    let Targets { positions, accelerations, linear } = out;
    skin::skin(palette, influences, rest, positions, linear);
    assert!(accelerations.len() == rest.len(), "skin: lengths differ");
    let [gravity, authored] = [gravity, authored].map(|v| v.map(F32x4::splat));
    for (k, linear) in linear.iter().enumerate() {
        let turned = four::mul(&three(|c| three(|r| F32x4::from_array(linear[c][r]))), &authored);
        four::store(three(|r| gravity[r] - turned[r]), accelerations, 4 * k);
    }
}
