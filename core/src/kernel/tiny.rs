//! Numbers too small to matter become zero, so that no result depends on what a host does to subnormals.
//!
//! ```text
//! flush(x) = 0 where |x| < 2⁻⁶²,   else x
//! ```
//!
//! Applied where numbers come in (poses, roots, tunables; an asset holds none) and where products of them meet, it
//! leaves nothing whose products with what is as large as is let in could underflow into a result: a host that
//! flushes subnormals to zero, as audio threads do, gets the same bits. 2⁻⁶² of a metre is a millionth of a proton's
//! radius.

use crate::math::affine::Affine;
use crate::math::float::abs;

/// The least magnitude that is not zero, 2⁻⁶².
pub const LEAST: f32 = f32::from_bits(0x2080_0000);

/// `x`, or 0 where its magnitude is below [`LEAST`]; NaN passes.
#[inline(always)]
#[must_use]
pub fn flush(x: f32) -> f32 {
    if abs(x) < LEAST { 0.0 } else { x }
}

/// [`flush`] of each component.
#[must_use]
pub fn flush_all<const N: usize>(mut x: [f32; N]) -> [f32; N] {
    x.iter_mut().for_each(|x| *x = flush(*x));
    x
}

/// [`flush`] of each entry.
#[must_use]
pub fn flush_map(m: &Affine) -> Affine {
    m.map(flush_all)
}

/// Whether `x` is zero or at least [`LEAST`], told from its bits alone: comparisons may see no subnormals here.
#[must_use]
pub const fn is_flushed(x: f32) -> bool {
    let magnitude = x.to_bits() & 0x7fff_ffff;
    magnitude == 0 || magnitude >= LEAST.to_bits()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn below_the_least_is_zero_and_nothing_else_changes() {
        let below = f32::from_bits(LEAST.to_bits() - 1);
        assert_eq!(LEAST, 1.0 / 4_611_686_018_427_387_904.0, "2^-62");
        for (x, want) in
            [(below, 0.0), (-below, 0.0), (LEAST, LEAST), (-LEAST, -LEAST), (1e-45, 0.0), (-3.0, -3.0)]
        {
            assert_eq!(flush(x), want, "{x}");
            assert_eq!(is_flushed(x), flush(x).to_bits() == x.to_bits(), "{x}");
        }
        assert!(flush(f32::NAN).is_nan() && flush(f32::INFINITY) == f32::INFINITY);
        assert!(is_flushed(0.0) && is_flushed(-0.0));
    }
}
