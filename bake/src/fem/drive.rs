//! Nodes that are told where to be, moved there without anything passing through anything.
//!
//! ```text
//! x ← x + t (to − x),   t = limit;   x ← minimum;   until t = 1
//! ```

use super::newton::{Equilibrium, Newton, Tolerance};
use super::potential::{self, Potential};
use glam::DVec3;

/// What came of a motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Outcome {
    /// All nodes are where they were told to be.
    Arrived,
    /// What nodes are told would take one surface through another, and what lies between cannot give way.
    Blocked {
        /// Part of the way that was gone, below 1.
        at: f64,
    },
}

/// Moves nodes that are not free to their place in `to`, and the others to where the energy of `potentials` is least nearby.
///
/// `x` should be an equilibrium already. Without potentials that limit steps it is one move and one solve; else the move is cut
/// where something would be met, and goes on once the flesh gave way. It is over when it can go on by less than
/// `tolerance.step` alone. Positions then are those of the last solve, and nothing crosses.
pub fn drive(
    newton: &mut Newton,
    potentials: &[&dyn Potential],
    x: &mut [DVec3],
    to: &[DVec3],
    tolerance: Tolerance,
) -> (Equilibrium, Outcome) {
    let (mut gone, mut rest) = (0.0, 1.0);
    loop {
        let mut d: Vec<DVec3> = to.iter().zip(&*x).map(|(to, x)| *to - *x).collect();
        newton.free().node.iter().for_each(|i| d[*i as usize] = DVec3::ZERO);
        let t = potential::limit(potentials, x, &d);
        let farthest = d.iter().map(|d| t * d.length()).fold(0.0, f64::max);
        if t >= 1.0 {
            for (i, to) in to.iter().enumerate().filter(|(i, _)| d[*i] != DVec3::ZERO) {
                x[i] = *to;
            }
            return (newton.minimize(potentials, x, tolerance), Outcome::Arrived);
        }
        x.iter_mut().zip(&d).for_each(|(x, d)| *x += t * *d);
        gone += t * rest;
        rest *= 1.0 - t;
        let found = newton.minimize(potentials, x, tolerance);
        if farthest <= tolerance.step || farthest.is_nan() {
            return (found, Outcome::Blocked { at: gone });
        }
    }
}
