//! Quantised layers against their definition in `i64` and `f64`, and the two sizes of them against each other.

use sinew::kernel::mlp::dot::MAX_INPUTS;
use sinew::kernel::mlp::{Activation, Dense, Layer, Norm, ShapeError};
use sinew_tests::random::Random;

const ACTIVATIONS: [Activation; 4] =
    [Activation::Identity, Activation::Relu, Activation::Tanh, Activation::Gelu];

/// A random layer of `inputs` and `outputs`.
struct Numbers {
    weights: Vec<i8>,
    row_scale: Vec<f32>,
    bias: Vec<f32>,
    x: Vec<f32>,
}

impl Numbers {
    fn new(random: &mut Random, inputs: usize, outputs: usize) -> Self {
        let mut some = |n: usize, size: f32| -> Vec<f32> { (0..n).map(|_| size * random.unit()).collect() };
        #[allow(clippy::cast_possible_truncation, reason = "within ±127")]
        let weights = some(inputs * outputs, 127.4).iter().map(|w| *w as i8).collect();
        let row_scale = some(outputs, 0.01).iter().map(|w| w.abs() + 1e-4).collect();
        Self { weights, row_scale, bias: some(outputs, 1.0), x: some(inputs, 2.0) }
    }

    fn layer(&self, input_scale: f32) -> Layer<'_> {
        Layer::new(self.x.len(), &self.weights, &self.row_scale, &self.bias, input_scale)
            .expect("lengths fit")
    }

    /// `y` before norm and activation, by the definition, and the bound of what rounding adds.
    fn sums(&self, input_scale: f32) -> Vec<(f64, f64)> {
        #[allow(clippy::cast_possible_truncation, reason = "within ±127")]
        let quantised = |x: &f32| libm::rint(f64::from(x * (1.0 / input_scale)).clamp(-127.0, 127.0)) as i64;
        let q: Vec<i64> = self.x.iter().map(quantised).collect();
        let row = |(i, row): (usize, &[i8])| {
            let z: i64 = row.iter().zip(&q).map(|(w, q)| i64::from(*w) * q).sum();
            let product = z as f64 * f64::from(self.row_scale[i]) * f64::from(input_scale);
            let y = product + f64::from(self.bias[i]);
            // Three products and a sum, half an ulp each.
            (y, 6e-8 * (3.0 * product.abs() + y.abs()))
        };
        self.weights.chunks(self.x.len()).enumerate().map(row).collect()
    }
}

fn activated(activation: Activation, y: f64) -> f64 {
    match activation {
        Activation::Identity => y,
        Activation::Relu => y.max(0.0),
        Activation::Tanh => libm::tanh(y),
        Activation::Gelu => {
            let v = 0.797_884_560_802_865_4 * (y + 0.044_715 * y * y * y);
            0.5 * y * (1.0 + libm::tanh(v))
        }
    }
}

#[test]
fn layers_agree_with_their_definition() {
    let mut random = Random::new(7);
    for (inputs, outputs) in [(1, 1), (3, 5), (96, 64), (67, 33), (130, 4), (600, 9)] {
        let numbers = Numbers::new(&mut random, inputs, outputs);
        for activation in ACTIVATIONS {
            let layer = numbers.layer(0.015).with_activation(activation);
            let (mut q, mut y) = (vec![0; inputs], vec![0.0; outputs]);
            layer.forward(&numbers.x, &mut q, &mut y).expect("lengths fit");
            for (y, (sum, bound)) in y.iter().zip(numbers.sums(0.015)) {
                let want = activated(activation, sum);
                // GELU rises by at most 1.13 a unit.
                let bound = 1.13 * bound + 6e-8 * want.abs();
                assert!(
                    (f64::from(*y) - want).abs() <= bound,
                    "{inputs}x{outputs} {activation:?}: {y} {want}"
                );
            }
        }
    }
}

#[test]
fn both_sizes_give_the_same_bits() {
    let mut random = Random::new(8);
    let numbers = Numbers::new(&mut random, 70, 13);
    for activation in ACTIVATIONS {
        let dense = Dense::<70, 13> {
            weights: core::array::from_fn(|r| core::array::from_fn(|i| numbers.weights[70 * r + i])),
            row_scale: core::array::from_fn(|r| numbers.row_scale[r]),
            bias: core::array::from_fn(|r| numbers.bias[r]),
            input_scale: 0.02,
            activation,
        };
        let layer = numbers.layer(0.02).with_activation(activation);
        let (mut q, mut y) = ([0; 70], [0.0; 13]);
        layer.forward(&numbers.x, &mut q, &mut y).expect("lengths fit");
        let x = core::array::from_fn(|i| numbers.x[i]);
        assert_eq!(dense.forward(&x).map(f32::to_bits), y.map(f32::to_bits), "{activation:?}");
    }
}

