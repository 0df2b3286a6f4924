//! GLB 2.0 out: a builder for the binary buffer, and whole models.

use crate::Error;
use crate::model::{Clip, Interpolation, Material, Model, Property};
use glam::DMat4;
use serde_json::{Map, Value, json};

/// Component types of glTF accessors.
const FLOAT: u32 = 5126;
const UNSIGNED_INT: u32 = 5125;
const UNSIGNED_SHORT: u32 = 5123;
/// Buffer view targets.
const VERTICES: u32 = 34962;
const INDICES: u32 = 34963;

/// Collects buffer views and accessors.
#[derive(Debug, Default)]
pub(super) struct Builder {
    bytes: Vec<u8>,
    views: Vec<Value>,
    accessors: Vec<Value>,
}

impl Builder {
    fn view(&mut self, bytes: &[u8], target: Option<u32>) -> usize {
        self.bytes.resize(self.bytes.len().next_multiple_of(4), 0);
        let mut view = json!({"buffer": 0, "byteOffset": self.bytes.len(), "byteLength": bytes.len()});
        if let Some(target) = target {
            view["target"] = json!(target);
        }
        self.bytes.extend_from_slice(bytes);
        self.views.push(view);
        self.views.len() - 1
    }

    fn accessor(&mut self, view: usize, component: u32, kind: &str, count: usize) -> usize {
        self.accessors
            .push(json!({"bufferView": view, "componentType": component, "count": count, "type": kind}));
        self.accessors.len() - 1
    }

    /// Vectors of `N` floats as a vertex attribute.
    pub(super) fn vertices<const N: usize>(&mut self, x: &[[f32; N]]) -> usize {
        let view = self.view(bytemuck::cast_slice(x.as_flattened()), Some(VERTICES));
        self.accessor(
            view,
            FLOAT,
            if N == 2 {
                "VEC2"
            } else if N == 3 {
                "VEC3"
            } else {
                "VEC4"
            },
            x.len(),
        )
    }

    /// Positions: a vertex attribute with its bounds, which the format asks for.
    pub(super) fn positions(&mut self, x: &[[f32; 3]]) -> usize {
        let accessor = self.vertices(x);
        let bound = |pick: fn(f32, f32) -> f32| {
            let first = x.first().copied().unwrap_or_default();
            x.iter().fold(first, |b, p| [pick(b[0], p[0]), pick(b[1], p[1]), pick(b[2], p[2])])
        };
        self.accessors[accessor]["min"] = json!(bound(f32::min));
        self.accessors[accessor]["max"] = json!(bound(f32::max));
        accessor
    }

    /// Floats of a sampler.
    pub(super) fn floats(&mut self, x: &[f32], kind: &str, components: usize) -> usize {
        let view = self.view(bytemuck::cast_slice(x), None);
        self.accessor(view, FLOAT, kind, x.len() / components)
    }

    /// Key times: floats with their bounds.
    pub(super) fn times(&mut self, x: &[f32]) -> usize {
        let accessor = self.floats(x, "SCALAR", 1);
        self.accessors[accessor]["min"] = json!([x.first()]);
        self.accessors[accessor]["max"] = json!([x.last()]);
        accessor
    }

    /// Triangles.
    pub(super) fn triangles(&mut self, x: &[[u32; 3]]) -> usize {
        let view = self.view(bytemuck::cast_slice(x.as_flattened()), Some(INDICES));
        self.accessor(view, UNSIGNED_INT, "SCALAR", x.len() * 3)
    }

    /// Edges of a drawing.
    #[cfg(feature = "simulate")]
    pub(super) fn lines(&mut self, x: &[[u32; 2]]) -> usize {
        let view = self.view(bytemuck::cast_slice(x.as_flattened()), Some(INDICES));
        self.accessor(view, UNSIGNED_INT, "SCALAR", x.len() * 2)
    }

    fn joints(&mut self, x: &[[u16; 4]]) -> usize {
        let view = self.view(bytemuck::cast_slice(x.as_flattened()), Some(VERTICES));
        self.accessor(view, UNSIGNED_SHORT, "VEC4", x.len())
    }

