//! The definition: an array and loops. The lanes of targets without vector registers.

#![allow(dead_code, reason = "where there are vector registers only tests use it")]

use super::Lanes;
use super::four::each;
use crate::math::float;
use core::ops::{Add, BitAnd, Div, Mul, Sub};

/// Four lanes as an array.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Scalar([f32; 4]);

impl Scalar {
    #[inline(always)]
    fn zip(self, rhs: Self, f: impl Fn(f32, f32) -> f32) -> Self {
        Self(each(|i| f(self.0[i], rhs.0[i])))
    }
}

impl Add for Scalar {
    type Output = Self;
    #[inline(always)]
    fn add(self, rhs: Self) -> Self {
        self.zip(rhs, |a, b| a + b)
    }
}

impl Sub for Scalar {
    type Output = Self;
    #[inline(always)]
    fn sub(self, rhs: Self) -> Self {
        self.zip(rhs, |a, b| a - b)
    }
}

impl Mul for Scalar {
    type Output = Self;
    #[inline(always)]
    fn mul(self, rhs: Self) -> Self {
        self.zip(rhs, |a, b| a * b)
    }
}

impl Div for Scalar {
    type Output = Self;
    #[inline(always)]
    fn div(self, rhs: Self) -> Self {
        self.zip(rhs, |a, b| a / b)
    }
}

/// Four truth values.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Mask([bool; 4]);

impl BitAnd for Mask {
    type Output = Self;
    #[inline(always)]
    fn bitand(self, rhs: Self) -> Self {
        Self(each(|i| self.0[i] && rhs.0[i]))
    }
}

impl Lanes for Scalar {
    type Mask = Mask;

    #[inline(always)]
    fn splat(x: f32) -> Self {
        Self([x; 4])
    }

    #[inline(always)]
    fn from_array(a: [f32; 4]) -> Self {
        Self(a)
    }

    #[inline(always)]
    fn to_array(self) -> [f32; 4] {
        self.0
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        Self(each(|i| float::sqrt(self.0[i])))
    }

    #[inline(always)]
    fn abs(self) -> Self {
        Self(each(|i| float::abs(self.0[i])))
    }

    #[inline(always)]
    fn lt(self, other: Self) -> Mask {
        Mask(each(|i| self.0[i] < other.0[i]))
    }

    #[inline(always)]
    fn select(mask: Mask, value: Self, otherwise: Self) -> Self {
        Self(each(|i| if mask.0[i] { value.0[i] } else { otherwise.0[i] }))
    }

    #[inline(always)]
    fn all(mask: Mask) -> bool {
        mask.0[0] && mask.0[1] && mask.0[2] && mask.0[3]
    }

    #[inline(always)]
    fn transpose(rows: [Self; 4]) -> [Self; 4] {
        each(|j| Self(each(|i| rows[i].0[j])))
    }
}
