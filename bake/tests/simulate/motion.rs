//! Flesh in motion.

use crate::{farthest, flesh, plum, walking};
use sinew_bake::fem::dynamics::Rayleigh;
use sinew_bake::simulate::{Settings, Simulation};

/// Steps a second.
const RATE: f64 = 60.0;

#[test]
fn what_is_at_rest_stays() {
    let model = plum();
    let mut flesh = flesh(&model);
    let pose = walking(&model, 0.3);
    flesh.settle(&pose);
    let settled = flesh.nodes().to_vec();
    for _ in 0..5 {
        assert!(flesh.step(&pose, 1.0 / RATE).unwrap().converged);
    }
    let apart = farthest(&flesh, flesh.nodes(), &settled);
    assert!(apart < 2e-6, "{apart:e}");
}

#[test]
fn flesh_lags_swings_and_comes_to_equilibrium() {
    let model = plum();
    // Swings halve their height every 0.35 s by the drag alone: after 4 s a three-thousandth is left.
    let damping = Rayleigh { mass: 4.0, stiffness: 0.005 };
    let mut flesh = Simulation::new(&model, &Settings { damping, ..Settings::draft() }).unwrap();
    let (from, to) = (walking(&model, 0.0), walking(&model, 0.25));
    flesh.settle(&to);
    let end = flesh.skin();
    flesh.settle(&from);
    let distances: Vec<f64> = (0..240)
        .map(|_| {
            assert!(flesh.step(&to, 1.0 / RATE).unwrap().converged);
            farthest(&flesh, &flesh.skin(), &end)
        })
        .collect();
    // It swings: the distance does not fall all the way down at once.
    let rises = distances.windows(2).filter(|d| d[1] > d[0]).count();
    println!("first {:.4}, after 4 s {:.1e} body sizes; {rises} rises", distances[0], distances[239]);
    assert!(distances[0] > 0.005 && rises > 5, "{} {rises}", distances[0]);
    assert!(distances[239] < 0.01 * distances[0], "{}", distances[239]);
}

#[test]
fn a_step_takes_time() {
    let model = plum();
    let mut flesh = flesh(&model);
    for h in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let error = flesh.step(&walking(&model, 0.0), h).err().map(|e| e.to_string()).unwrap_or_default();
        assert!(error.contains("above 0"), "{error}");
    }
}
