//! Equilibrium: the nearest minimum of the energy, by projected Newton.
//!
//! ```text
//! H d = −∂E/∂x,   x ← x + t d,   E(x + t d) ≤ E(x) + 10⁻⁴ t d·∂E/∂x,   t = 1, 1/2, 1/4 …
//! ```
//!
//! Far from the minimum the Hessian is that of elements without negative eigenvalues, so that `d` always leads down
//! (Teran et al. 2005). As soon as a whole step was taken the true one is tried: it makes the end quadratic. If it
//! is not positive definite, the mean of the two is tried: a third fewer steps where a body slides along a shallow valley.
//! A matrix that is not even so gets a growing multiple of the identity. Where rounding hides the decrease, the
//! slope along `d` decides instead: `|d·∂E/∂x|` must fall by half (Hager, Zhang 2005, approximate Wolfe conditions).
//!
//! Where something must not be met the first `t` is what the potentials allow. Blocks of what touches have room made for
//! them as they appear; a solve begins without any, so that it does not depend on those before.

use super::assembly::{Assembly, Free};
use super::cholesky::FactorError;
use super::potential::{self, Potential};
use super::solver::{Method, Solver};
use super::stiffness::Stiffness;
use glam::DVec3;

/// When to be content.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tolerance {
    /// Largest step of a node, m, that counts as none.
    pub step: f64,
    /// Most iterations.
    pub iterations: usize,
}

/// What came of it. Positions are finite in any case, and their energy, but for rounding, not above that of the start.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Equilibrium {
    /// Whether the last step was smaller than the tolerance.
    pub converged: bool,
    /// `E` at the start and after each step, J.
    pub energies: Vec<f64>,
    /// Largest step of a node, m, of each iteration.
    pub steps: Vec<f64>,
    /// Elements that are inside out at the end: with some, the minimum is one of a tangle.
    pub inverted: usize,
}

/// Newton's method for one set of potentials; matrix and factor are kept from solve to solve.
#[derive(Debug)]
pub struct Newton {
    free: Free,
    matrix: Stiffness,
    solver: Solver,
    method: Method,
    /// Pairs of rows that have room for what touches, in order.
    touching: Vec<(u32, u32)>,
}

/// Part of the predicted decrease that is asked for.
const ARMIJO: f64 = 1e-4;
/// Share of the true Hessian in a mean with the projected one, which is tried before the latter alone.
const BLEND: f64 = 0.5;
/// Halvings of a step.
const HALVINGS: usize = 40;
/// Change, relative to the energy, that rounding may be the cause of.
const ROUNDING: f64 = 1e-6;

impl Newton {
    /// For `potentials` over nodes of which `free` may move.
    ///
    /// # Errors
    ///
    /// If there is not memory enough for the factor.
    pub fn new(free: Free, potentials: &[&dyn Potential], method: Method) -> Result<Self, FactorError> {
        let matrix = free.stiffness(potentials);
        let solver = Solver::new(&matrix, method)?;
        Ok(Self { free, matrix, solver, method, touching: Vec::new() })
    }

    /// Which nodes move.
    #[must_use]
    pub const fn free(&self) -> &Free {
        &self.free
    }

    /// Moves the free nodes of `x` to where the energy of `potentials` is least nearby.
    pub fn minimize(
        &mut self,
        potentials: &[&dyn Potential],
        x: &mut [DVec3],
        tolerance: Tolerance,
    ) -> Equilibrium {
        let mut energy = potential::energy(potentials, x);
        let mut out = Equilibrium { energies: vec![energy], ..Equilibrium::default() };
        let mut projected = true;
        if !self.touching.is_empty() && self.reserve(potentials, Vec::new()).is_none() {
            return out;
        }
        for _ in 0..tolerance.iterations {
            let slopes = potential::gradient(potentials, x);
            let Some(d) = self.direction(potentials, x, &slopes, &mut projected) else { break };
            let step = d.iter().map(|d| d.length()).fold(0.0, f64::max);
            out.steps.push(step);
            let (slope, tiny) = (self.along(&slopes, &d), step <= tolerance.step);
            let Some((t, lower)) = self.search(potentials, x, &d, (energy, slope, tiny)) else { break };
            energy = lower;
            out.energies.push(energy);
            projected = t < 1.0;
            if !projected && tiny {
                out.converged = true;
                break;
            }
        }
        out.inverted = potentials.iter().map(|p| p.inverted(x)).sum();
        out
    }

