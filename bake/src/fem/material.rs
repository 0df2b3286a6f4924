//! Materials by what a stretched bar shows.

/// Lamé's parameters, Pa.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lame {
    /// Shear modulus `μ`.
    pub mu: f64,
    /// Lamé's first parameter `λ`.
    pub lambda: f64,
}

/// A material that cannot be.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum MaterialError {
    /// Young's modulus is not above 0.
    #[error("Young's modulus is {0} Pa; it must be above 0 and finite: fat has about 15000, muscle 45000")]
    Modulus(f64),
    /// Poisson's ratio does not lie between -1 and 0.5.
    #[error("Poisson's ratio is {0}; it must be above -1 and below 0.5: flesh has 0.45 to 0.49")]
    Ratio(f64),
}

impl Lame {
    /// Of a material with Young's modulus `e`, Pa, and Poisson's ratio `nu`:
    /// `μ = E/(2(1 + ν))`, `λ = Eν/((1 + ν)(1 − 2ν))`.
    ///
    /// # Errors
    ///
    /// If there is no such material.
    ///
    /// ```
    /// use sinew_bake::fem::material::Lame;
    /// let fat = Lame::new(15_000.0, 0.47)?;
    /// assert_eq!((fat.mu.round(), fat.lambda.round()), (5_102.0, 79_932.0));
    /// assert!(Lame::new(15_000.0, 0.5).is_err());
    /// # Ok::<(), sinew_bake::fem::material::MaterialError>(())
    /// ```
    pub fn new(e: f64, nu: f64) -> Result<Self, MaterialError> {
        if !(e > 0.0 && e.is_finite()) {
            return Err(MaterialError::Modulus(e));
        }
        if !(nu > -1.0 && nu < 0.5) {
            return Err(MaterialError::Ratio(nu));
        }
        Ok(Self { mu: e / (2.0 * (1.0 + nu)), lambda: e * nu / ((1.0 + nu) * (1.0 - 2.0 * nu)) })
    }

    /// Young's modulus, Pa.
    #[must_use]
    pub fn young(&self) -> f64 {
        self.mu * (3.0 * self.lambda + 2.0 * self.mu) / (self.lambda + self.mu)
    }
}
