//! How much of a step two parts of a surface may take until they touch.
//!
//! ```text
//! t ← t + 0.9 d(x + t p)/l,   l = max |pᵢ| of the one + max |pⱼ| of the other
//! ```
//!
//! Additive continuous collision detection (Li, Kaufman, Jiang 2021: Codimensional Incremental Potential Contact,
//! algorithm 1): nothing comes nearer by more than it moves, so that no part of the step that is taken can touch,
//! whatever rounding does to the distance. It ends where the distance is below a gap.

use super::pair::{Kind, Pair};
use glam::DVec3;

/// Part of the distance that may be given up at a time.
const PART: f64 = 0.9;
/// Gap that is kept, as a part of the distance at the beginning and of the reach, whichever is less. Less than what a
/// first advance leaves, or rounding might end the search there.
const GAP: f64 = 0.05;
/// Most evaluations of the distance; the step is then cut off where it is known to be free.
const EVALUATIONS: usize = 256;

/// The part of the step `p` from `x`, 0 to 1, in which the pair stays apart.
#[must_use]
pub fn advance(pair: &Pair, x: [DVec3; 4], p: [DVec3; 4]) -> f64 {
    // What both do alike brings them no nearer.
    let mean = p.iter().sum::<DVec3>() / 4.0;
    let p = p.map(|p| p - mean);
    let length = |of: &[DVec3]| of.iter().map(|p| p.length()).fold(0.0, f64::max);
    let split = if pair.kind == Kind::PointTriangle { 1 } else { 2 };
    let longest = length(&p[..split]) + length(&p[split..]);
    let distance = |t: f64| {
        let at = [0, 1, 2, 3].map(|i| x[i] + t * p[i]);
        libm::sqrt(pair.nearest(at).squared())
    };
    let mut d = distance(0.0);
    if longest == 0.0 || d > longest + pair.reach {
        return 1.0;
    }
    let gap = GAP * d.min(pair.reach);
    let mut t = 0.0;
    for _ in 0..EVALUATIONS {
        let next = t + PART * d / longest;
        if next >= 1.0 {
            return 1.0;
        }
        d = distance(next);
        if d < gap || d.is_nan() {
            break;
        }
        t = next;
    }
    t
}
