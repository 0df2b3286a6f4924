//! St. Venant–Kirchhoff with a resistance to compression.
//!
//! ```text
//! ψ = μ|G|² + λ/2 tr(G)² + c·(1 − J)³ where J < 1,   G = (FᵀF − I)/2
//! ```
//!
//! Without the last term it gives way when pressed flat. With `c = 15000·E/((1 − 2ν)·2592)` it is what the data of the
//! Deep Emulator (Zheng et al. 2021) was made with.

use super::{Energy, others};
use crate::fem::material::Lame;

/// Flesh that gets stiffer when stretched.
#[derive(Clone, Copy, Debug)]
pub struct StVenantKirchhoff {
    mu: f64,
    lambda: f64,
    compression: f64,
}

impl StVenantKirchhoff {
    /// With a resistance to compression `c`, Pa; 0 for none.
    #[must_use]
    pub fn new(Lame { mu, lambda }: Lame, compression: f64) -> Self {
        Self { mu, lambda, compression }
    }

    /// With the resistance that is `resistance` in the files of Vega FEM: `c = r·E/((1 − 2ν)·2592)`.
    #[must_use]
    pub fn with_resistance(material: Lame, resistance: f64) -> Self {
        // E/(1 − 2ν) = 3λ + 2μ.
        Self::new(material, resistance * (3.0 * material.lambda + 2.0 * material.mu) / 2592.0)
    }

    /// `3c(1 − J)²` and `6c(1 − J)`, where pressed.
    fn pressed(&self, [a, b, c]: [f64; 3]) -> (f64, f64) {
        let less = (1.0 - a * b * c).max(0.0);
        (3.0 * self.compression * less * less, 6.0 * self.compression * less)
    }
}

/// `σ₁² + σ₂² + σ₃² − 3`.
fn growth([a, b, c]: [f64; 3]) -> f64 {
    a * a + b * b + c * c - 3.0
}

impl Energy for StVenantKirchhoff {
    fn density(&self, s: [f64; 3]) -> f64 {
        let shear: f64 = s.iter().map(|s| (s * s - 1.0) * (s * s - 1.0)).sum();
        let less = (1.0 - s[0] * s[1] * s[2]).max(0.0);
        0.25 * self.mu * shear
            + 0.125 * self.lambda * growth(s) * growth(s)
            + self.compression * less * less * less
    }

    fn gradient(&self, s: [f64; 3]) -> [f64; 3] {
        let (first, _) = self.pressed(s);
        let even = 0.5 * self.lambda * growth(s);
        [0, 1, 2].map(|i| (self.mu * (s[i] * s[i] - 1.0) + even) * s[i] - first * others(s, i).0)
    }

    fn second(&self, s: [f64; 3]) -> [[f64; 3]; 3] {
        let (first, second) = self.pressed(s);
        let even = 0.5 * self.lambda * growth(s);
        [0, 1, 2].map(|i| {
            [0, 1, 2].map(|j| {
                let own =
                    if i == j { self.mu * (3.0 * s[i] * s[i] - 1.0) + even } else { -first * s[3 - i - j] };
                self.lambda * s[i] * s[j] + second * others(s, i).0 * others(s, j).0 + own
            })
        })
    }

    fn flip(&self, s: [f64; 3], k: usize) -> f64 {
        let (product, sum) = others(s, k);
        self.mu * (sum * sum - product - 1.0) + 0.5 * self.lambda * growth(s) + self.pressed(s).0 * s[k]
    }

    fn twist(&self, s: [f64; 3], k: usize) -> f64 {
        let (product, sum) = others(s, k);
        self.mu * (sum * sum - 3.0 * product - 1.0) + 0.5 * self.lambda * growth(s) - self.pressed(s).0 * s[k]
    }
}
