//! Value noise from an integer hash: the same gusts on every machine.

/// Mixes the bits of `x` (an avalanche of two multiplications, bijective on `u32`).
#[must_use]
pub const fn hash(x: u32) -> u32 {
    let x = (x ^ (x >> 16)).wrapping_mul(0x7feb_352d);
    let x = (x ^ (x >> 15)).wrapping_mul(0x846c_a68b);
    x ^ (x >> 16)
}

/// Noise in `−1..=1` at lattice point `i` of channel `channel`.
#[must_use]
pub fn lattice(i: u32, channel: u32) -> f32 {
    let bits = hash(i ^ hash(channel)) >> 8;
    #[allow(clippy::cast_precision_loss, reason = "24 bits are exact")]
    let unit = bits as f32 * f32::from_bits(0x3380_0000); // 2⁻²⁴
    2.0 * unit - 1.0
}

/// C¹ noise in `−1..=1` at time `ticks·2⁻²⁴` lattice steps.
#[must_use]
pub fn value(ticks: u64, channel: u32) -> f32 {
    #[allow(clippy::cast_possible_truncation, reason = "the lattice repeats after 2^32 steps")]
    let i = (ticks >> 24) as u32;
    #[allow(clippy::cast_precision_loss, clippy::cast_possible_truncation, reason = "24 bits are exact")]
    let t = (ticks & 0x00ff_ffff) as u32 as f32 * f32::from_bits(0x3380_0000);
    let smooth = t * t * (3.0 - 2.0 * t);
    let (a, b) = (lattice(i, channel), lattice(i.wrapping_add(1), channel));
    a + (b - a) * smooth
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn noise_is_bounded_continuous_and_pinned() {
        let mut last = value(0, 3);
        for i in 1..50_000_u64 {
            let now = value(i << 12, 3);
            assert!(now.abs() <= 1.0 && (now - last).abs() < 1e-3, "{i}: {last} {now}");
            last = now;
        }
        assert_ne!(lattice(7, 0).to_bits(), lattice(7, 1).to_bits());
    }
}
