//! Single operations of the machine, on awkward operands: every exponent, few and many bits set, specials.

use super::{Named, bits, bits_wide, of_words};
use core::hint::black_box;

type Unary = fn(f32) -> u64;
type Binary = fn(f32, f32) -> u64;

/// An operation whose operand the compiler cannot see.
const UNARY: [(&str, Unary); 9] = [
    ("sqrt", |x| bits(x.sqrt())),
    ("sqrt f64", |x| bits_wide(f64::from(x).sqrt())),
    ("libm sqrt", |x| bits(sinew::math::float::sqrt(x))),
    ("abs, neg", |x| bits(x.abs()) ^ bits(-x) << 32),
    ("round", |x| bits(x.round_ties_even()) ^ bits(x.floor()) << 32),
    #[allow(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "`as` saturates; that is tested"
    )]
    ("f32 to i32", |x| u64::from(x as i32 as u32)),
    #[allow(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "`as` saturates; that is tested"
    )]
    ("f32 to u8, i64", |x| u64::from(x as u8) ^ (x as i64 as u64)),
    #[allow(clippy::cast_precision_loss, clippy::cast_possible_wrap, reason = "rounding is tested")]
    ("integers to f32", |x| bits(x.to_bits() as f32) ^ bits(x.to_bits() as i32 as f32) << 32),
    ("f32 to f64", |x| bits_wide(x.into())),
];

/// As [`UNARY`].
const BINARY: [(&str, Binary); 9] = [
    ("add", |a, b| bits(a + b)),
    ("sub", |a, b| bits(a - b)),
    ("mul", |a, b| bits(a * b)),
    ("div", |a, b| bits(a / b)),
    ("mul, add", |a, b| bits(a * b + black_box(a)) ^ bits(black_box(b) - a * b) << 32),
    ("compare", |a, b| {
        u64::from(a < b) | u64::from(a <= b) << 1 | u64::from(a.to_bits() == b.to_bits()) << 2
    }),
    ("f64 add, mul", |a, b| {
        let (a, b) = (f64::from(a), f64::from(b));
        bits_wide(a + b) ^ bits_wide(a * b).rotate_left(32)
    }),
    ("f64 div", |a, b| bits_wide(f64::from(a) / f64::from(b))),
    #[allow(clippy::cast_possible_truncation, reason = "rounding is tested")]
    ("f64 to f32", |a, b| bits((f64::from(a) * f64::from(b)) as f32)),
];

/// Both signs of every second exponent with four significands, and the values beside the edges.
fn operands() -> Vec<f32> {
    let significands = [0, 1, 0x2a_aaab, 0x7f_ffff];
    let regular = (0..=255_u32).step_by(2).flat_map(move |e| significands.map(|m| e << 23 | m));
    let special = [0x7f80_0000, 0x7fc0_0000, 0x7f80_0001, 0x7f7f_ffff, 0x4b00_0001, 0x3f7f_ffff];
    regular.chain(special).flat_map(|w| [w, w | 1 << 31]).map(f32::from_bits).collect()
}

/// A digest an operation.
pub(crate) fn digests() -> Vec<Named> {
    let x = operands();
    let unary = UNARY.iter().map(|(name, f)| {
        let results = x.iter().map(|x| f(black_box(*x)));
        ((*name).to_owned(), of_words(results))
    });
    let binary = BINARY.iter().map(|(name, f)| {
        let pairs = x.iter().flat_map(|a| x.iter().map(move |b| (*a, *b)));
        ((*name).to_owned(), of_words(pairs.map(|(a, b)| f(black_box(a), black_box(b)))))
    });
    unary.chain(binary).collect()
}
