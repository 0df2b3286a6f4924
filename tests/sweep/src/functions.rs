//! The functions under test: both bodies of the runtime, a reference in `f64` with a bound of its error,
//! and the exact value by MPFR.

#![allow(clippy::disallowed_methods, reason = "std in f64 is the reference, MPFR decides")]
#![allow(clippy::approx_constant, reason = "places where the code changes its way")]

use rug::Float;
use rug::ops::NegAssign;
use sinew::math::activation::{Gelu, Sigmoid, Tanh};
use sinew::math::entire::{EntireC, EntireS, Rsqrt, Sinhc};
use sinew::math::exp::{Exp, Expm1, Phi};
use sinew::math::rounding::{Elementary, by_doubles, by_twins};
use sinew::math::trig::{Acos, Cos, Sin};

/// Bits of MPFR's numbers: the cancellation in φ₃ takes 160 of them.
const PRECISION: u32 = 400;
/// Relative errors of references: of one operation of the platform's library, and of a few more.
const ONE: f64 = 4.5e-16;
const FEW: f64 = 4.0e-15;

/// A function of one argument.
pub(crate) struct Function {
    /// As in the runtime.
    pub(crate) name: &'static str,
    /// Where the result is promised, for the table.
    pub(crate) domain: &'static str,
    /// Evaluated in `f64`, and in pairs of `f32`.
    pub(crate) bodies: [fn(f32) -> f32; 2],
    /// Inputs for which the runtime looks the result up, with these results.
    pub(crate) hard: &'static [(u32, u32)],
    /// Value in `f64`, with a bound of its relative error.
    pub(crate) reference: fn(f64) -> (f64, f64),
    /// The exact value.
    pub(crate) exact: fn(Float) -> Float,
    /// Arguments at which the code changes its way.
    pub(crate) branches: &'static [f32],
}

impl Function {
    /// The `f32` nearest to the exact value, and that value.
    pub(crate) fn nearest(&self, x: f32) -> (f32, f64) {
        let y = (self.exact)(Float::with_val(PRECISION, x));
        (y.to_f32(), y.to_f64())
    }
}

const fn bodies<F: Elementary>() -> [fn(f32) -> f32; 2] {
    [by_doubles::<F>, by_twins::<F>]
}

