//! `eˣ`, `eˣ − 1` and `φ₁ … φ₃`, correctly rounded for every input.
//!
//! ```text
//! x = (32·k + j)·ln 2/32 + r,  |r| ≤ ln 2/64        eˣ = 2ᵏ·t·(1 + p),  t = 2^(j/32),  p = eʳ − 1
//! ```
//!
//! `p` is the Taylor polynomial of degree 7, truncation below 2⁻⁶⁴. Source of the reduction: Tang 1989.

use super::hard;
use super::rounding::{Elementary, correctly_rounded};
use super::wide::{Scaled, Wide, series};

/// 1.5·2²³: adding and subtracting it rounds `|x| < 2²²` to the nearest integer, ties to even.
pub(crate) const TO_INTEGER: f32 = 12_582_912.0;
/// 32/ln 2.
const INVERSE_STEP: f32 = f32::from_bits(0x4238_aa3b);
/// ln 2/32 in two parts; the first has 11 bits, so its product with `|n| ≤ 2¹³` is exact.
const STEP: f32 = f32::from_bits(0x3cb1_8000);
const STEP_REST: f64 = f64::from_bits(0xbedb_d010_5c61_0ca8);

/// `eˣ = 2ᵏ·t·(1 + p)`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Exponential<W> {
    t: W,
    p: W,
    k: i32,
}

impl<W: Wide> Exponential<W> {
    /// Reduces `x`, `|x| ≤ 150`.
    #[inline]
    pub(crate) fn new(x: W) -> Self {
        let n = (x.head() * INVERSE_STEP + TO_INTEGER) - TO_INTEGER;
        let r = (x - W::new(n * STEP)) - W::new(n) * W::constant(STEP_REST);
        let p = r + r * r * series(&EXP_TAIL, &[1.0 / 6.0, 1.0 / 2.0], r);
        #[allow(clippy::cast_possible_truncation, reason = "|n| < 2^13")]
        let n = n as i32;
        #[allow(clippy::cast_sign_loss, reason = "masked")]
        let t = W::ROOTS_OF_TWO[(n & 31) as usize];
        Self { t, p, k: n >> 5 }
    }

    /// `eˣ`.
    #[inline]
    pub(crate) fn scaled(self) -> Scaled<W> {
        Scaled { m: self.t + self.t * self.p, k: self.k }
    }

    /// `eˣ`, as a plain number, for `x ≤ 60`; 0 below 2⁻¹⁰⁰.
    #[inline]
    pub(crate) fn value(self) -> W {
        let Scaled { m, k } = self.scaled();
        if k < -100 { W::new(0.0) } else { m.scale(k) }
    }

    /// `eˣ − 1` without cancellation, for `x ≤ 60`; below 2⁻⁶⁴ the exponential is nothing beside −1.
    #[inline]
    pub(crate) fn minus_one(self) -> W {
        let t = self.t.scale(self.k.clamp(-64, 100));
        (t - W::new(1.0)) + t * self.p
    }
}

/// Of `(eʳ − 1 − r)/r²`: `1/k!` for `k = 7 … 4`.
const EXP_TAIL: [f64; 4] = [1.0 / 5_040.0, 1.0 / 720.0, 1.0 / 120.0, 1.0 / 24.0];

/// [`exp`].
#[derive(Debug)]
pub enum Exp {}

impl Elementary for Exp {
    const HARD: &'static [(u32, u32)] = &hard::EXP;

    fn special(x: f32) -> Option<f32> {
        match x {
            _ if x.is_nan() => Some(f32::NAN),
            88.75.. => Some(f32::INFINITY),
            ..-104.0 => Some(0.0),
            -1e-8..1e-8 => Some(1.0),
            _ => None,
        }
    }

    fn evaluate<W: Wide>(x: f32) -> Scaled<W> {
        Exponential::new(W::new(x)).scaled()
    }
}

/// [`expm1`].
#[derive(Debug)]
pub enum Expm1 {}

impl Elementary for Expm1 {
    const HARD: &'static [(u32, u32)] = &hard::EXPM1;

    fn special(x: f32) -> Option<f32> {
        match x {
            _ if x.is_nan() => Some(f32::NAN),
            88.75.. => Some(f32::INFINITY),
            ..-20.0 => Some(-1.0),
            -1e-8..1e-8 => Some(x),
            _ => None,
        }
    }

