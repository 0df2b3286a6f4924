//! The widest instructions of this processor, found at run time: the one file with `unsafe`.
//!
//! A copy of a kernel for other instructions gives the same bits: sums of integers are exact in any order, and of the
//! kernels with floats only those come here whose lanes know nothing of each other.

#![allow(
    unsafe_code,
    reason = "a function for instructions that not every processor has can only be called so"
)]

use crate::lanes::rows::rows_plain;

/// Instructions that this processor has. Only their detection makes one: who holds it may use them.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Level(Instructions);

#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[allow(dead_code, reason = "other processors have no choice")]
pub(crate) enum Instructions {
    /// Those that the target has anyway.
    Plain,
    /// AVX2.
    Avx2,
    /// And AVX-512 F and VL.
    Avx512,
    /// And AVX-512 VNNI.
    Vnni,
}

impl Level {
    /// Whether these instructions are among them.
    #[inline]
    #[allow(dead_code, reason = "other processors have no choice")]
    pub(crate) fn has(self, instructions: Instructions) -> bool {
        self.0 >= instructions
    }
}

/// The widest instructions of this processor.
#[inline]
pub(crate) fn widest() -> Level {
    #[cfg(all(feature = "std", any(target_arch = "x86", target_arch = "x86_64"), not(sinew_scalar)))]
    {
        use std::is_x86_feature_detected as has;
        if has!("avx2") {
            if !(has!("avx512f") && has!("avx512vl")) {
                return Level(Instructions::Avx2);
            }
            return Level(if has!("avx512vnni") { Instructions::Vnni } else { Instructions::Avx512 });
        }
    }
    Level(Instructions::Plain)
}

/// All that this processor has, for tests.
#[cfg(test)]
pub(crate) fn levels() -> impl Iterator<Item = Level> {
    use Instructions::{Avx2, Avx512, Plain, Vnni};
    let Level(widest) = widest();
    [Plain, Avx2, Avx512, Vnni].into_iter().filter(move |level| *level <= widest).map(Level)
}

/// `$at` runs the copy of the kernel `$any` for the instructions of a level.
macro_rules! copies {
    ($at:ident, $any:path, ($($arg:ident: $type:ty),+ $(,)?)) => {
        // One copy, however often it is called.
        #[inline(never)]
        #[allow(unused_variables, reason = "other processors have no choice")]
        #[allow(clippy::too_many_arguments, reason = "as many as the kernel's")]
        #[allow(unsafe_code, reason = "instructions that not every processor has")]
        pub(crate) fn $at(level: $crate::dispatch::Level, $($arg: $type),+) {
            #[cfg(all(feature = "std", any(target_arch = "x86", target_arch = "x86_64"), not(sinew_scalar)))]
            {
                use $crate::dispatch::Instructions;

                #[target_feature(enable = "avx2")]
                fn avx2($($arg: $type),+) {
                    $any($($arg),+);
                }
                #[target_feature(enable = "avx2,avx512f,avx512vl")]
                fn avx512($($arg: $type),+) {
                    $any($($arg),+);
                }
                if level.has(Instructions::Avx512) {
                    // SAFETY: who made the level has found that the processor supports AVX-512 F and VL.
                    return unsafe { avx512($($arg),+) };
                }
                if level.has(Instructions::Avx2) {
                    // SAFETY: who made the level has found that the processor supports AVX2.
                    return unsafe { avx2($($arg),+) };
                }
            }
            $any($($arg),+);
        }
    };
}
pub(crate) use copies;

/// Square root, correctly rounded.
#[cfg(all(not(feature = "std"), target_arch = "arm", target_abi = "eabihf"))]
#[inline(always)]
pub(crate) fn sqrt(x: f32) -> f32 {
    let bits;
    // SAFETY: a processor whose floats are passed in registers has the instruction; the register it works in has at the
    // end what it had. (Rust knows that register only where there is `f64` too.)
    unsafe {
        core::arch::asm!(
            "vmov {kept}, s0",
            "vmov s0, {x}",
            "vsqrt.f32 s0, s0",
            "vmov {x}, s0",
            "vmov s0, {kept}",
            x = inout(reg) x.to_bits() => bits,
            kept = out(reg) _,
            options(pure, nomem, nostack)
        );
    }
    f32::from_bits(bits)
}

/// Sums of the rows of `weights` times `q`; each goes to `each(row, sum)`.
#[inline(always)]
pub(crate) fn rows(weights: &[i8], q: &[i8], each: impl FnMut(usize, i32)) {
    rows_at(widest(), weights, q, each);
}

/// [`rows`] by the instructions of a level.
#[inline(always)]
pub(crate) fn rows_at(level: Level, weights: &[i8], q: &[i8], each: impl FnMut(usize, i32)) {
    match level.0 {
        #[cfg(all(feature = "std", any(target_arch = "x86", target_arch = "x86_64"), not(sinew_scalar)))]
        // SAFETY: who made the level has found that the processor supports AVX2, AVX-512 VL and VNNI.
        Instructions::Vnni => unsafe { crate::lanes::x86::rows_vnni(weights, q, each) },
        #[cfg(all(feature = "std", any(target_arch = "x86", target_arch = "x86_64"), not(sinew_scalar)))]
        // SAFETY: who made the level has found that the processor supports AVX2.
        Instructions::Avx2 | Instructions::Avx512 => unsafe {
            crate::lanes::x86::rows_avx2(weights, q, each);
        },
        _ => rows_plain(weights, q, each),
    }
}