/// All of them.
pub(crate) const FUNCTIONS: [Function; 15] = [
    Function {
        name: "exp",
        domain: "all",
        bodies: bodies::<Exp>(),
        hard: Exp::HARD,
        reference: |x| (x.exp(), ONE),
        exact: Float::exp,
        branches: &[88.75, -104.0, -103.972_08, -87.336_55, 1e-8],
    },
    Function {
        name: "expm1",
        domain: "all",
        bodies: bodies::<Expm1>(),
        hard: Expm1::HARD,
        reference: |x| (x.exp_m1(), ONE),
        exact: Float::exp_m1,
        branches: &[88.75, -20.0, 60.0, 1e-8],
    },
    Function {
        name: "phi1",
        domain: "all",
        bodies: bodies::<Phi<1>>(),
        hard: <Phi<1> as Elementary>::HARD,
        reference: |x| if x == 0.0 { (1.0, 0.0) } else { far(x, 1).unwrap_or((x.exp_m1() / x, FEW)) },
        exact: |x| exact_phi(x, 1),
        branches: &[110.0, 60.0, 1.0, 150.0, 1e-8, 1.152_921_5e18],
    },
    Function {
        name: "phi2",
        domain: "all",
        bodies: bodies::<Phi<2>>(),
        hard: <Phi<2> as Elementary>::HARD,
        reference: |x| far(x, 2).unwrap_or_else(|| reference_phi(x, 2)),
        exact: |x| exact_phi(x, 2),
        branches: &[110.0, 60.0, 1.0, 150.0, 1e-8, 1.152_921_5e18],
    },
    Function {
        name: "phi3",
        domain: "all",
        bodies: bodies::<Phi<3>>(),
        hard: <Phi<3> as Elementary>::HARD,
        reference: |x| far(x, 3).unwrap_or_else(|| reference_phi(x, 3)),
        exact: |x| exact_phi(x, 3),
        branches: &[110.0, 60.0, 1.0, 150.0, 1e-8, 1.152_921_5e18],
    },
    Function {
        name: "sin",
        domain: "|x| <= 512, beyond as at 512",
        bodies: bodies::<Sin>(),
        hard: Sin::HARD,
        reference: |x| (x.clamp(-512.0, 512.0).sin(), ONE),
        exact: |x| x.clamp(&-512.0, &512.0).sin(),
        branches: &[512.0, 2e-4, 0.785_398_2, 1.570_796_4, 3.141_592_7, 6.283_185_5],
    },
    Function {
        name: "cos",
        domain: "|x| <= 512, beyond as at 512",
        bodies: bodies::<Cos>(),
        hard: Cos::HARD,
        reference: |x| (x.clamp(-512.0, 512.0).cos(), ONE),
        exact: |x| x.clamp(&-512.0, &512.0).cos(),
        branches: &[512.0, 2e-4, 0.785_398_2, 1.570_796_4, 3.141_592_7, 6.283_185_5],
    },
    Function {
        name: "acos",
        domain: "-1 <= x <= 1",
        bodies: bodies::<Acos>(),
        hard: Acos::HARD,
        reference: |x| (x.acos(), ONE),
        exact: Float::acos,
        branches: &[1.0, 0.5],
    },
    Function {
        name: "tanh",
        domain: "all",
        bodies: bodies::<Tanh>(),
        hard: Tanh::HARD,
        reference: |x| (x.tanh(), FEW),
        exact: Float::tanh,
        branches: &[2e-4, 9.1],
    },
    Function {
        name: "sigmoid",
        domain: "all",
        bodies: bodies::<Sigmoid>(),
        hard: Sigmoid::HARD,
        reference: |x| (1.0 / (1.0 + (-x).exp()), FEW),
        exact: |x| (Float::exp(-x) + 1_u32).recip(),
        branches: &[-104.0, 18.0, 1e-8],
    },
    Function {
        name: "gelu",
        domain: "all",
        bodies: bodies::<Gelu>(),
        hard: Gelu::HARD,
        reference: reference_gelu,
        exact: exact_gelu,
        branches: &[-12.5, 10.0, 1e-9],
    },
    Function {
        name: "entire_c",
        domain: "u >= -512^2, below as there",
        bodies: bodies::<EntireC>(),
        hard: EntireC::HARD,
        reference: |u| if u > 0.0 { (u.sqrt().cosh(), 2e-14) } else { reference_c(u) },
        exact: |u| if u > 0_u32 { u.sqrt().cosh() } else { (-u.max(&lowest())).sqrt().cos() },
        branches: &[9_025.0, 1e-8, 3_600.0, -262_144.0, -39.478_417, -2.467_401],
    },
    Function {
        name: "entire_s",
        domain: "u >= -512^2, below as there",
        bodies: bodies::<EntireS>(),
        hard: EntireS::HARD,
        reference: reference_s,
        exact: exact_s,
        branches: &[9_025.0, 1e-8, 3_600.0, -262_144.0, -39.478_417, -9.869_604],
    },
    Function {
        name: "sinhc",
        domain: "all",
        bodies: bodies::<Sinhc>(),
        hard: Sinhc::HARD,
        reference: |x| match x {
            0.0 => (1.0, 0.0),
            _ if x.is_infinite() => (f64::INFINITY, 0.0),
            _ => (x.sinh() / x, FEW),
        },
        exact: |x| if x.is_zero() { x + 1_u32 } else { Float::sinh(x.clone()) / x },
        branches: &[95.0, 60.0, 2e-4],
    },
    Function {
        name: "rsqrt",
        domain: "x >= 0",
        bodies: bodies::<Rsqrt>(),
        hard: Rsqrt::HARD,
        reference: |x| if x == 0.0 { (f64::INFINITY, 0.0) } else { (1.0 / x.sqrt(), ONE) },
        exact: |x| if x.is_zero() { x.abs().recip() } else { x.recip_sqrt() },
        branches: &[f32::MIN_POSITIVE],
    },
];

