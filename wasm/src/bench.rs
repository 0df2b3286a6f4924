//! The spring stage and a network alone, for `bench.mjs`: whole frames do not tell what one stage costs.

use sinew::kernel::mlp::{Activation, Dense};
use sinew::kernel::spring::{Spring, Step};
use sinew::stage::dynamics::springs::State;
use wasm_bindgen::prelude::wasm_bindgen;

/// Springs on targets that go to and fro, as a step exchanges the old and the new ones.
#[wasm_bindgen]
#[allow(missing_debug_implementations, reason = "a handle for JavaScript")]
pub struct BenchSprings {
    arrays: [Vec<[f32; 3]>; 5],
    targets: Vec<[f32; 3]>,
    accelerations: Vec<[f32; 3]>,
    regions: Vec<u8>,
    step: Step,
}

#[wasm_bindgen]
impl BenchSprings {
    /// `n` springs of one region at rest.
    #[must_use]
    #[wasm_bindgen(constructor)]
    pub fn new(n: usize) -> Self {
        let step = Step::new(Spring::new(3.0, 0.3), 1.0 / 60.0, 1e-7);
        let zeros = || vec![[0.0; 3]; n];
        let arrays = core::array::from_fn(|_| zeros());
        let (targets, accelerations) = (vec![[0.01, -0.02, 0.03]; n], zeros());
        Self { arrays, targets, accelerations, regions: vec![0; n], step }
    }

    /// Runs `frames` steps; returns an offset, so that nothing is optimized away.
    pub fn run(&mut self, frames: u32) -> f32 {
        let [x, y, v, slope, f] = &mut self.arrays;
        let mut state = State { x, y, v, slope, f };
        let (mut targets, mut f) = (&mut self.targets[..], &mut self.accelerations[..]);
        for _ in 0..frames {
            state.advance(&mut targets, &mut f, &self.regions, core::slice::from_ref(&self.step));
        }
        state.y.first().map_or(0.0, |y| y[0])
    }
}

/// A quantised network, 96-64-64-48, as a corrective of a character would be.
#[wasm_bindgen]
#[allow(missing_debug_implementations, reason = "a handle for JavaScript")]
pub struct BenchNetwork {
    layers: Box<(Dense<96, 64>, Dense<64, 64>, Dense<64, 48>)>,
}

#[wasm_bindgen]
impl BenchNetwork {
    /// Weights of a fixed sequence.
    #[must_use]
    #[wasm_bindgen(constructor)]
    #[allow(clippy::new_without_default, reason = "JavaScript calls it")]
    pub fn new() -> Self {
        Self {
            layers: Box::new((dense(Activation::Relu), dense(Activation::Relu), dense(Activation::Identity))),
        }
    }

    /// Runs it `times` times, each input hanging on the output before; returns an output.
    pub fn run(&mut self, times: u32) -> f32 {
        let (a, b, c) = &*self.layers;
        #[allow(clippy::cast_precision_loss, reason = "small numbers")]
        let mut x: [f32; 96] = core::array::from_fn(|i| (i % 17) as f32 * 0.05 - 0.4);
        for _ in 0..times {
            x[0] = 1e-3 * c.forward(&b.forward(&a.forward(&x)))[0];
        }
        x[0]
    }
}

fn dense<const IN: usize, const OUT: usize>(activation: Activation) -> Dense<IN, OUT> {
    let (mut weights, mut s) = ([[0; IN]; OUT], 1_u32);
    for weight in weights.as_flattened_mut() {
        s = s.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        *weight = s.to_be_bytes()[0].cast_signed().max(-127);
    }
    Dense { weights, row_scale: [1e-3; OUT], bias: [0.01; OUT], input_scale: 0.01, activation }
}
