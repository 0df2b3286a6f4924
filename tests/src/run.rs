//! Running characters in tests.

use sinew::{Asset, Character, Root};

/// Parses aligned bytes.
///
/// # Panics
///
/// If they are no asset.
#[must_use]
pub fn parse(aligned: &[u32]) -> Asset<'_> {
    Asset::parse(bytemuck::cast_slice(aligned)).expect("a valid asset")
}

/// Memory for a character of `asset`.
#[must_use]
pub fn memory(asset: &Asset<'_>) -> Vec<f32> {
    vec![0.0; Character::required_len(asset)]
}

/// A root on a smooth path: position and turn at time `t`, s, for a body of `size`.
#[must_use]
pub fn path(t: f64, size: f64) -> Root {
    let half = 0.4 * libm::sin(3.0 * t);
    #[allow(clippy::cast_possible_truncation, reason = "rounding is meant")]
    let rotation = [0.0, libm::sin(half) as f32, 0.0, libm::cos(half) as f32];
    let translation = [0.3 * libm::sin(2.0 * t), 0.1 * libm::sin(7.0 * t), 0.2 * t].map(|x| x * size);
    Root { translation, rotation }
}

/// Largest distance between two sets of vectors.
///
/// # Panics
///
/// If the lengths differ.
#[must_use]
pub fn distance(a: &[[f32; 3]], b: &[[f32; 3]]) -> f32 {
    assert_eq!(a.len(), b.len(), "lengths differ");
    let one = |(a, b): (&[f32; 3], &[f32; 3])| {
        let d = [0, 1, 2].map(|i| a[i] - b[i]);
        (d[0] * d[0] + d[1] * d[1] + d[2] * d[2]).sqrt()
    };
    a.iter().zip(b).map(one).fold(0.0, f32::max)
}

/// Largest length of a set of vectors.
#[must_use]
pub fn length(a: &[[f32; 3]]) -> f32 {
    distance(a, &vec![[0.0; 3]; a.len()])
}

/// Bit patterns of vectors.
#[must_use]
pub fn bits(a: &[[f32; 3]]) -> Vec<u32> {
    a.as_flattened().iter().map(|x| x.to_bits()).collect()
}
