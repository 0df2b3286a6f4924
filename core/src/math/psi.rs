//! `Ψ₀ … Ψ₄`: the step responses of a damped oscillator on unit time, in all regimes.
//!
//! With `h″ + a·h′ + b·h = 0`, `h(0) = 0`, `h′(0) = 1` on unit time,
//!
//! ```text
//! Ψ₀ = h′(1),   Ψ₁ = h(1),   Ψₖ₊₁ = repeated integral of h from 0 to 1,
//! Ψₖ + a·Ψₖ₊₁ + b·Ψₖ₊₂ = 1/k!        limits a = b = 0: Ψₖ = 1/k!
//! ```
//!
//! They are entire functions of `a ≥ 0` and `b ≥ 0`: no case of the damping is singular. Three
//! branches keep each free of cancellation beyond the spare digits of [`Wide`]: divided differences
//! of φ functions when clearly overdamped, the recurrence downward for small arguments, and upward
//! from `Ψ₀` and `Ψ₁` elsewhere. With `u = a²/4 − b` and `C`, `S` of [`super::entire`],
//!
//! ```text
//! Ψ₁ = e^(−a/2)·S(u),   Ψ₀ = e^(−a/2)·(C(u) − a/2·S(u))
//! ```
//!
//! Source: Jin et al. 2022, equations 7 to 13, in another form.

use super::entire::entire_wide;
use super::exp::{Exponential, phi_wide};
use super::twin::Twin;
use super::wide::Wide;

/// `1/k!` for `k = 0 … 4`.
const INV_FACTORIAL: [f64; 5] = [1.0, 1.0, 0.5, 1.0 / 6.0, 1.0 / 24.0];
/// From here on the sum by divided differences loses less than the spare digits.
const OVERDAMPED: f32 = 1.0 / 16.0;
/// From here on upward recurrence does.
const LARGE: f32 = 0.25;
/// A spring that turns more than 512 radians a step counts as one that turns as much.
const LARGEST_ANGLE: f32 = 512.0;
/// Far beyond any domain `a`, and `b`, are cut, so that their squares stay finite.
const LARGEST: [f32; 2] = [1e12, 1e30];

/// Returns `[Ψ₀, Ψ₁, Ψ₂, Ψ₃, Ψ₄]` for `a = kd·h ≥ 0`, `b = ks·h² ≥ 0` (dimensionless).
///
/// For `a ≤ 10⁴`, `b ≤ (2π)²` the error is below 1 ulp of the largest. Beyond, the values are finite
/// and those of a passive spring.
#[must_use]
pub fn psi(a: f32, b: f32) -> [f32; 5] {
    psi_wide(Twin::new(a), Twin::new(b)).map(Wide::head)
}

/// [`psi`] in a wider number type.
#[must_use]
pub fn psi_wide<W: Wide>(a: W, b: W) -> [W; 5] {
    match Regime::of(a, b) {
        Regime::Overdamped { b, half, root, .. } => overdamped(b, half, root),
        Regime::Small { a, b } => downward(a, b),
        Regime::Oscillating { a, b, half, u } => {
            let (c, s) = entire_wide(u);
            let e = Exponential::new(-at_most(half, 150.0)).value();
            upward(a, b, [e * (c - half * s), e * s])
        }
    }
}

/// Where `(a, b)` lies, with the arguments cut to what can be computed.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Regime<W> {
    /// `u ≥ 1/16`.
    Overdamped { a: W, b: W, half: W, root: W },
    /// `u < 1/16` and `b < 1/4`, so that `a < 1.2`.
    Small { a: W, b: W },
    /// `u < 1/16` and `b ≥ 1/4`: underdamped, critical, or beside it.
    Oscillating { a: W, b: W, half: W, u: W },
}

impl<W: Wide> Regime<W> {
    pub(crate) fn of(a: W, b: W) -> Self {
        let (a, b, u) = cut(a, b);
        let half = a * W::new(0.5);
        if u.head() >= OVERDAMPED {
            Self::Overdamped { a, b, half, root: u.sqrt() }
        } else if b.head() < LARGE {
            Self::Small { a, b }
        } else {
            Self::Oscillating { a, b, half, u }
        }
    }
}

/// `a` and `b` where they can be computed, and `u = a²/4 − b`: those of a passive spring, whatever was asked.
pub(crate) fn cut<W: Wide>(a: W, b: W) -> (W, W, W) {
    let (a, b) = (at_most(a, LARGEST[0]), at_most(b, LARGEST[1]));
    let half = a * W::new(0.5);
    let square = half * half;
    let u = square - b;
    let fastest = W::new(-LARGEST_ANGLE * LARGEST_ANGLE);
    if u.head() < fastest.head() { (a, square - fastest, fastest) } else { (a, b, u) }
}

/// The smaller of the two.
pub(crate) fn at_most<W: Wide>(x: W, limit: f32) -> W {
    if x.head() > limit { W::new(limit) } else { x }
}

/// Divided differences of `φₖ₋₁` at the roots `l₁ > l₂` of `z² + a·z + b`; `l₁` without cancellation.
pub(crate) fn overdamped<W: Wide>(b: W, half: W, root: W) -> [W; 5] {
    let far = half + root;
    let (l1, l2) = (-(b / far), -far);
    let (f1, f2) = (phi_wide(l1), phi_wide(l2));
    let over = W::new(0.5) / root;
    let (x, y) = ([l1 * f1[0], f1[0], f1[1], f1[2], f1[3]], [l2 * f2[0], f2[0], f2[1], f2[2], f2[3]]);
    let mut out = x;
    for (out, y) in out.iter_mut().zip(y) {
        *out = (*out - y) * over;
    }
    out
}

