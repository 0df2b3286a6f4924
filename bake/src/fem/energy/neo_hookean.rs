//! Stable Neo-Hookean.
//!
//! ```text
//! ψ = μ/2 (|F|² − 3) + λ/2 ((J − α)² − (1 − α)²),   α = 1 + μ/λ
//! ```
//!
//! The constant makes it 0 at rest, so that small energies keep their digits.
//! No barrier: finite when flat or inverted (Smith, De Goes, Kim 2018). To second order at rest it is
//! `μ|ε|² + (λ − μ)/2 tr(ε)²`, so its `λ` must be Lamé's plus `μ` for the material that was asked for.

use super::{Energy, others};
use crate::fem::material::Lame;

/// Flesh.
#[derive(Clone, Copy, Debug)]
pub struct NeoHookean {
    mu: f64,
    lambda: f64,
    alpha: f64,
}

impl NeoHookean {
    /// With Lamé's parameters at rest.
    #[must_use]
    pub fn new(material: Lame) -> Self {
        let (mu, lambda) = (material.mu, material.lambda + material.mu);
        Self { mu, lambda, alpha: 1.0 + mu / lambda }
    }

    /// `λ(J − α)`.
    fn pressure(&self, [a, b, c]: [f64; 3]) -> f64 {
        self.lambda * (a * b * c - self.alpha)
    }
}

impl Energy for NeoHookean {
    fn density(&self, s: [f64; 3]) -> f64 {
        let [a, b, c] = s;
        let j = a * b * c;
        // (J − α)² − (1 − α)² is a product.
        0.5 * self.mu * (a * a + b * b + c * c - 3.0)
            + 0.5 * self.lambda * (j - 1.0) * (j + 1.0 - 2.0 * self.alpha)
    }

    fn gradient(&self, s: [f64; 3]) -> [f64; 3] {
        let p = self.pressure(s);
        [0, 1, 2].map(|i| self.mu * s[i] + p * others(s, i).0)
    }

    fn second(&self, s: [f64; 3]) -> [[f64; 3]; 3] {
        let (p, cofactor) = (self.pressure(s), [0, 1, 2].map(|i| others(s, i).0));
        [0, 1, 2].map(|i| {
            [0, 1, 2].map(|j| {
                let own = if i == j { self.mu } else { p * s[3 - i - j] };
                self.lambda * cofactor[i] * cofactor[j] + own
            })
        })
    }

    fn flip(&self, s: [f64; 3], k: usize) -> f64 {
        self.mu - self.pressure(s) * s[k]
    }

    fn twist(&self, s: [f64; 3], k: usize) -> f64 {
        self.mu + self.pressure(s) * s[k]
    }
}
