//! Several `f32` at a time.
//!
//! Every operation is defined per lane and rounds once, so whatever the width the bits are the same. There is no fused
//! multiply-add and no reciprocal estimate here, and none may be added.

use core::ops::{Add, Mul, Sub};

pub(crate) mod block;
pub(crate) mod rows;
#[cfg(all(feature = "std", any(target_arch = "x86", target_arch = "x86_64"), not(sinew_scalar)))]
pub(crate) mod x86;

/// Whether this target has vector registers; not in a build with `--cfg sinew_scalar`, which the tests compare.
pub(crate) const VECTORS: bool = cfg!(all(
    any(target_feature = "sse2", target_feature = "neon", target_feature = "simd128"),
    not(sinew_scalar)
));

/// One number, or several in a register.
pub(crate) trait Number: Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> {}

impl Number for f32 {}
impl Number for wide::f32x4 {}

/// `[f(0), f(1), f(2)]`. Unlike the standard library's maps of arrays it is always inlined, and these
/// run some hundred times a point.
#[inline(always)]
pub(crate) fn three<T>(f: impl Fn(usize) -> T) -> [T; 3] {
    [f(0), f(1), f(2)]
}

/// `[f(0), f(1), f(2), f(3)]`, as [`three`].
#[inline(always)]
pub(crate) fn each<T>(f: impl Fn(usize) -> T) -> [T; 4] {
    [f(0), f(1), f(2), f(3)]
}
