//! Equilibrium in a pose.

use super::Simulation;
use crate::fem::newton::Equilibrium;
use crate::pose::Pose;
use glam::{DMat4, DVec3};

/// The shortest part of a way that is tried.
const SHORTEST: f64 = 1.0 / 64.0;

/// A pose in equilibrium.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Settled {
    /// What Newton's method said at the end of the way. Elements that are inside out at a true minimum are few: those that
    /// the bones force to be, in the fold of a joint.
    pub equilibrium: Equilibrium,
    /// Parts of the way from the last pose, those in vain included.
    pub increments: usize,
    /// Newton's iterations in all.
    pub iterations: usize,
}

impl Simulation<'_> {
    /// Brings the flesh to equilibrium in a pose; its velocities are then none.
    ///
    /// The first guess is the last equilibrium, carried along by skinning. Where Newton's method does not come to an end
    /// from there, the pose is moved in shorter parts, by the shortest arcs of its joints.
    pub fn settle(&mut self, pose: &Pose) -> Settled {
        let start = self.pose.clone();
        let (mut done, mut part) = (0.0, 1.0_f64);
        let mut out = Settled::default();
        while done < 1.0 {
            let next = f64::min(1.0, done + part);
            let before = (self.pose.clone(), self.state.x.clone());
            // The end is the pose itself, to the last bit.
            let way = if next < 1.0 { start.interpolate(pose, next) } else { pose.clone() };
            let found = self.advance(&way);
            let last = part <= SHORTEST;
            out.increments += 1;
            out.iterations += found.steps.len();
            if found.converged || last {
                (done, part) = (next, f64::min(2.0 * part, 1.0));
                out.equilibrium = found;
            } else {
                self.hold(&before.0);
                self.state.x = before.1;
                part *= 0.5;
            }
        }
        self.state.v.fill(DVec3::ZERO);
        out
    }

    /// One part of the way.
    fn advance(&mut self, pose: &Pose) -> Equilibrium {
        let old = core::mem::take(&mut self.blend);
        let skinned = self.hold(pose);
        let carried = |((x, old), new): ((&DVec3, &DMat4), &DMat4)| {
            let at = new.transform_point3(old.inverse().transform_point3(*x));
            // A matrix without an inverse is that of a node in a fold.
            if at.is_finite() { at } else { *x }
        };
        let guess: Vec<DVec3> = self.state.x.iter().zip(&old).zip(&self.blend).map(carried).collect();
        self.state.x = guess;
        for i in &self.body.binding.fixed {
            self.state.x[*i as usize] = skinned[*i as usize];
        }
        let potentials = [&self.flesh as _, &self.pull as _, &self.weight as _];
        self.newton.minimize(&potentials, &mut self.state.x, self.tolerance)
    }
}
