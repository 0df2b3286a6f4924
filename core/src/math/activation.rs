//! Activation functions of networks, correctly rounded for every input.
//!
//! ```text
//! tanh x = t/(t + 2), t = e²ˣ − 1        σ(x) = 1/(1 + e⁻ˣ)        GELU(x) = x·σ(2·√(2/π)·(x + 0.044715·x³))
//! ```
//!
//! Source of GELU: Hendrycks and Gimpel 2016, the tanh form.

use super::exp::Exponential;
use super::float::abs;
use super::hard;
use super::rounding::{Elementary, correctly_rounded};
use super::wide::{Scaled, Wide};

/// [`tanh`].
#[derive(Debug)]
pub enum Tanh {}

impl Elementary for Tanh {
    const HARD: &'static [(u32, u32)] = &hard::TANH;

    fn special(x: f32) -> Option<f32> {
        match abs(x) {
            a if a.is_nan() => Some(f32::NAN),
            a if a < 2e-4 => Some(x), // nearest to x − x³/3
            a if a > 9.1 => Some(if x < 0.0 { -1.0 } else { 1.0 }),
            _ => None,
        }
    }

    fn evaluate<W: Wide>(x: f32) -> Scaled<W> {
        let t = Exponential::new(W::new(2.0 * x)).minus_one();
        (t / (t + W::new(2.0))).into()
    }
}

/// [`sigmoid`].
#[derive(Debug)]
pub enum Sigmoid {}

impl Elementary for Sigmoid {
    const HARD: &'static [(u32, u32)] = &hard::SIGMOID;

    fn special(x: f32) -> Option<f32> {
        match x {
            _ if x.is_nan() => Some(f32::NAN),
            ..-104.0 => Some(0.0),
            18.0.. => Some(1.0),
            -1e-8..1e-8 => Some(0.5),
            _ => None,
        }
    }

    fn evaluate<W: Wide>(x: f32) -> Scaled<W> {
        /// `1 − 2⁻²⁷`: stands for `1 − x²/12`, which `f64` cannot tell from 1 in the sum. Both are too
        /// near 1 to cross a middle, but may start on one: `x/4` has 24 bits.
        const SHY: f64 = 1.0 - 1.0 / 134_217_728.0;
        if abs(x) < 2e-4 {
            return (W::new(0.5) + W::new(0.25 * x) * W::constant(SHY)).into();
        }
        logistic(W::new(1.0), W::new(x))
    }
}

/// [`gelu`].
#[derive(Debug)]
pub enum Gelu {}

impl Elementary for Gelu {
    const HARD: &'static [(u32, u32)] = &hard::GELU;

    fn special(x: f32) -> Option<f32> {
        match x {
            _ if x.is_nan() => Some(f32::NAN),
            ..-12.5 => Some(-0.0),
            10.0.. => Some(x),
            _ if abs(x) < 2.0 * f32::MIN_POSITIVE => Some(half_of_subnormal(x)),
            -1e-9..1e-9 => Some(0.5 * x),
            _ => None,
        }
    }

    fn evaluate<W: Wide>(x: f32) -> Scaled<W> {
        /// `2√(2/π)` and the same times 0.044715.
        const G: [f64; 2] = [f64::from_bits(0x3ff9_8845_33d4_3651), f64::from_bits(0x3fb2_444f_2a4d_8b4b)];
        let x = W::new(x);
        logistic(x, x * (W::constant(G[0]) + W::constant(G[1]) * (x * x)))
    }
}

/// `x/2` for a subnormal result, the next larger number where that lies between two: `x·σ` is a hair larger.
fn half_of_subnormal(x: f32) -> f32 {
    let sign = x.to_bits() & 0x8000_0000;
    let magnitude = x.to_bits() & 0x7fff_ffff;
    f32::from_bits(sign | ((magnitude + u32::from(sign == 0)) >> 1))
}

/// `a/(1 + e⁻ᵛ)`, `|v| ≤ 150`, with the factor `eᵛ` of a negative `v` kept apart.
#[inline]
fn logistic<W: Wide>(a: W, v: W) -> Scaled<W> {
    let one = W::new(1.0);
    if v.head() < 0.0 {
        let e = Exponential::new(v);
        let Scaled { m, k } = e.scaled();
        Scaled { m: a * m / (one + e.value()), k }
    } else {
        (a / (one + Exponential::new(-v).value())).into()
    }
}

/// `tanh x`. NaN for NaN.
#[must_use]
pub fn tanh(x: f32) -> f32 {
    correctly_rounded::<Tanh>(x)
}

/// The logistic function `1/(1 + e⁻ˣ)`. NaN for NaN.
#[must_use]
pub fn sigmoid(x: f32) -> f32 {
    correctly_rounded::<Sigmoid>(x)
}

/// The Gaussian error linear unit in its tanh form, `x/2·(1 + tanh(√(2/π)·(x + 0.044715·x³)))`. NaN for NaN.
#[must_use]
pub fn gelu(x: f32) -> f32 {
    correctly_rounded::<Gelu>(x)
}
