//! What a step of backward Euler adds to the energy.
//!
//! ```text
//! E = (x − x̃)ᵀ M (x − x̃)/2h²,   x̃ = xₙ + h vₙ        its minimum with all else is the step's end
//! E = (x − xₙ)ᵀ (αM + βKₙ) (x − xₙ)/2h               Rayleigh damping, Kₙ the stiffness where the step begins
//! ```

use super::Potential;
use crate::fem::assembly::Assembly;
use crate::fem::mass::Mass;
use crate::fem::stiffness::Stiffness;
use glam::{DMat3, DVec3};

/// Masses that want to be somewhere: `E = k/2 (x − y)ᵀ M (x − y)`.
#[derive(Clone, Debug)]
pub struct Inertia<'a> {
    /// `M`.
    pub mass: &'a Mass,
    /// `y`.
    pub to: Vec<DVec3>,
    /// `k`, 1/s².
    pub factor: f64,
}

impl Potential for Inertia<'_> {
    fn stencils(&self, visit: &mut dyn FnMut(&[u32])) {
        self.mass.pairs.iter().for_each(|(i, j, _)| visit(&[*i, *j]));
    }

    fn energy(&self, x: &[DVec3]) -> f64 {
        let away: Vec<DVec3> = x.iter().zip(&self.to).map(|(x, to)| *x - *to).collect();
        let sum: f64 = self.mass.times(&away).iter().zip(&away).map(|(m, d)| m.dot(*d)).sum();
        0.5 * self.factor * sum
    }

    fn gradient(&self, x: &[DVec3], out: &mut [DVec3]) {
        let away: Vec<DVec3> = x.iter().zip(&self.to).map(|(x, to)| *x - *to).collect();
        out.iter_mut().zip(self.mass.times(&away)).for_each(|(out, m)| *out += self.factor * m);
    }

    fn hessian(&self, _x: &[DVec3], _projected: bool, out: &mut Assembly<'_>) {
        let block = |m: f64| DMat3::from_diagonal(DVec3::splat(self.factor * m));
        for (i, m) in (0..).zip(&self.mass.diagonal) {
            out.add(i, i, block(*m));
        }
        self.mass.pairs.iter().for_each(|(i, j, m)| out.add(*i, *j, block(*m)));
    }
}

/// A drag by a stiffness over all nodes: `E = k/2 (x − y)ᵀ K (x − y)`.
#[derive(Clone, Debug)]
pub struct Drag<'a> {
    /// `K`.
    pub stiffness: &'a Stiffness,
    /// `y`.
    pub from: Vec<DVec3>,
    /// `k`.
    pub factor: f64,
}

impl Drag<'_> {
    /// `K (x − y)`, and `x − y`.
    fn pulled(&self, x: &[DVec3]) -> (Vec<DVec3>, Vec<DVec3>) {
        let away: Vec<DVec3> = x.iter().zip(&self.from).map(|(x, from)| *x - *from).collect();
        let mut pulled = vec![DVec3::ZERO; x.len()];
        self.stiffness.multiply(&away, &mut pulled);
        (pulled, away)
    }
}

impl Potential for Drag<'_> {
    fn stencils(&self, visit: &mut dyn FnMut(&[u32])) {
        self.stiffness.each(|row, column, _| visit(&[column, row]));
    }

    fn energy(&self, x: &[DVec3]) -> f64 {
        let (pulled, away) = self.pulled(x);
        0.5 * self.factor * pulled.iter().zip(&away).map(|(p, d)| p.dot(*d)).sum::<f64>()
    }

    fn gradient(&self, x: &[DVec3], out: &mut [DVec3]) {
        out.iter_mut().zip(self.pulled(x).0).for_each(|(out, p)| *out += self.factor * p);
    }

    fn hessian(&self, _x: &[DVec3], _projected: bool, out: &mut Assembly<'_>) {
        self.stiffness.each(|row, column, block| out.add(row, column, self.factor * *block));
    }
}
