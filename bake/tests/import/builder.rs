//! Small glTF files made in code: JSON with the buffer in a data URI.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use serde_json::{Value, json};
use sinew_bake::import::import_bytes;
use sinew_bake::{Error, Model};

pub(crate) const I8: u32 = 5120;
pub(crate) const U8: u32 = 5121;
pub(crate) const I16: u32 = 5122;
pub(crate) const U16: u32 = 5123;
pub(crate) const U32: u32 = 5125;
pub(crate) const F32: u32 = 5126;

/// A glTF file under construction.
pub(crate) struct Builder {
    pub(crate) json: Value,
    pub(crate) bytes: Vec<u8>,
}

impl Builder {
    pub(crate) fn new() -> Self {
        let json = json!({
            "asset": {"version": "2.0"}, "buffers": [], "bufferViews": [], "accessors": [],
            "nodes": [], "meshes": [], "skins": [], "animations": [], "materials": [],
        });
        Self { json, bytes: Vec::new() }
    }

    /// Appends to a list of the file; returns the index.
    pub(crate) fn push(&mut self, list: &str, value: Value) -> usize {
        let list = self.json[list].as_array_mut().unwrap();
        list.push(value);
        list.len() - 1
    }

    /// A buffer view over new bytes, 4-byte aligned.
    pub(crate) fn view(&mut self, bytes: &[u8]) -> usize {
        self.bytes.resize(self.bytes.len().next_multiple_of(4), 0);
        let offset = self.bytes.len();
        self.bytes.extend_from_slice(bytes);
        self.push("bufferViews", json!({"buffer": 0, "byteOffset": offset, "byteLength": bytes.len()}))
    }

    /// An accessor over new bytes.
    pub(crate) fn accessor(
        &mut self,
        bytes: &[u8],
        component: u32,
        shape: &str,
        count: usize,
        normalized: bool,
    ) -> usize {
        let view = self.view(bytes);
        self.push("accessors", json!({
            "bufferView": view, "componentType": component, "type": shape, "count": count, "normalized": normalized,
        }))
    }

    pub(crate) fn floats(&mut self, shape: &str, count: usize, values: &[f32]) -> usize {
        let bytes: Vec<u8> = values.iter().flat_map(|v| v.to_le_bytes()).collect();
        self.accessor(&bytes, F32, shape, count, false)
    }

    pub(crate) fn bytes(&mut self, shape: &str, count: usize, values: &[u8]) -> usize {
        self.accessor(values, U8, shape, count, false)
    }

    /// Adds an attribute to primitive 0 of mesh 0.
    pub(crate) fn attribute(&mut self, name: &str, accessor: usize) {
        self.json["meshes"][0]["primitives"][0]["attributes"][name] = json!(accessor);
    }

    /// The JSON file.
    pub(crate) fn file(&self) -> Vec<u8> {
        let mut json = self.json.clone();
        let uri = format!("data:application/octet-stream;base64,{}", STANDARD.encode(&self.bytes));
        json["buffers"] = json!([{"byteLength": self.bytes.len(), "uri": uri}]);
        serde_json::to_vec(&json).unwrap()
    }

    /// The binary container.
    pub(crate) fn glb(&self) -> Vec<u8> {
        let mut json = self.json.clone();
        json["buffers"] = json!([{"byteLength": self.bytes.len()}]);
        let glb = gltf::binary::Glb {
            header: gltf::binary::Header { magic: *b"glTF", version: 2, length: 0 },
            json: serde_json::to_vec(&json).unwrap().into(),
            bin: Some(self.bytes.as_slice().into()),
        };
        glb.to_vec().unwrap()
    }

    pub(crate) fn import(&self) -> Result<Model, Error> {
        import_alone("test.gltf", &self.file())
    }

    /// The error of a file that must be refused.
    pub(crate) fn refused(&self) -> String {
        self.import().expect_err("the file must be refused").to_string()
    }
}

/// Imports a file that refers to no other.
pub(crate) fn import_alone(name: &str, bytes: &[u8]) -> Result<Model, Error> {
    import_bytes(name, bytes, &mut |uri| Err(Error::unusable(name, uri, "not there", "none")))
}

pub(crate) const SQUARE: [f32; 12] = [0., 0., 0., 1., 0., 0., 1., 1., 0., 0., 1., 0.];

/// A unit square of two triangles, vertices 0, 1 on joint 0 and 2, 3 on joint 1. Node 0: mesh; 1 and 2: joints.
pub(crate) fn square() -> Builder {
    let mut b = Builder::new();
    let positions = b.floats("VEC3", 4, &SQUARE);
    let indices = b.bytes("SCALAR", 6, &[0, 1, 2, 0, 2, 3]);
    let joints = b.bytes("VEC4", 4, &[0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0]);
    let weights = b.floats("VEC4", 4, &[1., 0., 0., 0.].repeat(4));
    b.push("meshes", json!({"primitives": [{
        "attributes": {"POSITION": positions, "JOINTS_0": joints, "WEIGHTS_0": weights}, "indices": indices,
    }]}));
    b.push("nodes", json!({"mesh": 0, "skin": 0}));
    b.push("nodes", json!({"name": "root", "children": [2]}));
    b.push("nodes", json!({"name": "tip", "translation": [0, 1, 0]}));
    b.push("skins", json!({"joints": [1, 2]}));
    b
}
