//! Lanes in a vector register, by the crate `wide`: SSE2, NEON or simd128.

#![allow(dead_code, reason = "where there are no vector registers only tests use it")]

use super::Lanes;
use core::ops::{Add, Mul};
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

impl Mul for Vector {
    type Output = Self;
    #[inline(always)]
    fn mul(self, rhs: Self) -> Self {
        Self(self.0 * rhs.0)
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
    fn transpose(rows: [Self; 4]) -> [Self; 4] {
        let [a, b, c, d] = f32x4::transpose([rows[0].0, rows[1].0, rows[2].0, rows[3].0]);
        [Self(a), Self(b), Self(c), Self(d)]
    }
}
