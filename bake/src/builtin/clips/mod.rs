//! Clips: motions as functions of time, sampled into cubic splines.
//!
//! A key holds the motion's value and slope, so the sampled motion has no kinks: flesh feels no kicks
//! that the motion does not have.

mod curve;
mod motion;
mod pose;

use super::skeleton::{JOINTS, nodes};
use crate::model::{Channel, Clip, Interpolation, Property};
use crate::pack::narrow;
use glam::DQuat;
use pose::{Local, Pose};

/// Picks a property of a joint, padded to four numbers.
type Pick = fn(&Local) -> [f64; 4];

/// Keys a second.
const RATE: f64 = 24.0;
/// Half of the time over which slopes are measured, s.
const MOMENT: f64 = 1e-3;
/// Below this a property counts as unmoved.
const STILL: f64 = 1e-9;

/// All clips; the first is the default.
pub(super) fn clips() -> Vec<Clip> {
    vec![
        clip("walk", 1.0, motion::walk),
        clip("jump", motion::LEAP, motion::jump),
        clip("shake", 2.0, motion::shake),
        clip("idle", 4.0, motion::idle),
    ]
}

/// Samples a motion of period `duration`, s.
fn clip(name: &str, duration: f64, motion: fn(f64) -> Pose) -> Clip {
    let keys = whole(libm::round(duration * RATE));
    let time = |k: u32| duration * f64::from(k) / f64::from(keys);
    let at = |t: f64| motion(t - duration * libm::floor(t / duration)).solve();
    let mut samples: Vec<[Vec<Local>; 3]> =
        (0..keys).map(|k| [time(k) - MOMENT, time(k), time(k) + MOMENT].map(at)).collect();
    // The last key is the first, to the bit.
    samples.extend(samples.first().cloned());
    let times: Vec<f32> = (0..=keys).map(|k| narrow(time(k))).collect();
    let rest = nodes();
    let mut channels = Vec::new();
    for node in 0..JOINTS {
        let of_node = |pick: Pick| -> Vec<[[f64; 4]; 3]> {
            samples.iter().map(|s| [0, 1, 2].map(|m| pick(&s[m][node]))).collect()
        };
        let still = [
            rest[node].translation.extend(0.0).to_array(),
            DQuat::IDENTITY.to_array(),
            rest[node].scale.extend(0.0).to_array(),
        ];
        let properties: [(Property, Pick); 3] = [
            (Property::Translation, |l| l.translation.extend(0.0).to_array()),
            (Property::Rotation, |l| l.rotation.to_array()),
            (Property::Scale, |l| l.scale.extend(0.0).to_array()),
        ];
        for ((property, pick), still) in properties.into_iter().zip(still) {
            let rows = of_node(pick);
            if rows.iter().any(|r| r[1].iter().zip(still).any(|(x, s)| (x - s).abs() > STILL)) {
                let values = spline(rows, property);
                let interpolation = Interpolation::CubicSpline;
                channels.push(Channel { node, property, interpolation, times: times.clone(), values });
            }
        }
    }
    Clip { name: name.to_owned(), duration: narrow(duration), channels }
}

/// In-tangent, value and out-tangent of each key, from its samples before, at and after.
fn spline(mut rows: Vec<[[f64; 4]; 3]>, property: Property) -> Vec<f32> {
    let width = if property == Property::Rotation { 4 } else { 3 };
    let mut values = Vec::with_capacity(rows.len() * 3 * width);
    for row in &mut rows {
        if property == Property::Rotation {
            // Angles stay below a half turn, so one hemisphere holds all keys.
            for q in row.iter_mut().filter(|q| q[3] < 0.0) {
                *q = q.map(|x| -x);
            }
        }
        let slope: [f64; 4] = core::array::from_fn(|k| (row[2][k] - row[0][k]) / (2.0 * MOMENT));
        for x in [slope, row[1], slope] {
            values.extend(x[..width].iter().map(|x| narrow(*x)));
        }
    }
    values
}

#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "at most a hundred keys")]
fn whole(x: f64) -> u32 {
    x as u32
}
