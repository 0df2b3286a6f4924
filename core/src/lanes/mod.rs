//! Four `f32` lanes, the same four on every target.
//!
//! Every operation is defined per lane and rounds once, so the vector and the scalar implementation
//! agree bit for bit. There is no fused multiply-add and no reciprocal estimate here, and none may
//! be added. The scalar type is the definition, compiled everywhere as the oracle of the tests.

pub(crate) mod block;
pub(crate) mod rows;
mod scalar;
mod vector;
#[cfg(all(feature = "std", any(target_arch = "x86", target_arch = "x86_64"), not(sinew_scalar)))]
pub(crate) mod x86;

use core::ops::{Add, Mul};

#[cfg(test)]
pub(crate) use scalar::Scalar;

/// The lanes of this target. Without vector registers `wide` falls back to arrays too, but slower ones.
#[cfg(all(
    any(target_feature = "sse2", target_feature = "neon", target_feature = "simd128"),
    not(sinew_scalar)
))]
pub(crate) type F32x4 = vector::Vector;
/// The lanes of this target, or of a build with `--cfg sinew_scalar`, which the tests compare.
#[cfg(any(
    not(any(target_feature = "sse2", target_feature = "neon", target_feature = "simd128")),
    sinew_scalar
))]
pub(crate) type F32x4 = scalar::Scalar;

/// What a kernel may ask of four lanes.
pub(crate) trait Lanes: Copy + Add<Output = Self> + Mul<Output = Self> {
    /// All lanes equal `x`.
    fn splat(x: f32) -> Self;
    /// Lanes from an array.
    fn from_array(a: [f32; 4]) -> Self;
    /// Lanes to an array.
    fn to_array(self) -> [f32; 4];
    /// Columns of a 4×4 block given by its rows.
    fn transpose(rows: [Self; 4]) -> [Self; 4];
}

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

#[cfg(test)]
mod tests {
    use super::*;

    /// Every operation on awkward values: both types give the same bits.
    #[test]
    fn vector_agrees_with_scalar_bit_for_bit() {
        let values = [0.0, -0.0, 1.0, -1.5, 1e-38, 3e-39, 1e30, -7.25, f32::INFINITY, 0.1];
        let bits = |x: [f32; 4]| x.map(|x| if x.is_nan() { 0x7fc0_0000 } else { x.to_bits() });
        let quad = |i: usize| core::array::from_fn(|j| values[(i + 3 * j) % 10]);
        for i in 0..10 {
            for k in 0..10 {
                let (a, b): ([f32; 4], [f32; 4]) = (quad(i), quad(k + 1));
                let run = |v: [[f32; 4]; 3]| v.map(bits);
                fn all<L: Lanes>(a: [f32; 4], b: [f32; 4]) -> [[f32; 4]; 3] {
                    let (a, b) = (L::from_array(a), L::from_array(b));
                    let turned = L::transpose([a, b, a + b, L::splat(0.5)]);
                    [a + b, a * b, turned[2]].map(L::to_array)
                }
                assert_eq!(run(all::<F32x4>(a, b)), run(all::<Scalar>(a, b)), "{a:?} {b:?}");
            }
        }
    }
}