    fn evaluate<W: Wide>(x: f32) -> Scaled<W> {
        let e = Exponential::new(W::new(x));
        if x < 60.0 { e.minus_one().into() } else { e.scaled() }
    }
}

/// `eˣ`: infinite above 88.73, through the subnormals to 0 below −103.97. NaN for NaN.
#[must_use]
pub fn exp(x: f32) -> f32 {
    correctly_rounded::<Exp>(x)
}

/// `eˣ − 1`, also near 0. NaN for NaN.
#[must_use]
pub fn expm1(x: f32) -> f32 {
    correctly_rounded::<Expm1>(x)
}

/// [`phi`] of the index `K` = 1, 2 or 3.
#[derive(Debug)]
pub enum Phi<const K: usize> {}

impl<const K: usize> Elementary for Phi<K> {
    const HARD: &'static [(u32, u32)] = match K {
        1 => &hard::PHI1,
        2 => &hard::PHI2,
        _ => &hard::PHI3,
    };

    fn special(x: f32) -> Option<f32> {
        const AT_0: [f32; 4] = [1.0, 1.0, 0.5, 1.0 / 6.0];
        /// 2⁶⁰: beyond, only the leading term of `−1/(x·(K−1)!) + …` counts.
        const FAR: f32 = f32::from_bits(0x5d80_0000);
        match x {
            _ if x.is_nan() => Some(f32::NAN),
            110.0.. => Some(f32::INFINITY),
            _ if x < -FAR => Some(if K == 3 { -0.5 / x } else { -1.0 / x }),
            -1e-8..1e-8 => Some(AT_0[K]),
            _ => None,
        }
    }

    fn evaluate<W: Wide>(x: f32) -> Scaled<W> {
        let z = W::new(x);
        if x < 60.0 {
            phi_wide(z)[K].into()
        } else {
            let Scaled { m, k } = Exponential::new(z).scaled();
            Scaled { m: (1..K).fold(m / z, |m, _| m / z), k }
        }
    }
}

/// `[eᶻ, φ₁, φ₂, φ₃]` of `z ≤ 60`; `φ₀ = eᶻ`, `φₖ₊₁ = (φₖ − 1/k!)/z`.
#[inline]
pub(crate) fn phi_wide<W: Wide>(z: W) -> [W; 4] {
    /// `1/(k+3)!` for `k = 16 … 7` and `6 … 0`: Taylor of φ₃, truncation below 2⁻⁵⁸ for `|z| ≤ 1`.
    const TAIL: [f64; 10] = {
        let mut c = [0.0; 10];
        let (mut factorial, mut k) = (1.0, 1);
        while k <= 19 {
            factorial *= k as f64;
            if k >= 10 {
                c[19 - k] = 1.0 / factorial;
            }
            k += 1;
        }
        c
    };
    const LEAD: [f64; 7] =
        [1.0 / 362_880.0, 1.0 / 40_320.0, 1.0 / 5_040.0, 1.0 / 720.0, 1.0 / 120.0, 1.0 / 24.0, 1.0 / 6.0];
    let (one, half) = (W::new(1.0), W::new(0.5));
    let near = z.head();
    if near > -1.0 && near < 1.0 {
        let p3 = series(&TAIL, &LEAD, z);
        let p2 = z * p3 + half;
        let p1 = z * p2 + one;
        [z * p1 + one, p1, p2, p3]
    } else {
        // Below −150 the exponential is nothing beside −1.
        let e = Exponential::new(if near < -150.0 { W::new(-150.0) } else { z });
        let p1 = e.minus_one() / z;
        let p2 = (p1 - one) / z;
        [e.value(), p1, p2, (p2 - half) / z]
    }
}

/// `φₖ(x)` for `k` = 1, 2 or 3: `φ₀ = eˣ`, `φₖ₊₁ = (φₖ − 1/k!)/x`, `φₖ(0) = 1/k!`.
///
/// The weights of exponential integrators: `φₖ(x) = ∫₀¹ e^((1−s)x)·s^(k−1)/(k−1)! ds`. NaN for NaN.
#[must_use]
pub fn phi<const K: usize>(x: f32) -> f32 {
    const { assert!(K >= 1 && K <= 3, "phi: K is 1, 2 or 3") };
    correctly_rounded::<Phi<K>>(x)
}
