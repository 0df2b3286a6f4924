//! The widest instructions of this processor, found at run time: the one file with `unsafe`.
//!
//! Only sums of integers are sent here: they are exact in any order, so that every way gives the same bits.

#![allow(
    unsafe_code,
    reason = "a function for instructions that not every processor has can only be called so"
)]

#[cfg(all(feature = "std", any(target_arch = "x86", target_arch = "x86_64"), not(sinew_scalar)))]
mod x86 {
    use crate::lanes::rows::rows_plain;
    use crate::lanes::x86::{rows_avx2, rows_vnni};

    /// Whether the processor has AVX2.
    fn avx2() -> bool {
        std::is_x86_feature_detected!("avx2")
    }

    /// Whether it has AVX2 and VNNI for 256 bits.
    fn vnni() -> bool {
        avx2() && std::is_x86_feature_detected!("avx512vl") && std::is_x86_feature_detected!("avx512vnni")
    }

    /// Sums of the rows of `weights` times `q`, by the widest instructions there are.
    #[inline(always)]
    pub(crate) fn rows(weights: &[i8], q: &[i8], each: impl FnMut(usize, i32)) {
        if vnni() {
            // SAFETY: processor and operating system have just said that they support AVX2, AVX-512 VL and VNNI.
            unsafe { rows_vnni(weights, q, each) }
        } else if avx2() {
            // SAFETY: processor and operating system have just said that they support AVX2.
            unsafe { rows_avx2(weights, q, each) }
        } else {
            rows_plain(weights, q, each);
        }
    }

    /// Every copy that this machine can run, for a test: its name, and `(row, sum)` of all rows.
    #[cfg(test)]
    pub(crate) fn rows_by_each(weights: &[i8], q: &[i8], check: impl Fn(&str, Sums)) {
        let (mut plain, mut dispatched, mut by_avx2) = (Sums::new(), Sums::new(), Sums::new());
        rows_plain(weights, q, |row, z| plain.push((row, i64::from(z))));
        check("plain", plain);
        rows(weights, q, |row, z| dispatched.push((row, i64::from(z))));
        check("dispatched", dispatched);
        if avx2() {
            // SAFETY: processor and operating system have just said that they support AVX2.
            unsafe { rows_avx2(weights, q, |row, z| by_avx2.push((row, i64::from(z)))) };
            check("AVX2", by_avx2);
        }
    }

    #[cfg(test)]
    type Sums = super::Sums;
}

#[cfg(test)]
extern crate std;
#[cfg(test)]
type Sums = std::vec::Vec<(usize, i64)>;

#[cfg(all(feature = "std", any(target_arch = "x86", target_arch = "x86_64"), not(sinew_scalar)))]
pub(crate) use x86::*;

#[cfg(not(all(feature = "std", any(target_arch = "x86", target_arch = "x86_64"), not(sinew_scalar))))]
pub(crate) use crate::lanes::rows::rows_plain as rows;

/// The one copy there is.
#[cfg(all(
    test,
    not(all(feature = "std", any(target_arch = "x86", target_arch = "x86_64"), not(sinew_scalar)))
))]
pub(crate) fn rows_by_each(weights: &[i8], q: &[i8], check: impl Fn(&str, Sums)) {
    let mut sums = Sums::new();
    rows(weights, q, |row, z| sums.push((row, i64::from(z))));
    check("plain", sums);
}
