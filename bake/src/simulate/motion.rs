//! Flesh in motion.

use super::Simulation;
use crate::Error;
use crate::fem::dynamics::BackwardEuler;
use crate::fem::newton::Equilibrium;
use crate::fem::solver::Method;
use crate::pose::Pose;
use glam::DVec3;

impl Simulation<'_> {
    /// A step of `h` seconds by backward Euler, to where a pose has come by then.
    ///
    /// # Errors
    ///
    /// [`Error::Unusable`] if there is not memory enough, or `h` is not above 0.
    pub fn step(&mut self, pose: &Pose, h: f64) -> Result<Equilibrium, Error> {
        let refused = |place: &str, what: String, remedy: &str| {
            Err(Error::unusable(&self.model.name, place.to_owned(), what, remedy))
        };
        if !(h > 0.0 && h.is_finite()) {
            return refused("step", format!("{h} s"), "give a time above 0");
        }
        let mut steps = match self.steps.take() {
            Some(steps) => steps,
            None => {
                let free = self.newton.free().clone();
                match BackwardEuler::new(
                    free,
                    &self.potentials(),
                    self.mass.clone(),
                    self.damping,
                    Method::DIRECT,
                ) {
                    Ok(steps) => steps,
                    Err(e) => return refused("memory", e.to_string(), "use a coarser cage"),
                }
            }
        };
        let skinned = self.hold(pose);
        let mut to: Vec<DVec3> = self.state.x.iter().zip(&self.state.v).map(|(x, v)| *x + h * *v).collect();
        for i in &self.body.binding.fixed {
            to[*i as usize] = skinned[*i as usize];
        }
        let potentials = [&self.flesh as _, &self.pull as _, &self.weight as _];
        let found = steps.step(&potentials, &mut self.state, &to, h, self.tolerance);
        self.steps = Some(steps);
        Ok(found)
    }
}
