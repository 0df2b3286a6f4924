//! A canary for the float environment: seven sums whose bits a host changes when it flushes
//! subnormals or rounds another way. Cheap enough for every frame.

use core::hint::black_box;

/// Zero in the environment that IEEE 754 starts with; otherwise one bit a surprise.
///
/// | bit | what was seen |
/// | --- | --- |
/// | 0 | `1 + 2⁻²⁴` rounded up |
/// | 1 | `−1 − 2⁻²⁴` rounded away |
/// | 2 | `(1 + 2⁻²³) + 2⁻²⁴` not rounded to even |
/// | 3 | a subnormal operand read as zero |
/// | 4 | a subnormal result flushed to zero |
/// | 5 | the same in `f64` |
/// | 6 | `(1 + 2⁻¹²)² − (1 + 2⁻¹¹)` contracted |
#[must_use]
pub fn float_environment() -> u32 {
    let tiny = f32::from_bits(0x3380_0000); // 2⁻²⁴
    let ulp = f32::from_bits(0x3400_0000); // 2⁻²³
    let one = black_box(1.0_f32);
    let subnormal = black_box(f32::from_bits(1));
    let smallest = black_box(f32::from_bits(0x0080_0000));
    let smallest64 = black_box(f64::from_bits(0x0010_0000_0000_0000));
    let root = black_box(1.0_f32 + f32::from_bits(0x3980_0000)); // 1 + 2⁻¹²
    let square = root * root - black_box(1.0_f32 + f32::from_bits(0x3a00_0000));
    let seen = [
        (one + black_box(tiny)).to_bits() != 0x3f80_0000,
        (-one - black_box(tiny)).to_bits() != 0xbf80_0000,
        ((one + black_box(ulp)) + black_box(tiny)).to_bits() != 0x3f80_0002,
        subnormal * black_box(16_777_216.0) == 0.0,
        (smallest * black_box(0.5)).to_bits() != 0x0040_0000,
        (smallest64 * black_box(0.5)).to_bits() != 0x0008_0000_0000_0000,
        square.to_bits() != 0,
    ];
    seen.iter().enumerate().fold(0, |word, (bit, seen)| word | (u32::from(*seen) << bit))
}

#[cfg(test)]
mod tests {
    #[test]
    fn this_environment_is_clean() {
        assert_eq!(super::float_environment(), 0);
    }
}
