//! Animation clips.

use sinew::kernel::tiny::flush;
use std::collections::BTreeSet;

use glam::DQuat;
use gltf::json::animation::{
    Animation, Channel as JsonChannel, Interpolation as JsonInterpolation, Property as JsonProperty,
};
use gltf::json::validation::Checked;

use super::source::{Source, label};
use crate::Error;
use crate::model::{Channel, Clip, Interpolation, Property};

/// All clips; channels of morph weights and of unknown properties are left out.
pub(super) fn read(source: &Source<'_>) -> Result<Vec<Clip>, Error> {
    source.root.animations.iter().enumerate().map(|(index, json)| clip(source, index, json)).collect()
}

fn clip(source: &Source<'_>, index: usize, json: &Animation) -> Result<Clip, Error> {
    let label = label("animation", index, json.name.as_ref());
    let mut channels: Vec<Channel> = Vec::new();
    let mut animated = BTreeSet::new();
    for (number, channel) in json.channels.iter().enumerate() {
        let place = format!("{label}, channel {number}");
        let Some(channel) = self::channel(source, json, channel, &place)? else { continue };
        // The format allows one channel a property; exporters that write two mean the first.
        if animated.insert((channel.node, channel.property)) {
            channels.push(channel);
        }
    }
    let duration = channels.iter().filter_map(|c| c.times.last()).copied().fold(0.0, f32::max);
    let name = json.name.clone().filter(|n| !n.is_empty()).unwrap_or_else(|| format!("clip {index}"));
    Ok(Clip { name, duration, channels })
}

/// One channel; `None` if it moves no joint.
fn channel(
    source: &Source<'_>,
    animation: &Animation,
    json: &JsonChannel,
    place: &str,
) -> Result<Option<Channel>, Error> {
    let property = match json.target.path {
        Checked::Valid(JsonProperty::Translation) => Property::Translation,
        Checked::Valid(JsonProperty::Rotation) => Property::Rotation,
        Checked::Valid(JsonProperty::Scale) => Property::Scale,
        Checked::Valid(JsonProperty::MorphTargetWeights) | Checked::Invalid => return Ok(None),
    };
    source.get(&source.root.nodes, json.target.node, "node", place)?;
    let sampler = source.get(&animation.samplers, json.sampler, "sampler", place)?;
    let interpolation = match sampler.interpolation {
        Checked::Valid(JsonInterpolation::Linear) => Interpolation::Linear,
        Checked::Valid(JsonInterpolation::Step) => Interpolation::Step,
        Checked::Valid(JsonInterpolation::CubicSpline) => Interpolation::CubicSpline,
        Checked::Invalid => return Err(source.damaged(place, "its interpolation is unknown")),
    };
    let times = source.floats::<1>(sampler.input, &format!("{place}, times"))?.into_flattened();
    let values_place = format!("{place}, values");
    let values = match property {
        Property::Rotation => source.floats::<4>(sampler.output, &values_place)?.into_flattened(),
        Property::Translation | Property::Scale => {
            source.floats::<3>(sampler.output, &values_place)?.into_flattened()
        }
    };
    let width = if property == Property::Rotation { 4 } else { 3 };
    let per_key = width * if interpolation == Interpolation::CubicSpline { 3 } else { 1 };
    if values.len() < times.len() * per_key {
        let problem =
            format!("{} values where {} keys need {}", values.len(), times.len(), times.len() * per_key);
        return Err(source.damaged(place, problem));
    }
    if !times.iter().chain(&values).all(|x| x.is_finite()) {
        return Err(source.error(place, "a key is not finite", "repair the clip where it was made"));
    }
    // As the asset holds them: keys that are told apart here must be there.
    let times: Vec<f32> = times.into_iter().map(flush).collect();
    let (times, mut values) = ascending(&times, &values, per_key);
    if property == Property::Rotation && interpolation != Interpolation::CubicSpline {
        values.as_chunks_mut().0.iter_mut().for_each(normalize);
    }
    let node = json.target.node.value();
    Ok(Some(Channel { node, property, interpolation, times, values }).filter(|c| !c.times.is_empty()))
}

/// Keys whose time is later than that of all keys before; exporters sometimes write a key twice.
fn ascending(times: &[f32], values: &[f32], per_key: usize) -> (Vec<f32>, Vec<f32>) {
    let (mut kept_times, mut kept_values) =
        (Vec::with_capacity(times.len()), Vec::with_capacity(values.len()));
    for (time, value) in times.iter().zip(values.chunks_exact(per_key)) {
        if kept_times.last().is_none_or(|last| time > last) {
            kept_times.push(*time);
            kept_values.extend_from_slice(value);
        }
    }
    (kept_times, kept_values)
}

/// Makes a rotation a unit quaternion; a zero one the identity.
fn normalize(rotation: &mut [f32; 4]) {
    let exact = DQuat::from_array(rotation.map(f64::from));
    let unit = if exact.length_squared() > 0.0 { exact.normalize() } else { DQuat::IDENTITY };
    *rotation = unit.as_quat().to_array();
}

#[cfg(test)]
#[expect(clippy::float_cmp, reason = "the expected numbers are copied or exact in f32")]
mod tests {
    use super::*;

    #[test]
    fn a_key_that_does_not_advance_is_dropped() {
        let (times, values) = ascending(&[0.0, 1.0, 1.0, 0.5, 2.0], &[0.0, 1.0, 9.0, 9.0, 2.0], 1);
        assert_eq!((times, values), (vec![0.0, 1.0, 2.0], vec![0.0, 1.0, 2.0]));
    }

    #[test]
    fn rotations_become_unit() {
        let mut rotation = [0.0, 0.0, 3.0, 4.0];
        normalize(&mut rotation);
        assert_eq!(rotation, [0.0, 0.0, 0.6, 0.8]);
        let mut zero = [0.0; 4];
        normalize(&mut zero);
        assert_eq!(zero, [0.0, 0.0, 0.0, 1.0]);
    }
}
