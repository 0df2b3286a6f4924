//! The spring stage.

use super::best;
use core::hint::black_box;
use serde_json::{Value, json};
use sinew::kernel::spring::{Knots, Spring, Step, advance};

/// Points.
const POINTS: usize = 10_000;

/// The spring stage against the same arithmetic in a plain loop over points.
pub(super) fn springs() -> Value {
    let (n, dt) = (3 * POINTS, 1.0 / 60.0);
    let step = Step::new(Spring::new(2.5, 0.3), dt, 1e-7);
    #[allow(clippy::cast_precision_loss, reason = "small numbers")]
    let wave: Vec<f32> = (0..n).map(|i| (i % 97) as f32 * 0.01).collect();
    let f = vec![-9.0_f32; n];
    let mut state = [const { Vec::new() }; 3].map(|_: Vec<f32>| vec![0.0; n]);
    let (mut x, mut f) = ([wave.clone(), vec![0.0; n]], [f.clone(), f]);
    let ours = best(POINTS, || {
        let [y, v, slope] = &mut state;
        let ([x0, x1], [f0, f1]) = (&x, &f);
        advance(&step, Knots { x: [x0, x1], f: [f0, f1], y, v, slope });
        x.swap(0, 1);
        f.swap(0, 1);
    });
    let mut state = vec![[0.0_f32; 5]; n];
    let g = &f[0];
    let weights = black_box([0.9_f32, 0.015, 0.4, 1e-4, 1e-4, -3.0, 0.8, 0.2, 0.01, 0.01]);
    let plain = best(POINTS, || {
        for (i, s) in state.iter_mut().enumerate() {
            let d = wave[i] - s[0];
            let (e, u) = (d - s[3] * dt, s[2] - s[3]);
            let y =
                weights[0] * s[1] + weights[1] * u + weights[2] * e + weights[3] * s[4] + weights[4] * g[i];
            let w =
                weights[5] * s[1] + weights[6] * u + weights[7] * e + weights[8] * s[4] + weights[9] * g[i];
            *s = [wave[i], y, w + d / dt, d / dt, g[i]];
        }
        black_box(&mut state);
    });
    json!({"name": "springs", "case": "10k points", "value": ours, "unit": "ns/vertex",
        "peers": [{"name": "plain loop", "value": plain}], "limit": 1.5})
}
