//! The lanes of this target, by the crate `wide`: SSE2, NEON, simd128, or an array where there is none.

use super::Lanes;
use core::ops::{Add, Div, Mul, Sub};
use wide::f32x4;

/// Four lanes in a vector register.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Vector(f32x4);

impl Add for Vector {
    type Output = Self;
    #[inline(always)]
    fn add(self, rhs: Self) -> Self {
        Self(self.0 + rhs.0)
    }
}

impl Sub for Vector {
    type Output = Self;
    #[inline(always)]
    fn sub(self, rhs: Self) -> Self {
        Self(self.0 - rhs.0)
    }
}

impl Mul for Vector {
    type Output = Self;
    #[inline(always)]
    fn mul(self, rhs: Self) -> Self {
        Self(self.0 * rhs.0)
    }
}

impl Div for Vector {
    type Output = Self;
    #[inline(always)]
    fn div(self, rhs: Self) -> Self {
        Self(self.0 / rhs.0)
    }
}

impl Lanes for Vector {
    #[inline(always)]
    fn splat(x: f32) -> Self {
        Self(f32x4::splat(x))
    }

    #[inline(always)]
    fn from_array(a: [f32; 4]) -> Self {
        Self(f32x4::from(a))
    }

    #[inline(always)]
    fn to_array(self) -> [f32; 4] {
        self.0.to_array()
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        Self(self.0.sqrt())
    }

    #[inline(always)]
    fn abs(self) -> Self {
        Self(self.0.abs())
    }

    #[inline(always)]
    fn select_lt(a: Self, b: Self, value: Self, otherwise: Self) -> Self {
        Self(a.0.simd_lt(b.0).bitselect(value.0, otherwise.0))
    }

    #[inline(always)]
    fn transpose(rows: [Self; 4]) -> [Self; 4] {
        f32x4::transpose(rows.map(|r| r.0)).map(Self)
    }
}
