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
//! branches keep each free of cancellation: a power series for small arguments, divided
//! differences of φ functions when clearly overdamped, trigonometric or near-critical otherwise.

use super::float::{exp, expm1, horner, sin_cos, sqrt};

/// `1/k!` for `k = 0 … 4`.
const INV_FACTORIAL: [f32; 5] = [1.0, 1.0, 0.5, 1.0 / 6.0, 1.0 / 24.0];

/// Returns `[Ψ₀, Ψ₁, Ψ₂, Ψ₃, Ψ₄]` for `a = kd·h ≥ 0`, `b = ks·h² ≥ 0` (dimensionless).
#[must_use]
pub fn psi(a: f32, b: f32) -> [f32; 5] {
    debug_assert!(a >= 0.0 && b >= 0.0, "psi: a = {a}, b = {b}");
    let half = 0.5 * a;
    let u = half * half - b;
    if a <= 2.0 && b <= 2.0 {
        series(a, b)
    } else if u >= 0.25 && b < 0.5 * half * half {
        overdamped(b, half, u)
    } else {
        oscillating(a, b, half, u)
    }
}

/// Series `Ψₖ = Σₘ gₘ/(m+k)!`, `g₀ = 1`, `g₁ = −a`, `gₘ = −a·gₘ₋₁ − b·gₘ₋₂` for Ψ₄ and Ψ₃, then downward.
fn series(a: f32, b: f32) -> [f32; 5] {
    let (mut g0, mut g1) = (0.0_f32, 1.0_f32);
    let (mut c3, mut c4) = (INV_FACTORIAL[3], INV_FACTORIAL[4]);
    let (mut p3, mut p4) = (0.0_f32, 0.0_f32);
    let mut m = 0.0_f32;
    for _ in 0..18 {
        p3 += g1 * c3;
        p4 += g1 * c4;
        (g0, g1) = (g1, -a * g1 - b * g0);
        m += 1.0;
        c3 /= m + 3.0;
        c4 /= m + 4.0;
    }
    let p2 = 0.5 - a * p3 - b * p4;
    let p1 = 1.0 - a * p2 - b * p3;
    let p0 = 1.0 - a * p1 - b * p2;
    [p0, p1, p2, p3, p4]
}

/// Divided differences of `φₖ` at the roots `l1 > l2` of `z² + a·z + b`; `l1` without cancellation.
fn overdamped(b: f32, half: f32, u: f32) -> [f32; 5] {
    let del = sqrt(u);
    let (l1, l2) = (-b / (half + del), -(half + del));
    let (f1, f2) = (phi(l1), phi(l2));
    let mut out = [0.0; 5];
    for (k, out) in out.iter_mut().enumerate() {
        *out = (f1[k] - f2[k]) / (2.0 * del);
    }
    out
}

/// `[z·eᶻ, φ₀, φ₁, φ₂, φ₃]` for `z ≤ 0`; `φ₀ = eᶻ`, `φₖ₊₁ = (φₖ − 1/k!)/z`.
fn phi(z: f32) -> [f32; 5] {
    /// Taylor of φ₃, highest power first: `1/(k+3)!` for `k = 9 … 0`; truncation below 2e-10 for `−1 < z ≤ 0`.
    const PHI3: [f32; 10] = [
        1.0 / 479_001_600.0,
        1.0 / 39_916_800.0,
        1.0 / 3_628_800.0,
        1.0 / 362_880.0,
        1.0 / 40_320.0,
        1.0 / 5_040.0,
        1.0 / 720.0,
        1.0 / 120.0,
        1.0 / 24.0,
        1.0 / 6.0,
    ];
    if z > -1.0 {
        let p3 = horner(&PHI3, z);
        let p2 = z * p3 + 0.5;
        let p1 = z * p2 + 1.0;
        let p0 = z * p1 + 1.0;
        [z * p0, p0, p1, p2, p3]
    } else {
        let p0 = exp(z);
        let p1 = expm1(z) / z;
        let p2 = (p1 - 1.0) / z;
        let p3 = (p2 - 0.5) / z;
        [z * p0, p0, p1, p2, p3]
    }
}

/// Underdamped or near critical (`b > 0.5`): Ψ₀ and Ψ₁, then upward by the recurrence.
fn oscillating(a: f32, b: f32, half: f32, u: f32) -> [f32; 5] {
    let (p0, p1) = if u > 1.0 {
        let del = sqrt(u);
        let slow = exp(-b / (half + del));
        let q = -expm1(-2.0 * del);
        let p1 = slow * q / (2.0 * del);
        (slow * (1.0 - 0.5 * q) - half * p1, p1)
    } else {
        let (c, s) = entire_pair(u);
        let e = exp(-half);
        (e * (c - half * s), e * s)
    };
    let p2 = (1.0 - p0 - a * p1) / b;
    let p3 = (1.0 - p1 - a * p2) / b;
    let p4 = (0.5 - p2 - a * p3) / b;
    [p0, p1, p2, p3, p4]
}

/// The entire functions `C(u) = cosh √u`, `S(u) = sinh √u / √u` of the signed `u ≤ 1`.
#[must_use]
pub fn entire_pair(u: f32) -> (f32, f32) {
    /// `1/(2k)!` for `k = 5 … 0`.
    const C: [f32; 6] = [1.0 / 3_628_800.0, 1.0 / 40_320.0, 1.0 / 720.0, 1.0 / 24.0, 0.5, 1.0];
    /// `1/(2k+1)!` for `k = 5 … 0`.
    const S: [f32; 6] = [1.0 / 39_916_800.0, 1.0 / 362_880.0, 1.0 / 5_040.0, 1.0 / 120.0, 1.0 / 6.0, 1.0];
    if u > -1.0 {
        (horner(&C, u), horner(&S, u))
    } else {
        let r = sqrt(-u);
        let (sin, cos) = sin_cos(r);
        (cos, sin / r)
    }
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
                assert!(error <= 4e-7 * want[k].abs() + 6e-8, "psi{k}({a}, {b}): {} {}", got[k], want[k]);
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
                        let terms = [p[k], a * p[k + 1], b * p[k + 2]];
                        let size = terms.iter().fold(1.0_f32, |s, t| s.max(t.abs()));
                        let sum = terms[0] + terms[1] + terms[2] - INV_FACTORIAL[k];
                        assert!(sum.abs() <= 4e-6 * size, "k {k} a {a} b {b}: {sum}");
                    }
                }
            }
        }
    }
}
