//! A baked animation that any viewer shows: frames as morph targets of plain meshes.
//!
//! Every kept frame is one target of position and normal; its weight is a hat over time, so that
//! between two frames a viewer interpolates linearly. At most [`MOST_TARGETS`] frames are kept,
//! evenly; played back at those times the positions are the runtime's to the last bit of the sum
//! `base + delta`.

use super::glb::{Builder, finish_primitive};
use crate::{Error, Model};
use serde_json::{Map, Value, json};

/// Frames that are kept at most; renderers store all targets in a texture.
pub const MOST_TARGETS: usize = 60;

/// A frame: time, positions, normals, model space, all render vertices.
#[derive(Clone, Debug)]
pub struct MorphFrame {
    /// Time, s.
    pub time: f32,
    /// Positions.
    pub positions: Vec<[f32; 3]>,
    /// Normals.
    pub normals: Vec<[f32; 3]>,
}

/// Which of `count` frames are kept.
#[must_use]
pub fn kept(count: usize) -> Vec<usize> {
    let n = count.min(MOST_TARGETS);
    (0..n).map(|k| if n == 1 { 0 } else { k * (count - 1) / (n - 1) }).collect()
}

/// The GLB of `frames` (see [`kept`]); the first is the base shape.
///
/// # Errors
///
/// [`Error::Unusable`] without frames, or beyond 4 GiB.
pub fn to_glb(model: &Model, clip: &str, frames: &[MorphFrame]) -> Result<Vec<u8>, Error> {
    let Some(base) = frames.first() else {
        return Err(Error::unusable(model.name.as_str(), "export", "there are no frames", "give --seconds"));
    };
    let mut b = Builder::default();
    let mut root = Map::new();
    b.materials(&model.materials, &mut root);
    let mut primitives = Vec::new();
    let mut first = 0;
    for p in &model.primitives {
        let range = first..first + p.positions.len();
        first = range.end;
        let (positions, normals) = (&base.positions[range.clone()], &base.normals[range.clone()]);
        let attributes = json!({"POSITION": b.positions(positions), "NORMAL": b.vertices(normals)});
        let targets: Vec<Value> = frames[1..]
            .iter()
            .map(|f| {
                let delta = |a: &[[f32; 3]], b: &[[f32; 3]]| -> Vec<[f32; 3]> {
                    a.iter().zip(b).map(|(a, b)| [a[0] - b[0], a[1] - b[1], a[2] - b[2]]).collect()
                };
                let position = b.positions(&delta(&f.positions[range.clone()], positions));
                let normal = b.vertices(&delta(&f.normals[range.clone()], normals));
                json!({"POSITION": position, "NORMAL": normal})
            })
            .collect();
        let mut primitive = json!({"attributes": attributes, "indices": b.triangles(&p.indices)});
        if !targets.is_empty() {
            primitive["targets"] = targets.into();
        }
        finish_primitive(&mut b, &mut primitive, &p.uvs, p.material);
        primitives.push(primitive);
    }
    let mut mesh = json!({"name": model.name, "primitives": primitives});
    if frames.len() > 1 {
        mesh["weights"] = json!(vec![0.0; frames.len() - 1]);
        root.insert("animations".into(), json!([hats(&mut b, clip, frames)]));
    }
    root.insert("meshes".into(), json!([mesh]));
    root.insert("nodes".into(), json!([{"name": model.name, "mesh": 0}]));
    root.insert("scenes".into(), json!([{"nodes": [0]}]));
    b.finish(root)
}

/// Weight `k` is 1 at frame `k + 1` and 0 at all others.
fn hats(b: &mut Builder, clip: &str, frames: &[MorphFrame]) -> Value {
    let times: Vec<f32> = frames.iter().map(|f| f.time).collect();
    let n = frames.len() - 1;
    let mut weights = vec![0.0; frames.len() * n];
    for k in 0..n {
        weights[(k + 1) * n + k] = 1.0;
    }
    let (input, output) = (b.times(&times), b.floats(&weights, "SCALAR", 1));
    json!({
        "name": clip,
        "samplers": [{"input": input, "output": output, "interpolation": "LINEAR"}],
        "channels": [{"sampler": 0, "target": {"node": 0, "path": "weights"}}],
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::Primitive;

    #[test]
    fn kept_frames_are_even_and_end_at_the_ends() {
        assert!(kept(0).is_empty());
        assert_eq!(kept(1), [0]);
        let k = kept(601);
        assert_eq!((k.len(), k[0], k[59]), (MOST_TARGETS, 0, 600));
        assert!(k.windows(2).all(|w| w[1] > w[0]));
    }

    #[test]
    fn playing_back_gives_the_frames() {
        let square = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
        let model = Model {
            name: "m".into(),
            primitives: vec![Primitive {
                positions: square.to_vec(),
                indices: vec![[0, 1, 2]],
                ..Primitive::default()
            }],
            ..Model::default()
        };
        let frame = |i: u8| MorphFrame {
            time: 0.5 * f32::from(i),
            positions: square.iter().map(|p| p.map(|x| x + 0.25 * f32::from(i))).collect(),
            normals: vec![[0.0, 0.0, 1.0]; 3],
        };
        let frames: Vec<MorphFrame> = (0..3).map(frame).collect();
        let glb = to_glb(&model, "c", &frames).unwrap();
        let file = gltf::Gltf::from_slice(&glb).unwrap();
        let blob = file.blob.as_deref().unwrap();
        let primitive = file.meshes().next().unwrap().primitives().next().unwrap();
        let reader = primitive.reader(|_| Some(blob));
        let base: Vec<[f32; 3]> = reader.read_positions().unwrap().collect();
        let last: Vec<[f32; 3]> = reader.read_morph_targets().nth(1).unwrap().0.unwrap().collect();
        for v in 0..3 {
            for k in 0..3 {
                assert!((base[v][k] + last[v][k] - frames[2].positions[v][k]).abs() < 1e-7);
            }
        }
        assert_eq!(file.animations().count(), 1);
    }
}
