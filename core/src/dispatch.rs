//! The widest instructions of this processor, found at run time: the one file with `unsafe`.
//!
//! A copy of a kernel for other instructions gives the same bits: sums of integers are exact in any order, and of the
//! kernels with floats only those come here whose lanes know nothing of each other.

#![allow(
    unsafe_code,
    reason = "a function for instructions that not every processor has can only be called so"
)]

use crate::kernel::skin::{Influences, LinearBlock, Rows, skin_any, skin_surface_any};
use crate::kernel::spring::{Step, advance_any};
use crate::kernel::unskin::{Tissue, unskin_any};
use crate::lanes::F32x4;
use crate::lanes::rows::rows_plain;
use crate::stage::skin::accelerate_any;

/// Instructions that this processor has. Only their detection makes one: who holds it may use them.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Level(Instructions);

#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[allow(dead_code, reason = "other processors have no choice")]
enum Instructions {
    /// Those that the target has anyway.
    Plain,
    /// AVX2.
    Avx2,
    /// And AVX-512 F and VL.
    Avx512,
    /// And AVX-512 VNNI.
    Vnni,
}

/// The widest instructions of this processor.
fn widest() -> Level {
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

/// `$name` runs the copy of `$any` for the widest instructions, `$at` that for a level.
macro_rules! copies {
    ($name:ident, $at:ident, $any:path, ($($arg:ident: $type:ty),+)) => {
        #[inline]
        #[allow(clippy::too_many_arguments, reason = "as many as the kernel's")]
        pub(crate) fn $name($($arg: $type),+) {
            $at(widest(), $($arg),+);
        }

        #[inline]
        #[allow(unused_variables, reason = "other processors have no choice")]
        #[allow(clippy::too_many_arguments, reason = "as many as the kernel's")]
        pub(crate) fn $at(level: Level, $($arg: $type),+) {
            #[cfg(all(feature = "std", any(target_arch = "x86", target_arch = "x86_64"), not(sinew_scalar)))]
            {
                #[target_feature(enable = "avx2")]
                #[allow(clippy::too_many_arguments, reason = "as many as the kernel's")]
                fn avx2($($arg: $type),+) {
                    $any($($arg),+);
                }
                #[target_feature(enable = "avx2,avx512f,avx512vl")]
                #[allow(clippy::too_many_arguments, reason = "as many as the kernel's")]
                fn avx512($($arg: $type),+) {
                    $any($($arg),+);
                }
                if level.0 >= Instructions::Avx512 {
                    // SAFETY: who made the level has found that the processor supports AVX-512 F and VL.
                    return unsafe { avx512($($arg),+) };
                }
                if level.0 == Instructions::Avx2 {
                    // SAFETY: who made the level has found that the processor supports AVX2.
                    return unsafe { avx2($($arg),+) };
                }
            }
            $any($($arg),+);
        }
    };
}

copies!(advance, advance_at, advance_any, (
    step: &Step, x0: &[f32], x1: &[f32], f0: &[f32], f1: &[f32], y: &mut [f32], v: &mut [f32], slope: &mut [f32]
));

copies!(skin, skin_at, skin_any::<F32x4>, (
    palette: &[Rows], influences: Influences<'_>, rest: &[[f32; 3]], out: &mut [[f32; 3]], linear: &mut [LinearBlock]
));

copies!(skin_surface, skin_surface_at, skin_surface_any::<F32x4>, (
    palette: &[Rows], influences: Influences<'_>, points: &[u32], positions: &mut [[f32; 3]], normals: &mut [[f32; 3]]
));

copies!(accelerate, accelerate_at, accelerate_any, (
    gravity: [f32; 3], authored: [f32; 3], linear: &[LinearBlock], out: &mut [[f32; 3]]
));

copies!(unskin, unskin_at, unskin_any, (
    palette: &[Rows], influences: Influences<'_>, linear: &[LinearBlock], y: &[[f32; 3]], tissue: Tissue<'_>,
    out: &mut [[f32; 3]]
));

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
        Instructions::Avx2 | Instructions::Avx512 => unsafe { crate::lanes::x86::rows_avx2(weights, q, each) },
        _ => rows_plain(weights, q, each),
    }
}