/// Where the runtime stops to follow `C` and `S`.
const LOWEST: f64 = -262_144.0;

fn lowest() -> Float {
    Float::with_val(PRECISION, LOWEST)
}

/// What φₖ is where it has left the range of numbers.
fn far(x: f64, k: i32) -> Option<(f64, f64)> {
    if x > 200.0 {
        Some((f64::INFINITY, 0.0))
    } else if x == f64::NEG_INFINITY {
        Some((0.0, 0.0))
    } else if x < -1e12 && k > 1 {
        Some((if k == 3 { -0.5 / x } else { -1.0 / x }, 3e-12))
    } else {
        None
    }
}

/// φ₂ or φ₃: Taylor near 0, recurrence elsewhere.
fn reference_phi(x: f64, k: i32) -> (f64, f64) {
    if x.abs() < 1.0 {
        let mut sum = 0.0;
        for n in (0..22).rev() {
            sum = (1.0 + sum) * x / f64::from(n + k + 1);
        }
        return ((1.0 + sum) / if k == 3 { 6.0 } else { 2.0 }, 4.0 * ONE);
    }
    let p2 = (x.exp_m1() / x - 1.0) / x;
    (if k == 3 { (p2 - 0.5) / x } else { p2 }, 16.0 * ONE)
}

fn exact_phi(x: Float, k: u32) -> Float {
    if x.is_zero() {
        return Float::with_val(PRECISION, [1, 1, 2, 6][k as usize]).recip();
    }
    let mut y = x.clone().exp_m1() / &x;
    for below in [1_u32, 2].iter().take(k as usize - 1) {
        y = (y - Float::with_val(PRECISION, *below).recip()) / &x;
    }
    y
}

fn reference_gelu(x: f64) -> (f64, f64) {
    if x.abs() > 20.0 {
        return (if x < 0.0 { -0.0 } else { x }, 0.0);
    }
    let v = 1.595_769_121_605_730_8 * (x + 0.044_715 * x * x * x);
    (x / (1.0 + (-v).exp()), FEW + ONE * v.abs())
}

fn exact_gelu(x: Float) -> Float {
    if x.is_infinite() {
        return if x.is_sign_negative() { Float::with_val(PRECISION, -0.0) } else { x };
    }
    let pi = Float::with_val(PRECISION, rug::float::Constant::Pi);
    let cube = Float::with_val(PRECISION, x.square_ref()) * &x * 44_715_u32 / 1_000_000_u32;
    let mut v = (cube + &x) * (Float::with_val(PRECISION, 8_u32) / pi).sqrt();
    v.neg_assign();
    x / (v.exp() + 1_u32)
}

/// `−u`, cut where the runtime cuts it; NaN stays.
fn at_least(u: f64) -> f64 {
    if u < LOWEST { -LOWEST } else { -u }
}

/// `C(u)` for `u ≤ 0`; the rounding of `w = √−u` turns the angle.
fn reference_c(u: f64) -> (f64, f64) {
    let w = at_least(u).sqrt();
    (w.cos(), ONE * (1.0 + w) / w.cos().abs())
}

fn reference_s(u: f64) -> (f64, f64) {
    if u == 0.0 {
        (1.0, 0.0)
    } else if u == f64::INFINITY {
        (u, 0.0)
    } else if u > 0.0 {
        (u.sqrt().sinh() / u.sqrt(), 2e-14)
    } else {
        let w = at_least(u).sqrt();
        (w.sin() / w, ONE * (2.0 + w / w.sin().abs()))
    }
}

fn exact_s(u: Float) -> Float {
    if u.is_zero() || u.is_infinite() && u.is_sign_positive() {
        return u + 1_u32;
    }
    if u > 0_u32 {
        let w = u.sqrt();
        return w.clone().sinh() / w;
    }
    let w = (-u.max(&lowest())).sqrt();
    w.clone().sin() / w
}
