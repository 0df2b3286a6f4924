//! Numbers that look random and are the same everywhere.

/// A generator of xorshift numbers.
#[derive(Clone, Debug)]
pub struct Random(u64);

impl Random {
    /// One that starts at `seed`.
    #[must_use]
    pub fn new(seed: u64) -> Self {
        // Zero would stay zero, and near seeds should not begin alike.
        Self(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1)
    }

    /// The next 64 bits.
    pub fn bits(&mut self) -> u64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        self.0
    }

    /// The next 32 bits.
    pub fn word(&mut self) -> u32 {
        u32::try_from(self.bits() >> 32).unwrap_or(0)
    }

    /// A number below `n`, which is not 0.
    pub fn below(&mut self, n: u32) -> u32 {
        self.word() % n
    }

    /// A number in `-1..=1`.
    #[allow(clippy::cast_precision_loss, reason = "24 bits are exact")]
    pub fn unit(&mut self) -> f32 {
        (self.below(1 << 24) as f32 - 8_388_608.0) / 8_388_608.0
    }
}
