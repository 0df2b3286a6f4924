//! Three-vectors as arrays; every sum is written left to right.

/// `a + b`.
#[inline(always)]
#[must_use]
pub fn add(a: [f32; 3], b: [f32; 3]) -> [f32; 3] {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

/// `a − b`.
#[inline(always)]
#[must_use]
pub fn sub(a: [f32; 3], b: [f32; 3]) -> [f32; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

/// `s·a`.
#[inline(always)]
#[must_use]
pub fn scale(a: [f32; 3], s: f32) -> [f32; 3] {
    [a[0] * s, a[1] * s, a[2] * s]
}

/// `a·b`.
#[inline(always)]
#[must_use]
pub fn dot(a: [f32; 3], b: [f32; 3]) -> f32 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// `a × b`.
#[inline(always)]
#[must_use]
pub fn cross(a: [f32; 3], b: [f32; 3]) -> [f32; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// `a/|a|`, or `fallback` where `|a|²` is zero or not finite.
#[inline(always)]
#[must_use]
pub fn normalize_or(a: [f32; 3], fallback: [f32; 3]) -> [f32; 3] {
    let square = dot(a, a);
    if square > 0.0 && square < f32::INFINITY {
        let length = super::float::sqrt(square);
        [a[0] / length, a[1] / length, a[2] / length]
    } else {
        fallback
    }
}
