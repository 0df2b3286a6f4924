//! The definition: an array and loops. The lanes of targets without vector registers.

#![allow(dead_code, reason = "where there are vector registers only tests use it")]

use super::{Lanes, each};
use core::ops::{Add, Mul};

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

impl Mul for Scalar {
    type Output = Self;
    #[inline(always)]
    fn mul(self, rhs: Self) -> Self {
        self.zip(rhs, |a, b| a * b)
    }
}

impl Lanes for Scalar {
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
    fn transpose(rows: [Self; 4]) -> [Self; 4] {
        each(|j| Self(each(|i| rows[i].0[j])))
    }
}