/// The recurrence from far up, where `Ψₖ` is nearly `1/k!`.
fn downward<W: Wide>(a: W, b: W) -> [W; 5] {
    /// `1/k!` for `k = 19 … 8` and `7 … 0`; what is left out is below 2⁻⁶⁰ of `Ψ₄`.
    const FAR: [f64; 12] = inverse_factorials(19);
    const NEAR: [f64; 8] = inverse_factorials(7);
    let (an, bn) = (a.narrow(), b.narrow());
    let zero = W::Narrow::constant(0.0);
    let (p, q) = FAR.iter().fold((zero, zero), |(p, q), c| (W::Narrow::constant(*c) - an * p - bn * q, p));
    let start = [W::widen(p), W::widen(q), W::new(0.0), W::new(0.0), W::new(0.0)];
    NEAR.iter().fold(start, |p, c| [W::constant(*c) - a * p[0] - b * p[1], p[0], p[1], p[2], p[3]])
}

/// `1/k!` for `k = first, first − 1, …`
pub(crate) const fn inverse_factorials<const N: usize>(first: usize) -> [f64; N] {
    let mut out = [0.0; N];
    let mut i = 0;
    while i < N {
        let (mut factorial, mut k) = (1.0, 2);
        while k <= first - i {
            factorial *= k as f64;
            k += 1;
        }
        out[i] = 1.0 / factorial;
        i += 1;
    }
    out
}

/// `Ψ₂, Ψ₃, Ψ₄` from the first two.
pub(crate) fn upward<W: Wide>(a: W, b: W, [p0, p1]: [W; 2]) -> [W; 5] {
    let over = W::new(1.0) / b;
    let next = |k: usize, p: W, q: W| (W::constant(INV_FACTORIAL[k]) - p - a * q) * over;
    let p2 = next(0, p0, p1);
    let p3 = next(1, p1, p2);
    [p0, p1, p2, p3, next(2, p2, p3)]
}
#[cfg(test)]
mod tests {
    use super::*;

    /// Test vectors computed with 40 digits: `(a, b) -> Ψ₀ … Ψ₄`.
    const VECTORS: [(f32, f32, [f64; 5]); 8] = [
        (
            0.0,
            1.0,
            [
                0.5403023058681397,
                0.8414709848078965,
                0.4596976941318603,
                0.1585290151921035,
                0.04030230586813972,
            ],
        ),
        (
            1.0,
            0.0,
            [
                0.3678794411714423,
                0.6321205588285577,
                0.3678794411714423,
                0.1321205588285577,
                0.03454610783810899,
            ],
        ),
        (2.0, 1.0, [0.0, 0.3678794411714423, 0.2642411176571154, 0.103638323514327, 0.02848223531423071]),
        (
            0.5,
            4.0,
            [
                -0.4027969566082157,
                0.3593979222635136,
                0.3057744988691147,
                0.1219287070754823,
                0.03331528689828604,
            ],
        ),
        (
            6.0,
            9.0,
            [
                -0.09957413673572789,
                0.04978706836786394,
                0.08898352516983825,
                0.0462568645125674,
                0.01483058752830637,
            ],
        ),
        (
            30.0,
            2.0,
            [
                -0.002092555823733038,
                0.03131842979980816,
                0.03126983091474411,
                0.01529332137893428,
                0.004965263858613707,
            ],
        ),
        (200.0, 10000.0, [-3.68e-42, 3.72e-44, 1e-4, 9.8e-5, 4.803e-5]),
        (0.0, 0.0, [1.0, 1.0, 0.5, 1.0 / 6.0, 1.0 / 24.0]),
    ];

    #[test]
    fn published_vectors_hold() {
        for (a, b, want) in VECTORS {
            let got = psi(a, b);
            for k in 0..5 {
                let error = (f64::from(got[k]) - want[k]).abs();
                assert!(error <= 6e-8 * want[k].abs() + 1e-15, "psi{k}({a}, {b}): {} {}", got[k], want[k]);
            }
        }
    }

    #[test]
    fn vectors_with_tiny_arguments_hold() {
        let got = psi(1000.0, 1e-3);
        let want = [-9.99999003000496e-10, 9.99999002000497e-4, 9.989995019971652e-4, 4.990008343303785e-4];
        for k in 1..4 {
            assert!((f64::from(got[k]) / want[k] - 1.0).abs() < 1e-6, "psi{k}: {}", got[k]);
        }
        assert!((f64::from(got[0]) - want[0]).abs() < 1e-9, "psi0: {}", got[0]);
    }

    /// `Ψₖ + a·Ψₖ₊₁ + b·Ψₖ₊₂ = 1/k!` over the promised plane, every branch and both sides of critical.
    #[test]
    fn recurrence_holds_in_every_branch() {
        for i in 0..200 {
            for j in 0..200 {
                #[allow(clippy::cast_precision_loss, reason = "a grid")]
                let (a, w) = (i as f32 * i as f32 * 0.25e-2, j as f32 * 0.0314);
                for b in [w * w, 0.25 * a * a, 0.25 * a * a * (1.0 + f32::EPSILON)] {
                    let p = psi(a, b);
                    for k in 0..3 {
                        let [x, y, z] = [p[k], p[k + 1], p[k + 2]].map(f64::from);
                        let (y, z) = (f64::from(a) * y, f64::from(b) * z);
                        let size = x.abs().max(y.abs()).max(z.abs()).max(1.0);
                        let sum = x + y + z - INV_FACTORIAL[k];
                        assert!(sum.abs() <= 1.2e-7 * size, "k {k} a {a} b {b}: {sum}");
                    }
                }
            }
        }
    }
}
