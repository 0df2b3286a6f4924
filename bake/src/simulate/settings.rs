//! What flesh is made of.

use crate::Error;
use crate::cage::{self, Resolution, Surface};
use crate::fem::dynamics::Rayleigh;
use crate::fem::material::Lame;
use glam::DVec3;
use serde_json::{Value, json};

/// Size of the character that moduli and accelerations are for, m: the diagonal of its box.
const SIZE: f64 = 1.5;

/// What a simulation is made of, and how finely.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// The cage, and what of it follows the bones.
    pub cage: cage::Options,
    /// Young's modulus, Pa, of a character one and a half metres large; others get one in proportion to the square of
    /// their size, so that all swing alike.
    pub young: f64,
    /// Poisson's ratio, `0..0.5`.
    pub ratio: f64,
    /// Density, kg/m³.
    pub density: f64,
    /// Acceleration, m/s², of a character one and a half metres large; others get one in proportion to their size. The
    /// shape at rest is free of stress.
    pub gravity: DVec3,
    /// Damping of motion.
    pub damping: Rayleigh,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            cage: cage::Options::default(),
            young: 15_000.0,
            ratio: 0.45,
            density: 1000.0,
            gravity: DVec3::ZERO,
            damping: Rayleigh { mass: 0.0, stiffness: 0.005 },
        }
    }
}

impl Settings {
    /// Coarse and quick, for a first look.
    #[must_use]
    pub fn draft() -> Self {
        let cage = cage::Options { resolution: Resolution::Vertices(400), ..cage::Options::default() };
        Self { cage, ..Self::default() }
    }

    /// The material for a character, and its size against that which the settings are for.
    pub(super) fn material(&self, name: &str, surface: &Surface) -> Result<(Lame, f64), Error> {
        let refused = |place: &str, what: String, remedy: &str| {
            Error::unusable(name, format!("setting `{place}`"), what, remedy)
        };
        let (low, high) = surface.bounds();
        let scale = (high - low).length() / SIZE;
        let lame = Lame::new(self.young, self.ratio)
            .and_then(|_| Lame::new(self.young * scale * scale, self.ratio))
            .map_err(|e| {
                refused("material", e.to_string(), "give a modulus above 0 and a ratio from 0 to 0.499")
            })?;
        if !(self.density > 0.0 && self.density.is_finite()) {
            return Err(refused("density", format!("{} kg/m³", self.density), "give a number above 0"));
        }
        if !self.gravity.is_finite() {
            return Err(refused("gravity", format!("{} m/s²", self.gravity), "give finite numbers"));
        }
        let damping = [self.damping.mass, self.damping.stiffness];
        if !damping.iter().all(|d| *d >= 0.0 && d.is_finite()) {
            return Err(refused("damping", format!("{damping:?}"), "give numbers of at least 0"));
        }
        Ok((lame, scale))
    }

    /// For the header of a dataset.
    #[must_use]
    pub fn to_json(&self) -> Value {
        let (resolution, hold) = (self.cage.resolution, self.cage.hold);
        json!({
            "cage": {
                "shape": format!("{:?}", self.cage.shape),
                "resolution": match resolution {
                    Resolution::Size(edge) => json!({ "size": edge }),
                    Resolution::Vertices(most) => json!({ "vertices": most }),
                },
                "joining": format!("{:?}", self.cage.joining),
                "hold": [hold.inner, hold.outer, hold.thin],
            },
            "young": self.young, "ratio": self.ratio, "density": self.density,
            "gravity": self.gravity.to_array(),
            "damping": [self.damping.mass, self.damping.stiffness],
        })
    }
}
