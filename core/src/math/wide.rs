//! Numbers with about twice the digits of `f32`, in which the elementary functions are evaluated
//! before their one rounding.
//!
//! Each function is written once, over [`Wide`], and runs on two number types: `f64` where the
//! machine has it, and [`Twin`](super::twin::Twin), a pair of `f32`, where it has not. Both give the
//! same bits because both results are correctly rounded, see [`super::rounding`].

use core::ops::{Add, Div, Mul, Neg, Sub};

/// A number type to evaluate in.
///
/// The operations err by a few units of the last of about 48 bits (`Twin`) or by half a unit of 53
/// (`f64`). Intermediate values stay within `2⁻¹⁰⁰ … 2¹²⁰`, so that no low part is subnormal.
pub trait Wide:
    Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Div<Output = Self> + Neg<Output = Self>
{
    /// The type of terms that are small beside a sum: `f32` for pairs of it.
    type Narrow: Wide;
    /// `2^(j/32)`, `j = 0 … 31`.
    const ROOTS_OF_TWO: [Self; 32];
    /// Exactly `x`.
    fn new(x: f32) -> Self;
    /// The nearest to a constant.
    fn constant(c: f64) -> Self;
    /// The nearest `f32`, to a unit of its last place.
    fn head(self) -> f32;
    /// Square root of a number that is not negative.
    fn sqrt(self) -> Self;
    /// `self·2ᵏ`, exactly, for `|k| ≤ 100`.
    fn scale(self, k: i32) -> Self;
    /// Leading digits, for terms so small that the rest does not count.
    fn narrow(self) -> Self::Narrow;
    /// Exactly `x`.
    fn widen(x: Self::Narrow) -> Self;
}

/// `m·2ᵏ`: a result that may lie beyond the range of `f32`.
#[derive(Clone, Copy, Debug)]
pub struct Scaled<W> {
    /// Significand, not necessarily normalized.
    pub m: W,
    /// Exponent.
    pub k: i32,
}

impl<W> From<W> for Scaled<W> {
    fn from(m: W) -> Self {
        Self { m, k: 0 }
    }
}

/// A power series, highest power first: `lead` in full width, the `tail` of higher powers narrow.
#[inline]
pub fn series<W: Wide, const T: usize, const L: usize>(tail: &[f64; T], lead: &[f64; L], x: W) -> W {
    let tail = horner(tail, W::Narrow::constant(0.0), x.narrow());
    horner(lead, W::widen(tail), x)
}

/// `((sum·x + c₀)·x + c₁)·x + …`
#[inline(always)]
fn horner<W: Wide, const N: usize>(coefficients: &[f64; N], sum: W, x: W) -> W {
    coefficients.iter().fold(sum, |sum, c| sum * x + W::constant(*c))
}

/// `2ᵏ` for `−126 ≤ k ≤ 127`.
#[inline(always)]
pub(crate) const fn power_of_two(k: i32) -> f32 {
    f32::from_bits(((k + 127) << 23).cast_unsigned())
}

/// `2^(j/32)` in `f64`, correctly rounded.
pub(crate) const ROOTS_OF_TWO: [f64; 32] = {
    let mut roots = [0.0; 32];
    let mut j = 0;
    while j < 32 {
        roots[j] = f64::from_bits(ROOTS_OF_TWO_BITS[j]);
        j += 1;
    }
    roots
};

const ROOTS_OF_TWO_BITS: [u64; 32] = [
    0x3ff0_0000_0000_0000,
    0x3ff0_59b0_d315_8574,
    0x3ff0_b558_6cf9_890f,
    0x3ff1_1301_d012_5b51,
    0x3ff1_72b8_3c7d_517b,
    0x3ff1_d487_3168_b9aa,
    0x3ff2_387a_6e75_6238,
    0x3ff2_9e9d_f51f_dee1,
    0x3ff3_06fe_0a31_b715,
    0x3ff3_71a7_373a_a9cb,
    0x3ff3_dea6_4c12_3422,
    0x3ff4_4e08_6061_892d,
    0x3ff4_bfda_d536_2a27,
    0x3ff5_342b_569d_4f82,
    0x3ff5_ab07_dd48_5429,
    0x3ff6_247e_b03a_5585,
    0x3ff6_a09e_667f_3bcd,
    0x3ff7_1f75_e8ec_5f74,
    0x3ff7_a114_73eb_0187,
    0x3ff8_2589_994c_ce13,
    0x3ff8_ace5_422a_a0db,
    0x3ff9_3737_b0cd_c5e5,
    0x3ff9_c491_82a3_f090,
    0x3ffa_5503_b23e_255d,
    0x3ffa_e89f_995a_d3ad,
    0x3ffb_7f76_f2fb_5e47,
    0x3ffc_199b_dd85_529c,
    0x3ffc_b720_dcef_9069,
    0x3ffd_5818_dcfb_a487,
    0x3ffd_fc97_337b_9b5f,
    0x3ffe_a4af_a2a4_90da,
    0x3fff_5076_5b6e_4540,
];

impl Wide for f64 {
    type Narrow = Self;

    const ROOTS_OF_TWO: [Self; 32] = ROOTS_OF_TWO;

    #[inline(always)]
    fn new(x: f32) -> Self {
        Self::from(x)
    }

    #[inline(always)]
    fn constant(c: f64) -> Self {
        c
    }

    #[inline(always)]
    fn head(self) -> f32 {
        rounded(self)
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        #[cfg(feature = "std")]
        {
            Self::sqrt(self)
        }
        #[cfg(not(feature = "std"))]
        {
            libm::sqrt(self)
        }
    }

    #[inline(always)]
    fn scale(self, k: i32) -> Self {
        self * f64_power_of_two(k)
    }

    #[inline(always)]
    fn narrow(self) -> Self {
        self
    }

    #[inline(always)]
    fn widen(x: Self) -> Self {
        x
    }
}

/// For the small terms of pairs of `f32`; the elementary functions themselves need more.
impl Wide for f32 {
    type Narrow = Self;

    const ROOTS_OF_TWO: [Self; 32] = {
        let mut roots = [0.0; 32];
        let mut j = 0;
        while j < 32 {
            roots[j] = rounded(ROOTS_OF_TWO[j]);
            j += 1;
        }
        roots
    };

    #[inline(always)]
    fn new(x: f32) -> Self {
        x
    }

    #[inline(always)]
    fn constant(c: f64) -> Self {
        rounded(c)
    }

    #[inline(always)]
    fn head(self) -> f32 {
        self
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        super::float::sqrt(self)
    }

    #[inline(always)]
    fn scale(self, k: i32) -> Self {
        self * power_of_two(k)
    }

    #[inline(always)]
    fn narrow(self) -> Self {
        self
    }

    #[inline(always)]
    fn widen(x: Self) -> Self {
        x
    }
}

#[inline(always)]
#[allow(clippy::cast_possible_truncation, reason = "rounds to nearest")]
const fn rounded(c: f64) -> f32 {
    c as f32
}

/// `2ᵏ` for `−1022 ≤ k ≤ 1023`.
#[inline(always)]
pub(crate) const fn f64_power_of_two(k: i32) -> f64 {
    f64::from_bits(((k as i64 + 1023) << 52).cast_unsigned())
}