#[test]
fn a_measured_scale_uses_the_whole_range() {
    let mut random = Random::new(9);
    let numbers = Numbers::new(&mut random, 40, 3);
    let (mut q, mut y) = (vec![0; 40], vec![0.0; 3]);
    numbers.layer(0.0).forward(&numbers.x, &mut q, &mut y).expect("lengths fit");
    assert_eq!(q.iter().map(|q| q.unsigned_abs()).max(), Some(127));
    let largest = numbers.x.iter().fold(0.0_f32, |a, x| a.max(x.abs()));
    let mut fixed = vec![0.0; 3];
    numbers.layer(largest / 127.0).forward(&numbers.x, &mut q, &mut fixed).expect("lengths fit");
    assert_eq!(y, fixed);
}

/// A norm of gain 1 and bias 0 makes the mean 0 and the variance 1, before the activation.
#[test]
fn the_norm_comes_between_sum_and_activation() {
    let mut random = Random::new(10);
    let numbers = Numbers::new(&mut random, 50, 24);
    let (gain, bias) = (vec![1.0; 24], vec![0.0; 24]);
    let plain = numbers.layer(0.02).with_norm(Norm { gain: &gain, bias: &bias }).expect("lengths fit");
    let (mut q, mut y, mut cut) = (vec![0; 50], vec![0.0; 24], vec![0.0; 24]);
    plain.forward(&numbers.x, &mut q, &mut y).expect("lengths fit");
    let mean = y.iter().map(|y| f64::from(*y)).sum::<f64>() / 24.0;
    let variance = y.iter().map(|y| (f64::from(*y) - mean) * (f64::from(*y) - mean)).sum::<f64>() / 24.0;
    assert!(mean.abs() < 1e-6 && (variance - 1.0).abs() < 1e-4, "{mean} {variance}");
    let relu = plain.with_activation(Activation::Relu);
    relu.forward(&numbers.x, &mut q, &mut cut).expect("lengths fit");
    assert_eq!(cut, y.iter().map(|y| y.max(0.0)).collect::<Vec<_>>());
}

#[test]
fn special_inputs_stay_finite_where_they_can() {
    let weights = [100_i8, -100, 50];
    let layer = Layer::new(3, &weights, &[0.1], &[0.5], 0.01).expect("lengths fit");
    let mut q = [0; 3];
    for (x, want) in [
        ([f32::NAN, 0.0, 0.0], [0, 0, 0]),
        ([f32::INFINITY, f32::NEG_INFINITY, -0.0], [127, -127, 0]),
        ([f32::MAX, 1e-45, -1e-45], [127, 0, 0]),
        ([1.27, 1.28, -1.26], [127, 127, -126]),
    ] {
        let mut y = [f32::NAN];
        layer.forward(&x, &mut q, &mut y).expect("lengths fit");
        assert_eq!(q, want, "{x:?}");
        assert!(y[0].is_finite(), "{x:?}: {}", y[0]);
    }
}

#[test]
fn wrong_lengths_are_told() {
    let code = |r: Result<Layer<'_>, ShapeError>| r.map_or_else(|e| e.code(), |_| "ok");
    assert_eq!(code(Layer::new(2, &[1, 2], &[1.0], &[0.0], 1.0)), "ok");
    assert_eq!(code(Layer::new(0, &[], &[], &[], 1.0)), "LAYER_INPUTS");
    assert_eq!(code(Layer::new(MAX_INPUTS + 1, &[], &[], &[], 1.0)), "LAYER_INPUTS");
    assert_eq!(code(Layer::new(2, &[1, 2, 3], &[1.0], &[0.0], 1.0)), "LAYER_NUMBERS");
    assert_eq!(code(Layer::new(2, &[1, 2], &[1.0, 1.0], &[0.0], 1.0)), "LAYER_NUMBERS");
    let layer = Layer::new(2, &[1, 2], &[1.0], &[0.0], 1.0).expect("lengths fit");
    assert_eq!(code(layer.with_norm(Norm { gain: &[1.0], bias: &[] })), "LAYER_NUMBERS");
    let short = layer.forward(&[1.0], &mut [0; 2], &mut [0.0]);
    assert_eq!(short.expect_err("one input").to_string(), "1 numbers where the layer has 2");
}
