//! Quantised layers: the quantiser, the sums, and layers with every activation and a norm.

use super::{Named, bits, of_words};
use sinew::kernel::mlp::quantize::{quantize, scale_of};
use sinew::kernel::mlp::{Activation, Dense, Layer, Norm, dot};

/// Every so manieth bit pattern is quantised.
const STRIDE: usize = 300_007;
/// Shape of a layer: no multiple of any register.
const INPUTS: usize = 83;
const OUTPUTS: usize = 37;

/// Digests of the parts, then of whole layers.
pub(crate) fn digests() -> Vec<Named> {
    let byte = |q: i8| u64::from(q.cast_unsigned());
    let bytes = (0..=u32::MAX).step_by(STRIDE).map(|word| {
        let mut q = [0];
        quantize(&[f32::from_bits(word)], 1.0 / 0.03, &mut q);
        byte(q[0])
    });
    let mut all = vec![("quantize".to_owned(), of_words(bytes))];
    let (weights, q): (Vec<i8>, Vec<i8>) =
        (numbers(1).take(INPUTS * OUTPUTS).collect(), numbers(2).take(INPUTS).collect());
    let mut sums = Vec::new();
    dot::rows(&weights, &q, |_, z| sums.push(u64::from(z.cast_unsigned())));
    all.push(("int8 sums".to_owned(), of_words(sums)));
    for activation in [Activation::Identity, Activation::Relu, Activation::Tanh, Activation::Gelu] {
        all.push((format!("layer {activation:?}"), of_words(dense(activation).into_iter().map(bits))));
        let name = format!("layer {activation:?}, normalized");
        all.push((name, of_words(layer(activation, &weights).into_iter().map(bits))));
    }
    all
}

/// A layer whose shape is in its type, 20 times.
fn dense(activation: Activation) -> Vec<f32> {
    let mut layer = Dense {
        weights: [[0; INPUTS]; OUTPUTS],
        row_scale: core::array::from_fn(|row| waves(3)(row) * 1e-2),
        bias: core::array::from_fn(waves(4)),
        input_scale: 0.007,
        activation,
    };
    layer.weights.as_flattened_mut().iter_mut().zip(numbers(1)).for_each(|(w, x)| *w = x);
    (0..20).flat_map(|k| layer.forward(&core::array::from_fn(waves(10 + k)))).collect()
}

/// A layer over slices that measures its inputs and has a norm, 20 times.
fn layer(activation: Activation, weights: &[i8]) -> Vec<f32> {
    let [scale, bias, gain, shift] = [3, 4, 5, 6].map(|k| (0..OUTPUTS).map(waves(k)).collect::<Vec<f32>>());
    let layer = Layer::new(INPUTS, weights, &scale, &bias, 0.0)
        .and_then(|layer| layer.with_norm(Norm { gain: &gain, bias: &shift }))
        .expect("the lengths fit")
        .with_activation(activation);
    let mut all = Vec::new();
    for k in 0..20 {
        let (x, mut q, mut y): (Vec<f32>, _, _) =
            ((0..INPUTS).map(waves(30 + k)).collect(), [0; INPUTS], [0.0; OUTPUTS]);
        layer.forward(&x, &mut q, &mut y).expect("the lengths fit");
        all.extend(y);
        all.push(scale_of(&x));
    }
    all
}

/// Numbers within ±127 of a fixed sequence.
fn numbers(seed: u32) -> impl Iterator<Item = i8> {
    let mut s = seed;
    core::iter::repeat_with(move || {
        s = s.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        s.to_be_bytes()[0].cast_signed().max(-127)
    })
}

/// Floats within ±1 by index.
fn waves(k: u16) -> impl Fn(usize) -> f32 {
    move |i| sinew::math::trig::sin(f32::from(k) + 0.7 * f32::from(u16::try_from(i).unwrap_or(0)))
}
