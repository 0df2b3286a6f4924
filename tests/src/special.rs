//! The values that float code fears.

/// NaNs: quiet and signalling, with and without payload, of both signs.
pub const NANS: [u32; 8] =
    [0x7fc0_0000, 0xffc0_0000, 0x7f80_0001, 0xff80_0001, 0x7fc1_2345, 0xffc1_2345, 0x7fff_ffff, 0xffff_ffff];
/// Infinities.
pub const INFINITIES: [u32; 2] = [0x7f80_0000, 0xff80_0000];
/// The smallest and the largest subnormal, and one between, of both signs.
pub const SUBNORMALS: [u32; 6] =
    [0x0000_0001, 0x8000_0001, 0x0040_0000, 0x8040_0000, 0x007f_ffff, 0x807f_ffff];
/// The largest numbers.
pub const LARGEST: [u32; 2] = [0x7f7f_ffff, 0xff7f_ffff];
/// The smallest normal numbers.
pub const SMALLEST: [u32; 2] = [0x0080_0000, 0x8080_0000];
/// −0.
pub const NEGATIVE_ZERO: u32 = 0x8000_0000;

/// All of them, as floats.
#[must_use]
pub fn all() -> Vec<f32> {
    let groups: [&[u32]; 6] =
        [&NANS, &INFINITIES, &SUBNORMALS, &LARGEST, &SMALLEST, &[NEGATIVE_ZERO, 0x3f80_0000]];
    groups.concat().into_iter().map(f32::from_bits).collect()
}

/// The same kinds of values in `f64`.
#[must_use]
pub fn all_f64() -> Vec<f64> {
    let magnitudes = [
        0x7ff8_0000_0000_0000, // quiet NaN
        0x7ff0_0000_0000_0001, // signalling NaN
        0x7ff8_dead_beef_0000, // payload
        0x7ff0_0000_0000_0000, // infinity
        0x0000_0000_0000_0001, // subnormal
        0x000f_ffff_ffff_ffff, // largest subnormal
        0x0010_0000_0000_0000, // smallest normal
        0x7fef_ffff_ffff_ffff, // largest
        0x47ef_ffff_e000_0000, // largest f32
        0x3810_0000_0000_0000, // smallest normal f32
        0_u64,
    ];
    magnitudes.into_iter().flat_map(|m| [m, m | 1 << 63]).map(f64::from_bits).collect()
}