    /// `−H⁻¹ ∂E/∂x` by rows; none where the matrix is not finite.
    fn direction(
        &mut self,
        potentials: &[&dyn Potential],
        x: &[DVec3],
        slopes: &[DVec3],
        projected: &mut bool,
    ) -> Option<Vec<DVec3>> {
        let touching = self.free.touching(potentials, x);
        if touching.iter().any(|(i, j)| !self.matrix.contains(*j, *i)) {
            let mut all = core::mem::take(&mut self.touching);
            all.extend(touching);
            self.reserve(potentials, all)?;
        }
        self.assemble(potentials, x, *projected);
        self.solve(slopes).or_else(|| self.solve_safe(potentials, x, slopes, projected))
    }

    /// `−H⁻¹ ∂E/∂x` with the matrix as it is; none if it is seen not to be positive definite.
    fn solve(&mut self, slopes: &[DVec3]) -> Option<Vec<DVec3>> {
        let mut d: Vec<DVec3> = self.free.node.iter().map(|i| -slopes[*i as usize]).collect();
        self.solver.solve(&self.matrix, &mut d).ok()?;
        d.iter().all(|d| d.is_finite()).then_some(d)
    }

    /// A direction where the matrix, the true one if not `projected`, gives none.
    fn solve_safe(
        &mut self,
        potentials: &[&dyn Potential],
        x: &[DVec3],
        slopes: &[DVec3],
        projected: &mut bool,
    ) -> Option<Vec<DVec3>> {
        if !*projected {
            *projected = true;
            let exact = self.matrix.clone();
            self.assemble(potentials, x, true);
            let safe = self.matrix.clone();
            self.matrix.blend(&exact, BLEND);
            if let Some(d) = self.solve(slopes) {
                return Some(d);
            }
            self.matrix = safe;
        }
        self.solve_shifted(slopes)
    }

    /// Makes room for blocks of what touches, and drops those that had some before.
    fn reserve(&mut self, potentials: &[&dyn Potential], touching: Vec<(u32, u32)>) -> Option<()> {
        self.touching = touching;
        self.matrix = self.free.stiffness_with(potentials, &self.touching);
        self.solver = Solver::new(&self.matrix, self.method).ok()?;
        Some(())
    }

    /// `d·∂E/∂x`.
    fn along(&self, slopes: &[DVec3], d: &[DVec3]) -> f64 {
        self.free.node.iter().zip(d).map(|(i, d)| slopes[*i as usize].dot(*d)).sum()
    }

    fn assemble(&mut self, potentials: &[&dyn Potential], x: &[DVec3], projected: bool) {
        let mut assembly = Assembly::new(&self.free, &mut self.matrix);
        potentials.iter().for_each(|p| p.hessian(x, projected, &mut assembly));
    }

    /// A direction by the matrix with as little more on the diagonal as makes it positive definite.
    fn solve_shifted(&mut self, slopes: &[DVec3]) -> Option<Vec<DVec3>> {
        let mean = self.matrix.mean_diagonal();
        let mut shift: f64 = 0.0;
        loop {
            if let Some(d) = self.solve(slopes) {
                return Some(d);
            }
            let more = if shift == 0.0 { 1e-10 * mean } else { 9.0 * shift };
            shift += more;
            if shift.is_nan() || shift > 1e4 * mean {
                return None;
            }
            self.matrix.shift(more);
        }
    }

    /// The part of the step `d` with which nothing meets.
    fn limit(&self, potentials: &[&dyn Potential], x: &[DVec3], d: &[DVec3]) -> f64 {
        let mut all = vec![DVec3::ZERO; x.len()];
        self.free.node.iter().zip(d).for_each(|(i, d)| all[*i as usize] = *d);
        potential::limit(potentials, x, &all)
    }

    /// Steps along `d` until the energy is lower; the length and the energy. None where it nowhere is. A `tiny` step needs
    /// no proof.
    fn search(
        &self,
        potentials: &[&dyn Potential],
        x: &mut [DVec3],
        d: &[DVec3],
        (energy, slope, tiny): (f64, f64, bool),
    ) -> Option<(f64, f64)> {
        let start: Vec<DVec3> = self.free.node.iter().map(|i| x[*i as usize]).collect();
        let mut t = self.limit(potentials, x, d);
        for _ in 0..HALVINGS {
            for ((i, from), d) in self.free.node.iter().zip(&start).zip(d) {
                x[*i as usize] = *from + t * *d;
            }
            let found = potential::energy(potentials, x);
            let lower = found <= energy + ARMIJO * t * slope;
            let same = || (found - energy).abs() <= ROUNDING * energy.abs();
            let flatter = || self.along(&potential::gradient(potentials, x), d).abs() <= 0.5 * slope.abs();
            if lower || tiny && found.is_finite() || same() && flatter() {
                return Some((t, found));
            }
            t *= 0.5;
        }
        for (i, from) in self.free.node.iter().zip(&start) {
            x[*i as usize] = *from;
        }
        None
    }
}
