//! Forces that stay as they are: weight, pulls at a face.
//!
//! ```text
//! E = −Σ fᵢ·xᵢ
//! ```

use super::Potential;
use crate::fem::assembly::Assembly;
use crate::fem::mass::Mass;
use glam::DVec3;

/// A force on each node.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Load {
    /// N.
    pub forces: Vec<DVec3>,
}

impl Load {
    /// The weight of `mass` in an acceleration `g`, m/s²: that of a falling body, (0, −9.81, 0).
    #[must_use]
    pub fn weight(mass: &Mass, g: DVec3) -> Self {
        Self { forces: mass.lumped().diagonal.iter().map(|m| *m * g).collect() }
    }
}

impl Potential for Load {
    fn stencils(&self, _visit: &mut dyn FnMut(&[u32])) {}

    fn energy(&self, x: &[DVec3]) -> f64 {
        -self.forces.iter().zip(x).map(|(f, x)| f.dot(*x)).sum::<f64>()
    }

    fn gradient(&self, _x: &[DVec3], out: &mut [DVec3]) {
        out.iter_mut().zip(&self.forces).for_each(|(out, f)| *out -= *f);
    }

    fn hessian(&self, _x: &[DVec3], _projected: bool, _out: &mut Assembly<'_>) {}
}
