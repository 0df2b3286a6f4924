//! Motion in time.
//!
//! ```text
//! implicit:  M(v' − v) = h f(x') − (αM + βK)(x' − x),   x' = x + h v'       backward Euler, solved to the end
//! explicit:  v' = v + h M⁻¹ f(x),   x' = x + h v'                           central differences, lumped masses
//! ```
//!
//! Nodes that are not free go where they are told; with a consistent mass matrix their acceleration is felt by others.
//! What touches is not damped: it would stick. Only the implicit step heeds limits.

use super::assembly::{Assembly, Free};
use super::cholesky::FactorError;
use super::drive::{Outcome, drive};
use super::mass::Mass;
use super::newton::{Equilibrium, Newton, Tolerance};
use super::potential::inertia::{Drag, Inertia};
use super::potential::{self, Potential};
use super::solver::Method;
use super::stiffness::Stiffness;
use glam::DVec3;

/// Places and velocities of all nodes.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct State {
    /// m.
    pub x: Vec<DVec3>,
    /// m/s.
    pub v: Vec<DVec3>,
}

/// Rayleigh damping: forces `−(αM + βK)v`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Rayleigh {
    /// `α`, 1/s.
    pub mass: f64,
    /// `β`, s.
    pub stiffness: f64,
}

/// Backward Euler for one set of potentials.
#[derive(Debug)]
pub struct BackwardEuler {
    newton: Newton,
    mass: Mass,
    damping: Rayleigh,
    /// All nodes, and their stiffness, where damping needs it.
    all: Option<(Free, Stiffness)>,
}

impl BackwardEuler {
    /// For `potentials` over nodes of which `free` may move.
    ///
    /// # Errors
    ///
    /// If there is not memory enough for the factor.
    pub fn new(
        free: Free,
        potentials: &[&dyn Potential],
        mass: Mass,
        damping: Rayleigh,
        method: Method,
    ) -> Result<Self, FactorError> {
        let inertia = Inertia { mass: &mass, to: Vec::new(), factor: 0.0 };
        let with: Vec<&dyn Potential> =
            potentials.iter().copied().chain([&inertia as &dyn Potential]).collect();
        let newton = Newton::new(free, &with, method)?;
        let all = (damping.stiffness > 0.0).then(|| {
            let all = Free::new(mass.diagonal.len(), &[]);
            let matrix = all.stiffness(potentials);
            (all, matrix)
        });
        Ok(Self { newton, mass, damping, all })
    }

    /// A step of `h` seconds; nodes that are not free end at their place in `to`.
    ///
    /// `to` gives a first guess for the others, too, or is where they would go by themselves. Where something would be met
    /// on that way nodes are [driven](drive()) from where they were; when blocked it did not converge.
    pub fn step(
        &mut self,
        potentials: &[&dyn Potential],
        state: &mut State,
        to: &[DVec3],
        h: f64,
        tolerance: Tolerance,
    ) -> Equilibrium {
        let from = state.x.clone();
        let coasting = from.iter().zip(&state.v).map(|(x, v)| *x + h * *v).collect();
        let inertia = Inertia { mass: &self.mass, to: coasting, factor: 1.0 / (h * h) };
        let viscous = Inertia { mass: &self.mass, to: from.clone(), factor: self.damping.mass / h };
        if let Some((all, matrix)) = &mut self.all {
            let mut assembly = Assembly::new(all, matrix);
            let damped = potentials.iter().filter(|p| !potential::is_touching(**p, &from));
            damped.for_each(|p| p.hessian(&from, true, &mut assembly));
        }
        let drag = self.all.as_ref().map(|(_, stiffness)| Drag {
            stiffness,
            from: from.clone(),
            factor: self.damping.stiffness / h,
        });
        let mut all: Vec<&dyn Potential> = potentials.to_vec();
        all.push(&inertia);
        if self.damping.mass > 0.0 {
            all.push(&viscous);
        }
        all.extend(drag.as_ref().map(|d| d as &dyn Potential));
        let way: Vec<DVec3> = to.iter().zip(&from).map(|(to, from)| *to - *from).collect();
        let found = if potential::limit(potentials, &from, &way) >= 1.0 {
            state.x.copy_from_slice(to);
            self.newton.minimize(&all, &mut state.x, tolerance)
        } else {
            let (found, outcome) = drive(&mut self.newton, &all, &mut state.x, to, tolerance);
            Equilibrium { converged: found.converged && outcome == Outcome::Arrived, ..found }
        };
        for ((v, x), from) in state.v.iter_mut().zip(&state.x).zip(&from) {
            *v = (*x - *from) / h;
        }
        found
    }
}

/// A step of `h` seconds by central differences with the lumped masses `mass`, kg a node.
///
/// Nodes that are not free end at their place in `to`. Nothing bounds what comes out when `h` is above
/// `2/ω` of the stiffest mode.
pub fn explicit_step(
    free: &Free,
    potentials: &[&dyn Potential],
    mass: &Mass,
    state: &mut State,
    to: &[DVec3],
    h: f64,
) {
    let slopes = potential::gradient(potentials, &state.x);
    let from = state.x.clone();
    state.x.copy_from_slice(to);
    for i in free.node.iter().map(|i| *i as usize) {
        state.v[i] -= h * slopes[i] / mass.diagonal[i];
        state.x[i] = from[i] + h * state.v[i];
    }
    for ((v, x), from) in state.v.iter_mut().zip(&state.x).zip(&from) {
        *v = (*x - *from) / h;
    }
}
