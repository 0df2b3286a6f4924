//! An asset that owns its bytes.

use crate::error::Thrown;
use crate::memory::Aligned;
use js_sys::Uint8Array;
use self_cell::self_cell;
use sinew::Asset;
use std::rc::Rc;
use wasm_bindgen::prelude::wasm_bindgen;

self_cell! {
    /// Bytes, and the views over them.
    pub(crate) struct Parsed {
        owner: Aligned,
        #[covariant]
        dependent: Asset,
    }
}

/// An asset in the module's memory; its characters share it and keep it alive.
#[wasm_bindgen]
#[allow(missing_debug_implementations, reason = "a handle for JavaScript")]
pub struct RawAsset(pub(crate) Rc<Parsed>);

#[wasm_bindgen]
impl RawAsset {
    /// Copies `bytes` into the module's memory and checks them.
    ///
    /// # Errors
    ///
    /// For bytes that are not a whole, undamaged asset of this version, and without memory for them.
    pub fn parse(bytes: &Uint8Array) -> Result<Self, Thrown> {
        let mut owner = Aligned::zeroed(bytes.length() as usize)?;
        bytes.copy_to(owner.bytes_mut());
        Ok(Self(Rc::new(Parsed::try_new(owner, |owner| Asset::parse(owner.bytes()))?)))
    }

    fn views(&self) -> &Asset<'_> {
        self.0.borrow_dependent()
    }

    /// Content hash, 16 hexadecimal digits.
    #[must_use]
    pub fn hash(&self) -> String {
        format!("{:016x}", self.views().hash)
    }

    /// Number of joints.
    #[must_use]
    pub fn joints(&self) -> u32 {
        self.views().meta.joints
    }

    /// Number of render vertices.
    #[must_use]
    pub fn vertices(&self) -> u32 {
        self.views().meta.vertices
    }

    /// Number of moving points.
    #[must_use]
    pub fn points(&self) -> u32 {
        self.views().meta.active
    }

    /// Diagonal of the rest pose's bounding box, model units.
    #[must_use]
    pub fn body_size(&self) -> f32 {
        self.views().meta.body_size
    }

    /// Names of the regions.
    #[must_use]
    pub fn regions(&self) -> Vec<String> {
        (0..self.views().regions.len()).map(|i| self.views().region_name(i).to_owned()).collect()
    }

    /// Names of the clips.
    #[must_use]
    pub fn clip_names(&self) -> Vec<String> {
        self.clips().map(|clip| clip.name.to_owned()).collect()
    }

    /// Lengths of the clips, s.
    #[must_use]
    pub fn clip_durations(&self) -> Vec<f32> {
        self.clips().map(|clip| clip.duration).collect()
    }

    fn clips(&self) -> impl Iterator<Item = sinew::asset::Clip<'_>> {
        (0..).map_while(|i| self.views().clip(i))
    }

    /// Node, mesh, primitive, first vertex, vertices, 0 of each primitive, one after the other.
    #[must_use]
    pub fn primitives(&self) -> Vec<u32> {
        self.views().primitives.as_flattened().to_vec()
    }

    /// Index of each joint's node in the file that was baked.
    #[must_use]
    pub fn joint_nodes(&self) -> Vec<u32> {
        let views = self.views();
        views.joint_node.iter().map(|node| views.node_index[*node as usize]).collect()
    }

    /// Render vertices on moving points.
    #[must_use]
    pub fn moved(&self) -> Vec<u32> {
        self.views().moved.to_vec()
    }
}