    /// Materials with their images, as glTF.
    pub(super) fn materials(&mut self, materials: &[Material], root: &mut Map<String, Value>) {
        let (mut images, mut out) = (Vec::new(), Vec::new());
        for m in materials {
            let mut pbr =
                json!({"baseColorFactor": m.base_color, "metallicFactor": 0.0, "roughnessFactor": 0.75});
            if let Some(bytes) = &m.texture {
                let view = self.view(bytes, None);
                let png = bytes.starts_with(b"\x89PNG");
                let mime = if png { "image/png" } else { "image/jpeg" };
                pbr["baseColorTexture"] = json!({"index": images.len()});
                images.push(json!({"bufferView": view, "mimeType": mime}));
            }
            out.push(json!({"pbrMetallicRoughness": pbr, "doubleSided": m.double_sided}));
        }
        if !images.is_empty() {
            let textures: Vec<Value> = (0..images.len()).map(|i| json!({"source": i})).collect();
            root.insert("images".into(), images.into());
            root.insert("textures".into(), textures.into());
        }
        if !out.is_empty() {
            root.insert("materials".into(), out.into());
        }
    }

    /// The file: `root` with the buffers added.
    pub(super) fn finish(mut self, mut root: Map<String, Value>) -> Result<Vec<u8>, Error> {
        self.bytes.resize(self.bytes.len().next_multiple_of(4), 0);
        root.insert("asset".into(), json!({"version": "2.0", "generator": "sinew"}));
        root.insert("scene".into(), json!(0));
        root.insert("buffers".into(), json!([{"byteLength": self.bytes.len()}]));
        root.insert("bufferViews".into(), self.views.into());
        root.insert("accessors".into(), self.accessors.into());
        let mut text = Value::Object(root).to_string().into_bytes();
        text.resize(text.len().next_multiple_of(4), b' ');
        let length = |n: usize| {
            u32::try_from(n).map_err(|_| {
                Error::unusable("glb", "export", "the file is larger than 4 GiB", "give fewer frames")
            })
        };
        let mut out = Vec::with_capacity(28 + text.len() + self.bytes.len());
        out.extend_from_slice(b"glTF\x02\x00\x00\x00");
        out.extend(length(28 + text.len() + self.bytes.len())?.to_le_bytes());
        for (bytes, tag) in [(&text, b"JSON"), (&self.bytes, b"BIN\0")] {
            out.extend(length(bytes.len())?.to_le_bytes());
            out.extend_from_slice(tag);
            out.extend_from_slice(bytes);
        }
        Ok(out)
    }
}

/// A model as a GLB file: skeleton, skinned and rigid meshes, materials, clips.
///
/// # Errors
///
/// [`Error::Unusable`] for a model beyond 4 GiB.
pub fn to_glb(model: &Model) -> Result<Vec<u8>, Error> {
    let mut b = Builder::default();
    let mut root = Map::new();
    b.materials(&model.materials, &mut root);
    let mut nodes: Vec<Value> = model.nodes.iter().enumerate().map(|(i, _)| node(model, i)).collect();
    let mut meshes = Vec::new();
    let mut scene: Vec<usize> = (0..nodes.len()).filter(|i| model.nodes[*i].parent.is_none()).collect();
    if !model.primitives.is_empty() {
        let primitives: Vec<Value> = model.primitives.iter().map(|p| skinned(&mut b, p)).collect();
        meshes.push(json!({"name": model.name, "primitives": primitives}));
        scene.push(nodes.len());
        nodes.push(json!({"name": model.name, "mesh": 0, "skin": 0}));
        let inverse: Vec<f32> = model.joints.iter().flat_map(|j| matrix(&j.joint_from_bind)).collect();
        let accessor = b.floats(&inverse, "MAT4", 16);
        let joints: Vec<usize> = model.joints.iter().map(|j| j.node).collect();
        root.insert("skins".into(), json!([{"joints": joints, "inverseBindMatrices": accessor}]));
    }
    for r in &model.rigid {
        let attributes = json!({"POSITION": b.positions(&r.positions), "NORMAL": b.vertices(&r.normals)});
        let mut primitive = json!({"attributes": attributes, "indices": b.triangles(&r.indices)});
        finish_primitive(&mut b, &mut primitive, &r.uvs, r.material);
        let child = nodes.len();
        nodes.push(json!({"mesh": meshes.len()}));
        meshes.push(json!({"primitives": [primitive]}));
        let children = nodes[r.node].as_object_mut().map(|n| n.entry("children").or_insert(json!([])));
        if let Some(Value::Array(children)) = children {
            children.push(json!(child));
        }
    }
    let clips: Vec<Value> = model.clips.iter().map(|c| animation(&mut b, c)).collect();
    if !clips.is_empty() {
        root.insert("animations".into(), clips.into());
    }
    root.insert("nodes".into(), nodes.into());
    root.insert("meshes".into(), meshes.into());
    root.insert("scenes".into(), json!([{"nodes": scene}]));
    b.finish(root)
}

