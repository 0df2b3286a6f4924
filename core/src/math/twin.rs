//! Double-single arithmetic: the unevaluated sum of two `f32`, about 48 bits.
//!
//! Only `+ − × ÷ √` of `f32`, rounded to nearest, and no fused operation. Source: Dekker 1971 and Knuth,
//! TAOCP 2, 4.2.2 (error-free sums); Joldes, Muller and Popescu 2017, algorithms 6, 11 and 18.

use core::ops::{Add, Div, Mul, Neg, Sub};

use super::float;
use super::wide::{ROOTS_OF_TWO, Wide, power_of_two};

/// `hi + lo` with `hi` the nearest `f32` to the sum.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Twin {
    /// Leading digits.
    pub hi: f32,
    /// The rest.
    pub lo: f32,
}

/// `a + b` exactly, if `|a| ≥ |b|` or `a = 0`.
#[inline(always)]
pub(crate) fn quick_sum(a: f32, b: f32) -> Twin {
    let hi = a + b;
    Twin { hi, lo: b - (hi - a) }
}

/// `a + b` exactly.
#[inline(always)]
pub(crate) fn sum(a: f32, b: f32) -> Twin {
    let hi = a + b;
    let b1 = hi - a;
    Twin { hi, lo: (a - (hi - b1)) + (b - b1) }
}

/// `a·b` exactly, unless the low part is subnormal. Splits by masking: no overflow, no fused operation.
#[inline(always)]
pub(crate) fn product(a: f32, b: f32) -> Twin {
    let upper = |x: f32| f32::from_bits(x.to_bits() & 0xffff_f000);
    let (a1, b1) = (upper(a), upper(b));
    let (a2, b2) = (a - a1, b - b1);
    let hi = a * b;
    Twin { hi, lo: (((a1 * b1 - hi) + a1 * b2) + a2 * b1) + a2 * b2 }
}

impl Twin {
    /// The nearest pair to a constant.
    #[allow(clippy::cast_possible_truncation, reason = "rounds")]
    const fn nearest(c: f64) -> Self {
        let hi = c as f32;
        Self { hi, lo: (c - hi as f64) as f32 }
    }
}

impl Add for Twin {
    type Output = Self;
    #[cfg_attr(target_arch = "wasm32", inline(never))] // size counts
    fn add(self, b: Self) -> Self {
        let (s, t) = (sum(self.hi, b.hi), sum(self.lo, b.lo));
        let v = quick_sum(s.hi, s.lo + t.hi);
        quick_sum(v.hi, t.lo + v.lo)
    }
}

impl Neg for Twin {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self { hi: -self.hi, lo: -self.lo }
    }
}

impl Sub for Twin {
    type Output = Self;
    #[inline(always)]
    fn sub(self, b: Self) -> Self {
        self + -b
    }
}

impl Mul for Twin {
    type Output = Self;
    #[cfg_attr(target_arch = "wasm32", inline(never))] // size counts
    fn mul(self, b: Self) -> Self {
        let p = product(self.hi, b.hi);
        quick_sum(p.hi, p.lo + (self.hi * b.lo + self.lo * b.hi))
    }
}

impl Div for Twin {
    type Output = Self;
    #[cfg_attr(target_arch = "wasm32", inline(never))] // size counts
    fn div(self, b: Self) -> Self {
        let q = self.hi / b.hi;
        let p = product(q, b.hi);
        let rest = ((self.hi - p.hi) - p.lo) + (self.lo - q * b.lo);
        quick_sum(q, rest / b.hi)
    }
}

impl Wide for Twin {
    type Narrow = f32;

    const ROOTS_OF_TWO: [Self; 32] = {
        let mut roots = [Self::nearest(0.0); 32];
        let mut j = 0;
        while j < 32 {
            roots[j] = Self::nearest(ROOTS_OF_TWO[j]);
            j += 1;
        }
        roots
    };

    #[inline(always)]
    fn new(x: f32) -> Self {
        Self { hi: x, lo: 0.0 }
    }

    #[inline(always)]
    fn constant(c: f64) -> Self {
        Self::nearest(c)
    }

    #[inline(always)]
    fn head(self) -> f32 {
        self.hi
    }

    #[cfg_attr(target_arch = "wasm32", inline(never))]
    fn sqrt(self) -> Self {
        if self.hi <= 0.0 {
            return Self::new(0.0);
        }
        let root = float::sqrt(self.hi);
        let square = product(root, root);
        let rest = ((self.hi - square.hi) - square.lo) + self.lo;
        quick_sum(root, rest / (2.0 * root))
    }

    #[inline(always)]
    fn scale(self, k: i32) -> Self {
        let s = power_of_two(k);
        Self { hi: self.hi * s, lo: self.lo * s }
    }

    #[inline(always)]
    fn narrow(self) -> f32 {
        self.hi
    }

    #[inline(always)]
    fn widen(x: f32) -> Self {
        Self::new(x)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::wide::f64_power_of_two;

    fn value(t: Twin) -> f64 {
        f64::from(t.hi) + f64::from(t.lo)
    }

    /// Pairs over many magnitudes, from a fixed sequence.
    fn pairs() -> impl Iterator<Item = (Twin, Twin)> {
        let mut s = 1_u64;
        let mut next = move || {
            s = s.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            #[allow(clippy::cast_possible_truncation, reason = "the upper bits")]
            let m = (s >> 40) as u32;
            let hi = f32::from_bits((0x3f80_0000 - (30 << 23)) + m * 30)
                * if s & (1 << 20) == 0 { 1.0 } else { -1.0 };
            #[allow(clippy::cast_precision_loss, reason = "24 bits")]
            let part = ((s >> 12) & 0xffff) as f32 / 65_536.0 - 0.5;
            quick_sum(hi, hi * part * f32::from_bits(0x3380_0000))
        };
        (0..100_000).map(move |_| (next(), next()))
    }

    #[test]
    fn operations_are_good_to_46_bits() {
        let bound = f64_power_of_two(-45);
        for (a, b) in pairs() {
            let (x, y) = (value(a), value(b));
            let near = |got: Twin, want: f64, size: f64| (value(got) - want).abs() <= bound * size;
            assert!(near(a + b, x + y, (x + y).abs() + f64_power_of_two(-53) * x.abs()), "{a:?} + {b:?}");
            assert!(near(a * b, x * y, (x * y).abs()), "{a:?} * {b:?}");
            assert!(near(a / b, x / y, (x / y).abs()), "{a:?} / {b:?}");
            let a = if x < 0.0 { -a } else { a };
            assert!(near(a.sqrt(), x.abs().sqrt(), x.abs().sqrt()), "sqrt {a:?}");
        }
    }

    #[test]
    fn sums_and_products_of_two_are_exact() {
        for (a, b) in pairs() {
            assert_eq!(value(product(a.hi, b.hi)), f64::from(a.hi) * f64::from(b.hi), "{a:?} {b:?}");
            assert_eq!(value(sum(a.hi, b.hi)), f64::from(a.hi) + f64::from(b.hi), "{a:?} {b:?}");
        }
    }
}
