//! A small network with weights of a fixed sequence: what a learned correction would cost.

use sinew::kernel::mlp::{Activation, Dense};
use sinew::kernel::skin::Rows;

/// Numbers that go in.
pub const INPUTS: usize = 24;

/// Three layers, 24 → 32 → 16 → 8.
#[derive(Debug)]
pub struct Network(Dense<INPUTS, 32>, Dense<32, 16>, Dense<16, 8>);

/// In flash.
pub static NETWORK: Network = Network(
    layer(1, 1.0 / 64.0, Activation::Gelu),
    layer(2, 1.0 / 64.0, Activation::Tanh),
    layer(3, 1.0 / 127.0, Activation::Identity),
);

impl Network {
    /// What it makes of `x`.
    #[must_use]
    #[inline(never)] // A call of its own, as the figures count it.
    pub fn forward(&self, x: &[f32; INPUTS]) -> [f32; 8] {
        self.2.forward(&self.1.forward(&self.0.forward(x)))
    }
}

/// The first numbers of a palette, 0 past its end.
pub(crate) fn inputs(palette: &[Rows]) -> [f32; INPUTS] {
    let mut x = [0.0; INPUTS];
    for (x, from) in x.iter_mut().zip(palette.as_flattened().as_flattened()) {
        *x = *from;
    }
    x
}

/// A layer whose rows keep the size of their inputs.
const fn layer<const IN: usize, const OUT: usize>(
    seed: u32,
    input_scale: f32,
    activation: Activation,
) -> Dense<IN, OUT> {
    let mut layer = Dense {
        weights: [[0; IN]; OUT],
        row_scale: [1.0 / 512.0; OUT],
        bias: [0.0; OUT],
        input_scale,
        activation,
    };
    let (mut s, mut row) = (seed, 0);
    while row < OUT {
        let mut column = 0;
        while column < IN {
            s = next(s);
            layer.weights[row][column] = high_byte(s);
            column += 1;
        }
        s = next(s);
        layer.bias[row] = high_byte(s) as f32 / 512.0;
        row += 1;
    }
    layer
}

/// The linear congruential generator of Numerical Recipes.
const fn next(s: u32) -> u32 {
    s.wrapping_mul(1_664_525).wrapping_add(1_013_904_223)
}

/// The bits that vary best, within ±127.
const fn high_byte(s: u32) -> i8 {
    let byte = s.to_be_bytes()[0].cast_signed();
    if byte == -128 { -127 } else { byte }
}
