//! Sampling of glTF animation: step, linear and cubic spline (glTF 2.0, appendix C).
//!
//! ```text
//! τ = (t − t₀)/(t₁ − t₀),    step: v₀,    linear: (1 − τ)·v₀ + τ·v₁, rotations by slerp
//! cubic: (2τ³ − 3τ² + 1)·v₀ + Δ(τ³ − 2τ² + τ)·b₀ + (3τ² − 2τ³)·v₁ + Δ(τ³ − τ²)·a₁,   Δ = t₁ − t₀
//! ```

use crate::math::quat;

/// How keys are joined.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Interpolation {
    /// Value of the key before.
    Step,
    /// Linear; rotations by slerp.
    Linear,
    /// Cubic Hermite spline; values are stored as in-tangent, value, out-tangent.
    CubicSpline,
}

/// Keys of one animated property of `N` components.
#[derive(Clone, Copy, Debug)]
pub struct Keys<'a> {
    /// How keys are joined.
    pub interpolation: Interpolation,
    /// Times, s, strictly ascending, at least one.
    pub times: &'a [f32],
    /// Values, `N` a key (three times as many for cubic splines).
    pub values: &'a [f32],
}

impl Keys<'_> {
    /// Entry `part` of key `i`; `parts` entries a key; zeros past the last value.
    fn entry<const N: usize>(&self, i: usize, part: usize, parts: usize) -> [f32; N] {
        let start = (i * parts + part) * N;
        self.values.get(start..).and_then(|values| values.first_chunk()).copied().unwrap_or([0.0; N])
    }

    /// The key before `t`, how far `t` is from it to the next, 0 to 1, and seconds between the two; or else the first
    /// or last key.
    fn span(&self, t: f32) -> Result<(usize, f32, f32), usize> {
        let after = self.times.partition_point(|key| *key <= t);
        let Some(before) = after.checked_sub(1) else { return Err(0) };
        let (Some(t0), Some(t1)) = (self.times.get(before), self.times.get(after)) else {
            return Err(before);
        };
        let span = t1 - t0;
        Ok((before, (t - t0) / span, span))
    }

    /// Value at time `t`, s; before the first and after the last key the value of that key.
    ///
    /// A value that is missing counts as zeros (a parsed asset holds all).
    #[must_use]
    pub fn sample<const N: usize>(&self, t: f32) -> [f32; N] {
        let (parts, middle) = if self.interpolation == Interpolation::CubicSpline { (3, 1) } else { (1, 0) };
        let (i, tau, span) = match self.span(t) {
            Ok(between) => between,
            Err(end) => return self.entry(end, middle, parts),
        };
        let after = i + 1;
        let (v0, v1): ([f32; N], [f32; N]) = (self.entry(i, middle, parts), self.entry(after, middle, parts));
        match self.interpolation {
            Interpolation::Step => v0,
            Interpolation::Linear => core::array::from_fn(|c| (1.0 - tau) * v0[c] + tau * v1[c]),
            Interpolation::CubicSpline => {
                let (b0, a1): ([f32; N], [f32; N]) = (self.entry(i, 2, 3), self.entry(after, 0, 3));
                let (t2, t3) = (tau * tau, tau * tau * tau);
                let weights = [
                    (2.0 * t3 - 3.0 * t2) + 1.0,
                    span * ((t3 - 2.0 * t2) + tau),
                    3.0 * t2 - 2.0 * t3,
                    span * (t3 - t2),
                ];
                core::array::from_fn(|c| {
                    (weights[0] * v0[c] + weights[1] * b0[c]) + (weights[2] * v1[c] + weights[3] * a1[c])
                })
            }
        }
    }

    /// Rotation at time `t`, s, normalized.
    #[must_use]
    pub fn sample_rotation(&self, t: f32) -> [f32; 4] {
        match self.span(t) {
            Ok((i, tau, _)) if self.interpolation == Interpolation::Linear => {
                let (a, b) = (self.entry(i, 0, 1), self.entry(i + 1, 0, 1));
                quat::slerp(quat::normalize(a), quat::normalize(b), tau)
            }
            _ => quat::normalize(self.sample(t)),
        }
    }
}

/// Property of a node that a channel animates.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Property {
    /// Translation, 3 components.
    Translation,
    /// Rotation, 4 components.
    Rotation,
    /// Scale, 3 components.
    Scale,
}

/// Channels of a clip, as rows of an asset.
#[derive(Clone, Copy, Debug, Default)]
pub struct Channels<'a> {
    /// `[node, property + 4·interpolation, first key, keys, first value, 0]` a channel.
    pub rows: &'a [[u32; 6]],
    /// Key times of all channels.
    pub times: &'a [f32],
    /// Values of all channels.
    pub values: &'a [f32],
}

impl<'a> Channels<'a> {
    /// The channel of a row: node, property, keys; `None` where the row is not valid.
    #[must_use]
    pub fn channel(&self, row: &[u32; 6]) -> Option<(usize, Property, Keys<'a>)> {
        let [node, kind, first_key, keys, first_value, zero] = row.map(|x| x as usize);
        let (property, components) = match kind % 4 {
            0 => (Property::Translation, 3),
            1 => (Property::Rotation, 4),
            2 => (Property::Scale, 3),
            _ => return None,
        };
        let (interpolation, parts) = match kind / 4 {
            0 => (Interpolation::Step, 1),
            1 => (Interpolation::Linear, 1),
            2 => (Interpolation::CubicSpline, 3),
            _ => return None,
        };
        let times = self.times.get(first_key..first_key.checked_add(keys)?)?;
        let count = keys.checked_mul(components * parts)?;
        let values = self.values.get(first_value..first_value.checked_add(count)?)?;
        (keys > 0 && zero == 0).then_some((node, property, Keys { interpolation, times, values }))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TIMES: [f32; 3] = [0.0, 1.0, 3.0];

    #[test]
    fn step_linear_and_the_ends() {
        let keys = |interpolation| Keys { interpolation, times: &TIMES, values: &[1.0, 2.0, 6.0] };
        for (t, step, linear) in
            [(-1.0, 1.0, 1.0), (0.5, 1.0, 1.5), (1.0, 2.0, 2.0), (2.0, 2.0, 4.0), (9.0, 6.0, 6.0)]
        {
            assert_eq!(keys(Interpolation::Step).sample::<1>(t), [step], "step at {t}");
            assert_eq!(keys(Interpolation::Linear).sample::<1>(t), [linear], "linear at {t}");
        }
    }

    /// A spline through a cubic polynomial with its own slopes is that polynomial.
    #[test]
    fn cubic_reproduces_a_cubic() {
        let p = |t: f32| t * t * t - 2.0 * t + 1.0;
        let slope = |t: f32| 3.0 * t * t - 2.0;
        let mut values = [0.0; 9];
        for (i, t) in TIMES.into_iter().enumerate() {
            values[3 * i..3 * i + 3].copy_from_slice(&[slope(t), p(t), slope(t)]);
        }
        let keys = Keys { interpolation: Interpolation::CubicSpline, times: &TIMES, values: &values };
        for t in [0.0, 0.3, 1.0, 1.7, 2.9, 3.0] {
            assert!((keys.sample::<1>(t)[0] - p(t)).abs() < 1e-5, "{t}");
        }
    }

    #[test]
    fn one_key_is_a_constant() {
        for interpolation in [Interpolation::Step, Interpolation::Linear] {
            let keys = Keys { interpolation, times: &[0.7], values: &[0.0, 0.0, 0.6, 0.8] };
            assert_eq!(keys.sample_rotation(0.0), keys.sample_rotation(5.0));
        }
    }
}
