//! `Θ₋₁ … Θ₃`: the derivatives of [`Ψ`](super::psi) by damping and stiffness, for training.
//!
//! ```text
//! ∂Ψₖ/∂b = −Θₖ,   ∂Ψₖ/∂a = −Θₖ₋₁
//! Θₖ + a·Θₖ₊₁ + b·Θₖ₊₂ = Ψₖ₊₂        2·Θₖ₋₁ + a·Θₖ = Ψₖ − (k − 1)·Ψₖ₊₁
//! ```
//!
//! Entire functions like `Ψ`, in the same three branches. With `D = a² − 4b`, `r = (k+1)·Ψₖ₊₁ − Ψₖ`
//! and `s = Ψₖ₊₁ − k·Ψₖ₊₂`, overdamped
//!
//! ```text
//! Θₖ = (a·r − 2b·s)/D,   Θₖ₊₁ = (a·s − 2·r)/D
//! ```
//!
//! and elsewhere, as `dC/du = S/2` and `dS/du = (C − S)/2u =: T`,
//!
//! ```text
//! Θ₁ = e^(−a/2)·T(u),   Θ₀ = e^(−a/2)·(S(u)/2 − a/2·T(u))
//! ```
//!
//! Source: Jin et al. 2022, equations 15 to 20, in another form.

use super::entire::entire_wide;
use super::exp::Exponential;
use super::psi::{Regime, at_most, inverse_factorials, overdamped, upward};
use super::twin::Twin;
use super::wide::{Wide, series};

/// Returns `[Θ₋₁, Θ₀, Θ₁, Θ₂, Θ₃]` for `a = kd·h ≥ 0`, `b = ks·h² ≥ 0` (dimensionless).
///
/// For `a ≤ 10⁴`, `b ≤ (2π)²` the error is below 1 ulp of the largest.
///
/// # Examples
///
/// The derivative of `Ψ₂` by `b`, against a difference:
///
/// ```
/// use sinew::math::{psi::psi, theta::theta};
/// let (a, b, d) = (0.5, 4.0, 0.0625);
/// let slope = (psi(a, b + d)[2] - psi(a, b - d)[2]) / (2.0 * d);
/// assert!((slope + theta(a, b)[3]).abs() < 1e-5);
/// ```
#[must_use]
pub fn theta(a: f32, b: f32) -> [f32; 5] {
    psi_theta_wide(Twin::new(a), Twin::new(b)).1.map(Wide::head)
}

/// `Ψ₀ … Ψ₄` and `Θ₋₁ … Θ₃` in a wider number type.
#[must_use]
pub fn psi_theta_wide<W: Wide>(a: W, b: W) -> ([W; 5], [W; 5]) {
    match Regime::of(a, b) {
        Regime::Overdamped { a, b, half, root } => {
            let p = overdamped(b, half, root);
            (p, by_discriminant(a, b, root, &p))
        }
        Regime::Small { a, b } => downward(a, b),
        Regime::Oscillating { a, b, half, u } => {
            let (c, s) = entire_wide(u);
            let e = Exponential::new(-at_most(half, 150.0)).value();
            let p = upward(a, b, [e * (c - half * s), e * s]);
            let t = slope_of_s(u, c, s);
            let (t0, t1) = (e * (s * W::new(0.5) - half * t), e * t);
            let over = W::new(1.0) / b;
            let t2 = (p[2] - t0 - a * t1) * over;
            let t3 = (p[3] - t1 - a * t2) * over;
            (p, [p[1] - a * t0 - b * t1, t0, t1, t2, t3])
        }
    }
}

/// `Θₖ` for `k` = 0 and 2 in pairs, and `Θ₋₁` by the recurrence.
fn by_discriminant<W: Wide>(a: W, b: W, root: W, p: &[W; 5]) -> [W; 5] {
    let over = W::new(0.25) / (root * root);
    let two = W::new(2.0);
    let pair = |r: W, s: W| [(a * r - two * b * s) * over, (a * s - two * r) * over];
    let [t0, t1] = pair(p[1] - p[0], p[1]);
    let [t2, t3] = pair(W::new(3.0) * p[3] - p[2], p[3] - two * p[4]);
    [p[1] - a * t0 - b * t1, t0, t1, t2, t3]
}

/// Both recurrences from far up, where `Ψₖ` is nearly `1/k!` and `Θₖ` nearly `1/(k+2)!`.
fn downward<W: Wide>(a: W, b: W) -> ([W; 5], [W; 5]) {
    /// `1/k!` for `k = 21 … 0`; what is left out is below 2⁻⁶⁰ of `Θ₃`.
    const COEFFICIENTS: [f64; 22] = inverse_factorials(21);
    let zero = W::new(0.0);
    let (mut p, mut t) = ([zero; 5], [zero; 5]);
    for c in COEFFICIENTS {
        let (p0, t0) = (W::constant(c) - a * p[0] - b * p[1], p[1] - a * t[0] - b * t[1]);
        p = [p0, p[0], p[1], p[2], p[3]];
        t = [t0, t[0], t[1], t[2], t[3]];
    }
    (p, [p[1] - a * t[0] - b * t[1], t[0], t[1], t[2], t[3]])
}

/// `T(u) = dS/du`: by its series near 0, `Σ (k+1)·uᵏ/(2k+3)!`.
fn slope_of_s<W: Wide>(u: W, c: W, s: W) -> W {
    /// `(k+1)/(2k+3)!` for `k = 7 … 4` and `3 … 0`; truncation below 2⁻⁶⁰ for `|u| ≤ 1/4`.
    const TAIL: [f64; 4] =
        [8.0 / 355_687_428_096_000.0, 7.0 / 1_307_674_368_000.0, 6.0 / 6_227_020_800.0, 5.0 / 39_916_800.0];
    const LEAD: [f64; 4] = [4.0 / 362_880.0, 3.0 / 5_040.0, 2.0 / 120.0, 1.0 / 6.0];
    let near = u.head();
    if near > -0.25 && near < 0.25 { series(&TAIL, &LEAD, u) } else { (c - s) / (u + u) }
}
