//! The built-in motion of the root, for characters without clips.

use core::f64::consts::TAU;
use sinew::Root;

/// Where the root is at time `t`, s, for a body of `size`: hops, sways and turns, 2 s a round.
///
/// # Examples
///
/// ```
/// let start = sinew_bake::play::shake(0.0, 1.7);
/// assert_eq!(start.translation, [0.0, 0.0, 0.0]);
/// ```
#[must_use]
pub fn shake(t: f32, size: f32) -> Root {
    let (t, size) = (f64::from(t), f64::from(size));
    let wave = |hertz: f64| libm::sin(TAU * hertz * t);
    let translation =
        [0.06 * size * wave(1.0), 0.03 * size * (1.0 - libm::cos(TAU * 1.5 * t)), 0.03 * size * wave(0.5)];
    let half = 0.5 * (0.35 * wave(0.5) + 0.1 * wave(1.5));
    let rotation = [0.0, crate::pack::narrow(libm::sin(half)), 0.0, crate::pack::narrow(libm::cos(half))];
    Root { translation, rotation }
}
