//! The spring stage alone, for `bench.mjs`: whole frames do not tell what one stage costs.

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
