//! Layer normalisation: `yᵢ = gᵢ·(xᵢ − μ)/√(σ² + ε) + bᵢ` with mean `μ` and variance `σ²` over the layer.
//!
//! Sums run in eight interleaved accumulators, `accⱼ = Σ xⱼ₊₈ₖ` in rising order, which then add up as
//! `((0+4)+(2+6)) + ((1+5)+(3+7))`. Source: Ba, Kiros and Hinton 2016, equation 4.

use crate::math::entire::rsqrt;

/// Added to the variance.
const EPSILON: f32 = 1e-5;
/// Accumulators.
const LANES: usize = 8;

/// Gain and bias, one a neuron.
#[derive(Clone, Copy, Debug)]
pub struct Norm<'a> {
    /// `g`.
    pub gain: &'a [f32],
    /// `b`.
    pub bias: &'a [f32],
}

impl Norm<'_> {
    /// Normalises `x` in place; the shortest slice decides how much of it.
    ///
    /// Zeros stay, up to the bias, for a layer without spread.
    pub fn apply(&self, x: &mut [f32]) {
        #[allow(clippy::cast_precision_loss, reason = "layers are shorter than 2^24")]
        let inverse_len = 1.0 / x.len().max(1) as f32;
        let mean = sum(x, |x| x) * inverse_len;
        let variance = sum(x, |x| (x - mean) * (x - mean)) * inverse_len;
        let scale = rsqrt(variance + EPSILON);
        for ((x, gain), bias) in x.iter_mut().zip(self.gain).zip(self.bias) {
            *x = (*x - mean) * scale * gain + bias;
        }
    }
}

/// `Σ f(xᵢ)` in the order of the module's first lines.
#[inline(always)]
fn sum(x: &[f32], f: impl Fn(f32) -> f32) -> f32 {
    let (blocks, tail) = x.as_chunks::<LANES>();
    let mut acc = [0.0; LANES];
    for block in blocks {
        acc = core::array::from_fn(|j| acc[j] + f(block[j]));
    }
    for (acc, x) in acc.iter_mut().zip(tail) {
        *acc += f(*x);
    }
    let [a0, a1, a2, a3, a4, a5, a6, a7] = acc;
    ((a0 + a4) + (a2 + a6)) + ((a1 + a5) + (a3 + a7))
}

#[cfg(test)]
mod tests {
    extern crate std;
    use super::*;
    use std::vec::Vec;

    fn wave(n: usize, k: f64) -> Vec<f32> {
        #[allow(clippy::cast_precision_loss, clippy::cast_possible_truncation, reason = "small")]
        let at = |i| libm::sin(i as f64 * k + 0.3) as f32;
        (0..n).map(at).collect()
    }

    /// Against `f64`, for every length.
    #[test]
    fn agrees_with_the_definition() {
        for n in 1..67 {
            for (scale, shift) in [(1.0, 0.0), (1e-4, 0.0), (30.0, 100.0), (0.0, 5.0)] {
                let mut x: Vec<f32> = wave(n, 1.7).iter().map(|x| x * scale + shift).collect();
                let (gain, bias) = (wave(n, 0.9), wave(n, 2.3));
                let wide: Vec<f64> = x.iter().map(|x| f64::from(*x)).collect();
                let count = x.len() as f64;
                let mean = wide.iter().sum::<f64>() / count;
                let variance = wide.iter().map(|x| (x - mean) * (x - mean)).sum::<f64>() / count;
                Norm { gain: &gain, bias: &bias }.apply(&mut x);
                for i in 0..n {
                    let y = (wide[i] - mean) / (variance + 1e-5).sqrt();
                    let want = y * f64::from(gain[i]) + f64::from(bias[i]);
                    // The mean loses digits of the shift; the spread divides them.
                    let lost = f64::from(shift) / (variance + 1e-5).sqrt();
                    let bound = 4e-7 * (1.0 + y.abs() + lost);
                    assert!((f64::from(x[i]) - want).abs() <= bound, "{n} {scale} {i}: {} {want}", x[i]);
                }
            }
        }
    }

    /// The order of the module's first lines, in other words: halves are added until one is left.
    #[test]
    fn the_order_of_the_sum_is_the_written_one() {
        for n in 0..200 {
            let x = wave(n, 0.7 + n as f64);
            let mut acc = [0.0_f32; 8];
            x.iter().enumerate().for_each(|(i, x)| acc[i % 8] += x);
            for half in [4, 2, 1] {
                (0..half).for_each(|j| acc[j] += acc[j + half]);
            }
            assert_eq!(sum(&x, |x| x).to_bits(), acc[0].to_bits(), "{n}");
        }
    }
}
