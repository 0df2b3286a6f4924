//! The definition: an array and loops.

#![allow(dead_code, reason = "outside tests the vector type does the work")]

use super::Lanes;
use crate::math::float;
use core::ops::{Add, Div, Mul, Sub};

/// Four lanes as an array.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Scalar([f32; 4]);

impl Scalar {
    #[inline(always)]
    fn zip(self, rhs: Self, f: impl Fn(f32, f32) -> f32) -> Self {
        Self(core::array::from_fn(|i| f(self.0[i], rhs.0[i])))
    }
}

impl Add for Scalar {
    type Output = Self;
    fn add(self, rhs: Self) -> Self {
        self.zip(rhs, |a, b| a + b)
    }
}

impl Sub for Scalar {
    type Output = Self;
    fn sub(self, rhs: Self) -> Self {
        self.zip(rhs, |a, b| a - b)
    }
}

impl Mul for Scalar {
    type Output = Self;
    fn mul(self, rhs: Self) -> Self {
        self.zip(rhs, |a, b| a * b)
    }
}

impl Div for Scalar {
    type Output = Self;
    fn div(self, rhs: Self) -> Self {
        self.zip(rhs, |a, b| a / b)
    }
}

impl Lanes for Scalar {
    fn splat(x: f32) -> Self {
        Self([x; 4])
    }

    fn from_array(a: [f32; 4]) -> Self {
        Self(a)
    }

    fn to_array(self) -> [f32; 4] {
        self.0
    }

    fn sqrt(self) -> Self {
        Self(self.0.map(float::sqrt))
    }

    fn abs(self) -> Self {
        Self(self.0.map(float::abs))
    }

    fn select_lt(a: Self, b: Self, value: Self, otherwise: Self) -> Self {
        let pick = |i: usize| if a.0[i] < b.0[i] { value.0[i] } else { otherwise.0[i] };
        Self(core::array::from_fn(pick))
    }

    fn transpose(rows: [Self; 4]) -> [Self; 4] {
        core::array::from_fn(|j| Self(core::array::from_fn(|i| rows[i].0[j])))
    }
}
