//! The elementary functions and the spring's, by both ways of evaluating them.

use super::{Named, bits, of_words};
use sinew::kernel::spring::{Response, Spring};
use sinew::math::activation::{Gelu, Sigmoid, Tanh};
use sinew::math::entire::{EntireC, EntireS, Rsqrt, Sinhc};
use sinew::math::exp::{Exp, Expm1, Phi};
use sinew::math::psi::psi;
use sinew::math::rounding::{Elementary, by_doubles, by_twins, correctly_rounded};
use sinew::math::theta::theta;
use sinew::math::trig::{Acos, Cos, Sin};

/// Every so manieth bit pattern is tried: a prime, so that all digits of the significand take part.
const STRIDE: usize = 300_007;

type Body = fn(f32) -> f32;

/// In `f64`, in pairs of `f32`, and as this machine chooses.
const fn bodies<F: Elementary>() -> [Body; 3] {
    [by_doubles::<F>, by_twins::<F>, correctly_rounded::<F>]
}

const FUNCTIONS: [(&str, [Body; 3]); 15] = [
    ("exp", bodies::<Exp>()),
    ("expm1", bodies::<Expm1>()),
    ("phi1", bodies::<Phi<1>>()),
    ("phi2", bodies::<Phi<2>>()),
    ("phi3", bodies::<Phi<3>>()),
    ("sin", bodies::<Sin>()),
    ("cos", bodies::<Cos>()),
    ("acos", bodies::<Acos>()),
    ("tanh", bodies::<Tanh>()),
    ("sigmoid", bodies::<Sigmoid>()),
    ("gelu", bodies::<Gelu>()),
    ("entire_c", bodies::<EntireC>()),
    ("entire_s", bodies::<EntireS>()),
    ("sinhc", bodies::<Sinhc>()),
    ("rsqrt", bodies::<Rsqrt>()),
];

/// Three digests of a function, two of the plane of springs.
pub(crate) fn digests() -> Vec<Named> {
    let inputs = || (0..=u32::MAX).step_by(STRIDE).map(f32::from_bits);
    let mut all = Vec::new();
    for (name, bodies) in FUNCTIONS {
        for (way, f) in ["in f64", "in pairs", ""].into_iter().zip(bodies) {
            all.push((format!("{name} {way}").trim_end().to_owned(), of_words(inputs().map(|x| bits(f(x))))));
        }
    }
    let of = |f: fn(f32, f32) -> [f32; 5]| of_words(plane().flat_map(|(a, b)| f(a, b)).map(bits));
    all.push(("psi".to_owned(), of(psi)));
    all.push(("theta".to_owned(), of(theta)));
    all.push(("spring response".to_owned(), of_words(responses().map(bits))));
    all
}

/// `(a, b) = (ks·h², kd·h)`: powers of two with three significands, and the critical curve with its neighbors.
fn plane() -> impl Iterator<Item = (f32, f32)> {
    let axis = || {
        (67..160_u32).step_by(2).flat_map(|e| [0, 0x35_04f3, 0x7f_ffff].map(|m| f32::from_bits(e << 23 | m)))
    };
    let grid = axis().flat_map(move |a| axis().map(move |b| (a, b)));
    let critical =
        axis().flat_map(|b| (0..9_u32).map(move |i| (f32::from_bits((0.25 * b * b).to_bits() + i - 4), b)));
    grid.chain(critical).chain([(0.0, 0.0), (0.0, 1.0), (1.0, 0.0), (-0.0, -0.0)])
}

fn responses() -> impl Iterator<Item = f32> {
    let steps = [1.0 / 240.0, 1.0 / 144.0, 1.0 / 60.0, 1.0 / 24.0, 0.25];
    let springs = (0..16_u8).flat_map(|i| (0..16_u8).map(move |j| (f32::from(i) * 0.4, f32::from(j) * 0.13)));
    springs
        .flat_map(move |(hz, zeta)| steps.map(|h| Response::new(Spring::new(hz, zeta), h)))
        .flat_map(|r| [r.y, r.u])
        .flatten()
}
