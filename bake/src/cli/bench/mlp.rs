//! Quantised networks: a small one in cache, and a matrix that no cache holds.

use super::best;
use core::hint::black_box;
use serde_json::{Value, json};
use sinew::kernel::mlp::{Activation, Dense, Layer};
use std::process::Command;

/// Rows and columns of the large matrix: 384 MiB, beyond the caches of servers.
const LARGE: [usize; 2] = [24_576, 16_384];
/// Networks a round.
const REPEATS: usize = 1_000;

/// Numbers of a fixed sequence.
fn weights(n: usize) -> impl Iterator<Item = i8> {
    let mut s = 1_u32;
    let next = move || {
        s = s.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (s >> 24).to_le_bytes()[0].cast_signed().max(-127)
    };
    core::iter::repeat_with(next).take(n)
}

fn dense<const IN: usize, const OUT: usize>(activation: Activation) -> Box<Dense<IN, OUT>> {
    let mut layer = Box::new(Dense {
        weights: [[0; IN]; OUT],
        row_scale: [1e-3; OUT],
        bias: [0.01; OUT],
        input_scale: 0.01,
        activation,
    });
    layer.weights.as_flattened_mut().iter_mut().zip(weights(IN * OUT)).for_each(|(w, x)| *w = x);
    layer
}

/// 96-64-64-48, one input at a time.
pub(super) fn small() -> Value {
    let (a, b) = (dense::<96, 64>(Activation::Relu), dense::<64, 64>(Activation::Relu));
    let c = dense::<64, 48>(Activation::Identity);
    #[allow(clippy::cast_precision_loss, reason = "small numbers")]
    let mut x: [f32; 96] = core::array::from_fn(|i| (i % 17) as f32 * 0.05 - 0.4);
    let value = best(REPEATS, || {
        for _ in 0..REPEATS {
            let y = c.forward(&b.forward(&a.forward(black_box(&x))));
            x[0] = 1e-3 * y[0];
        }
    });
    let peers = onnxruntime("small", 1e3);
    json!({"name": "mlp-small", "case": "96-64-64-48", "value": 1e-3 * value, "unit": "us", "peers": peers,
        "limit": 0.5})
}

/// A matrix times a vector, against the time to read the matrix.
pub(super) fn large() -> Value {
    let [rows, columns] = LARGE;
    let weights: Vec<i8> = weights(rows * columns).collect();
    let (scale, bias) = (vec![1e-3; rows], vec![0.0; rows]);
    let layer = Layer::new(columns, &weights, &scale, &bias, 0.01).expect("lengths fit");
    let x = vec![0.25; columns];
    let (mut q, mut y) = (vec![0; columns], vec![0.0; rows]);
    let value = best(1, || layer.forward(black_box(&x), &mut q, &mut y).expect("lengths fit"));
    let read = best(1, || {
        black_box(read(black_box(&weights)));
    });
    let mut peers = vec![json!({"name": "reading it", "value": 1e-6 * read})];
    peers.extend(onnxruntime("large", 1.0));
    json!({"name": "mlp-int8", "case": "24576x16384", "value": 1e-6 * value, "unit": "ms", "peers": peers,
        "limit": 1e-6 * read / 0.8})
}

/// Reads all bytes, in as many streams as rows share a pass; what is done with them costs next to nothing.
fn read(bytes: &[i8]) -> [u64; 4] {
    let words: &[[u64; 8]] = bytemuck::cast_slice(bytes);
    let quarter = words.len() / 4;
    let streams: [_; 4] = core::array::from_fn(|i| &words[i * quarter..][..quarter]);
    let mut sums = [[0_u64; 8]; 4];
    for k in 0..quarter {
        for (sum, stream) in sums.iter_mut().zip(streams) {
            let line = &stream[k];
            *sum = core::array::from_fn(|i| sum[i] ^ line[i]);
        }
    }
    sums.map(|sum| sum.iter().fold(0, |a, b| a ^ b))
}

/// The same work by onnxruntime where Python has it: times of its rows, given in ms, in `per_ms` parts of one.
fn onnxruntime(case: &str, per_ms: f64) -> Vec<Value> {
    let python = std::env::var("SINEW_PYTHON").unwrap_or_else(|_| "python3".to_owned());
    let run = Command::new(python).args(["-c", include_str!("onnxruntime.py"), case]).output();
    let Some(output) = run.ok().filter(|output| output.status.success()) else { return Vec::new() };
    let text = String::from_utf8_lossy(&output.stdout);
    let row = |line: &str| {
        let (name, ms) = line.split_once(": ")?;
        Some(json!({"name": name, "value": ms.trim().parse::<f64>().ok()? * per_ms}))
    };
    text.lines().filter_map(row).collect()
}
