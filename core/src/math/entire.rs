//! `C(u) = cosh √u`, `S(u) = sinh √u/√u` of the signed `u`, `sinh(x)/x`, and `1/√x`.
//!
//! The two are entire functions: `C = Σ uᵏ/(2k)!`, `S = Σ uᵏ/(2k+1)!`. With `w = √|u|`, `t = eʷ − 1`
//!
//! ```text
//! u > 0:  C = 1 + t²/(2(t + 1)),   S = (t + t/(t + 1))/(2w)          u < 0:  C = cos w,  S = sin w/w
//! ```
//!
//! The source of the underdamped, critical and overdamped spring in one: Jin et al. 2022, equations 9 to 11.

use super::exp::Exponential;
use super::float::abs;
use super::hard;
use super::rounding::{Elementary, correctly_rounded};
use super::trig::sin_cos_wide;
use super::wide::{Scaled, Wide};

/// Smallest `u`: below it counts as this, so that the result is bounded.
const LOWEST: f32 = -262_144.0;

/// 2⁻³⁶: the rounding of `w` up to 512 turns the angle, whatever is left of the cosine.
const UNCERTAINTY: f32 = f32::from_bits(0x2d80_0000);

/// `(C(u), S(u))` for `−512² ≤ u ≤ 60²`.
#[inline]
pub(crate) fn entire_wide<W: Wide>(u: W) -> (W, W) {
    let one = W::new(1.0);
    if abs(u.head()) < 1e-12 {
        (one, one)
    } else if u.head() > 0.0 {
        let w = u.sqrt();
        let t = Exponential::new(w).minus_one();
        let d = t / (t + one);
        (one + t * d * W::new(0.5), (t + d) / (w + w))
    } else {
        let w = (-u).sqrt();
        let (s, c) = sin_cos_wide(w);
        (c, s / w)
    }
}

/// [`entire_c`].
#[derive(Debug)]
pub enum EntireC {}

impl Elementary for EntireC {
    const HARD: &'static [(u32, u32)] = &hard::ENTIRE_C;
    const UNCERTAINTY: f32 = UNCERTAINTY;

    fn special(u: f32) -> Option<f32> {
        special(u)
    }

    fn evaluate<W: Wide>(u: f32) -> Scaled<W> {
        if u < 3_600.0 {
            entire_wide(W::new(if u < LOWEST { LOWEST } else { u })).0.into()
        } else {
            let Scaled { m, k } = Exponential::new(W::new(u).sqrt()).scaled();
            Scaled { m, k: k - 1 }
        }
    }
}

/// [`entire_s`].
#[derive(Debug)]
pub enum EntireS {}

impl Elementary for EntireS {
    const HARD: &'static [(u32, u32)] = &hard::ENTIRE_S;
    const UNCERTAINTY: f32 = UNCERTAINTY;

    fn special(u: f32) -> Option<f32> {
        special(u)
    }

    fn evaluate<W: Wide>(u: f32) -> Scaled<W> {
        if u < 3_600.0 {
            entire_wide(W::new(if u < LOWEST { LOWEST } else { u })).1.into()
        } else {
            let w = W::new(u).sqrt();
            let Scaled { m, k } = Exponential::new(w).scaled();
            Scaled { m: m / w, k: k - 1 }
        }
    }
}

/// What `C` and `S` have in common.
fn special(u: f32) -> Option<f32> {
    match u {
        _ if u.is_nan() => Some(f32::NAN),
        9_025.0.. => Some(f32::INFINITY), // 95²
        -1e-8..1e-8 => Some(1.0),
        _ => None,
    }
}

/// [`sinhc`].
#[derive(Debug)]
pub enum Sinhc {}

impl Elementary for Sinhc {
    const HARD: &'static [(u32, u32)] = &hard::SINHC;

    fn special(x: f32) -> Option<f32> {
        match abs(x) {
            a if a.is_nan() => Some(f32::NAN),
            a if a > 95.0 => Some(f32::INFINITY),
            a if a < 2e-4 => Some(1.0),
            _ => None,
        }
    }

    fn evaluate<W: Wide>(x: f32) -> Scaled<W> {
        let a = W::new(abs(x));
        let e = Exponential::new(a);
        if a.head() < 60.0 {
            let t = e.minus_one();
            ((t + t / (t + W::new(1.0))) / (a + a)).into()
        } else {
            let Scaled { m, k } = e.scaled();
            Scaled { m: m / a, k: k - 1 }
        }
    }
}

/// [`rsqrt`].
#[derive(Debug)]
pub enum Rsqrt {}

impl Elementary for Rsqrt {
    const HARD: &'static [(u32, u32)] = &hard::RSQRT;

    fn special(x: f32) -> Option<f32> {
        match x {
            0.0 => Some(f32::INFINITY),
            f32::INFINITY => Some(0.0),
            0.0.. => None,
            _ => Some(f32::NAN),
        }
    }

    fn evaluate<W: Wide>(x: f32) -> Scaled<W> {
        /// 2⁸⁰: lifts what has a subnormal low part.
        const LIFT: f32 = f32::from_bits(0x6780_0000);
        let (x, k) = if x < 1e-18 { (x * LIFT, 40) } else { (x, 0) };
        Scaled { m: W::new(1.0) / W::new(x).sqrt(), k }
    }
}

/// `C(u) = cosh √u` for `u ≥ 0`, `cos √−u` for `u < 0`; `u` below −512² counts as that. NaN for NaN.
#[must_use]
pub fn entire_c(u: f32) -> f32 {
    correctly_rounded::<EntireC>(u)
}

/// `S(u) = sinh √u/√u` for `u > 0`, `sin √−u/√−u` for `u < 0`; `u` below −512² counts as that. NaN for NaN.
#[must_use]
pub fn entire_s(u: f32) -> f32 {
    correctly_rounded::<EntireS>(u)
}

/// `sinh(x)/x`, 1 at 0. NaN for NaN.
#[must_use]
pub fn sinhc(x: f32) -> f32 {
    correctly_rounded::<Sinhc>(x)
}

/// `1/√x`: infinite at ±0, NaN below.
#[must_use]
pub fn rsqrt(x: f32) -> f32 {
    correctly_rounded::<Rsqrt>(x)
}
