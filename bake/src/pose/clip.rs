//! Poses of a model's own clips, at an even rate.

use super::Pose;
use crate::model::{Clip, Model};
use crate::{Error, play};

/// Most poses of a clip: an hour at 1000 Hz.
const MOST_POSES: f64 = 3.6e6;

impl Pose {
    /// The pose of `clip`, one of `model`'s, at time `t`, s; before its first and after its last key that key's.
    ///
    /// Scales of the clip are left out: bones do not stretch.
    #[must_use]
    pub fn of_clip(model: &Model, clip: &Clip, t: f32) -> Self {
        let nodes = play::nodes_at(model, Some(clip), t);
        Self {
            rotations: nodes.iter().map(|n| n.rotation).collect(),
            translations: nodes.iter().map(|n| n.translation).collect(),
        }
    }
}

/// Poses of `clip`, one of `model`'s, at times `k/rate` from 0 to its end; at least the first.
///
/// ```
/// use sinew_bake::{builtin, pose::clip};
/// let model = builtin::character();
/// let poses = clip::poses(&model, &model.clips[0], 10.0)?;
/// assert_eq!(poses.len(), 1 + (model.clips[0].duration * 10.0) as usize);
/// # Ok::<(), sinew_bake::Error>(())
/// ```
///
/// # Errors
///
/// [`Error::Unusable`] for a rate that is not above 0 or that gives more than 3.6 million poses.
pub fn poses(model: &Model, clip: &Clip, rate: f64) -> Result<Vec<Pose>, Error> {
    let count = libm::floor(f64::from(clip.duration) * rate);
    if !(rate > 0.0 && (0.0..MOST_POSES).contains(&count)) {
        let (place, problem) = (format!("clip `{}`", clip.name), format!("{rate} poses a second"));
        return Err(Error::unusable(&model.name, place, problem, "give a rate such as 10 Hz"));
    }
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "within 0..=3.6e6")]
    let count = count as u32;
    #[allow(clippy::cast_possible_truncation, reason = "times of a clip are f32")]
    let time = |k: u32| (f64::from(k) / rate) as f32;
    Ok((0..=count).map(|k| Pose::of_clip(model, clip, time(k))).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::builtin;
    use crate::model::{Channel, Interpolation, Property};
    use glam::{DQuat, DVec3};

    /// A clip that turns a node evenly by 1.5 rad in 3 s and slides another.
    fn model() -> Model {
        let mut model = builtin::character();
        let channel = |node, property, values: Vec<f32>| Channel {
            node,
            property,
            interpolation: Interpolation::Linear,
            times: vec![0.0, 3.0],
            values,
        };
        let end = DQuat::from_rotation_x(1.5).as_quat().to_array();
        let turn = channel(2, Property::Rotation, [[0.0, 0.0, 0.0, 1.0], end].concat());
        let slide = channel(0, Property::Translation, vec![0.0, 0.0, 0.0, 0.0, 6.0, 0.0]);
        model.clips = vec![Clip { name: "turn".to_owned(), duration: 3.0, channels: vec![turn, slide] }];
        model
    }

    #[test]
    fn poses_come_at_the_rate_that_was_asked_for() {
        let model = model();
        let poses = poses(&model, &model.clips[0], 2.0).unwrap();
        assert_eq!(poses.len(), 7);
        for (k, pose) in (0..).zip(&poses) {
            let t = 0.5 * f64::from(k);
            let there = DQuat::from_rotation_x(0.5 * t);
            // Keys, and slerp between them, are f32: a few of its ulp.
            assert!(crate::pose::angle_between(pose.rotations[2], there) < 1e-6, "{k}");
            assert!(pose.translations[0].distance(DVec3::Y * 2.0 * t) < 1e-6, "{k}");
            assert_eq!(pose.rotations[3], model.nodes[3].rotation, "what no channel moves is at rest");
        }
    }

    #[test]
    fn rates_that_are_none_are_refused() {
        let model = model();
        for rate in [0.0, -1.0, f64::NAN, f64::INFINITY, 1e9] {
            let text = poses(&model, &model.clips[0], rate).unwrap_err().to_string();
            assert!(text.contains("clip `turn`"), "{text}");
        }
        assert_eq!(poses(&model, &model.clips[0], 0.1).unwrap().len(), 1);
    }
}