fn matrix(m: &DMat4) -> [f32; 16] {
    m.to_cols_array().map(crate::pack::narrow)
}

fn node(model: &Model, i: usize) -> Value {
    let n = &model.nodes[i];
    let children: Vec<usize> = (0..model.nodes.len()).filter(|c| model.nodes[*c].parent == Some(i)).collect();
    let mut out = json!({
        "name": n.name,
        "translation": n.translation.to_array().map(crate::pack::narrow),
        "rotation": n.rotation.to_array().map(crate::pack::narrow),
        "scale": n.scale.to_array().map(crate::pack::narrow),
    });
    if !children.is_empty() {
        out["children"] = json!(children);
    }
    out
}

fn skinned(b: &mut Builder, p: &crate::model::Primitive) -> Value {
    let mut attributes = Map::new();
    attributes.insert("POSITION".into(), json!(b.positions(&p.positions)));
    attributes.insert("NORMAL".into(), json!(b.vertices(&p.normals)));
    for set in 0..p.stride / 4 {
        let joints: Vec<[u16; 4]> =
            p.joints.chunks_exact(p.stride).map(|r| core::array::from_fn(|k| r[set * 4 + k])).collect();
        let weights: Vec<[f32; 4]> =
            p.weights.chunks_exact(p.stride).map(|r| core::array::from_fn(|k| r[set * 4 + k])).collect();
        attributes.insert(format!("JOINTS_{set}"), json!(b.joints(&joints)));
        attributes.insert(format!("WEIGHTS_{set}"), json!(b.vertices(&weights)));
    }
    let mut out = json!({"attributes": attributes, "indices": b.triangles(&p.indices)});
    finish_primitive(b, &mut out, &p.uvs, p.material);
    out
}

pub(super) fn finish_primitive(b: &mut Builder, out: &mut Value, uvs: &[[f32; 2]], material: Option<usize>) {
    if !uvs.is_empty() {
        out["attributes"]["TEXCOORD_0"] = json!(b.vertices(uvs));
    }
    if let Some(material) = material {
        out["material"] = json!(material);
    }
}

fn animation(b: &mut Builder, clip: &Clip) -> Value {
    let (mut samplers, mut channels) = (Vec::new(), Vec::new());
    for c in &clip.channels {
        let (path, kind, components) = match c.property {
            Property::Translation => ("translation", "VEC3", 3),
            Property::Rotation => ("rotation", "VEC4", 4),
            Property::Scale => ("scale", "VEC3", 3),
        };
        let interpolation = match c.interpolation {
            Interpolation::Step => "STEP",
            Interpolation::Linear => "LINEAR",
            Interpolation::CubicSpline => "CUBICSPLINE",
        };
        channels.push(json!({"sampler": samplers.len(), "target": {"node": c.node, "path": path}}));
        let (input, output) = (b.times(&c.times), b.floats(&c.values, kind, components));
        samplers.push(json!({"input": input, "output": output, "interpolation": interpolation}));
    }
    json!({"name": clip.name, "samplers": samplers, "channels": channels})
}
