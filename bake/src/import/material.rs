//! Base color of materials.

use gltf::json::material::Material as JsonMaterial;
use gltf::json::texture::Info;
use gltf::json::{Index, Texture};

use glam::DVec2;

use super::container;
use super::source::Source;
use crate::Error;
use crate::model::Material;

/// All materials. A texture that cannot be found or is neither PNG nor JPEG is left out: the color remains.
pub(super) fn read(
    source: &Source<'_>,
    resolve: &mut dyn FnMut(&str) -> Result<Vec<u8>, Error>,
) -> Result<Vec<Material>, Error> {
    let mut materials = Vec::with_capacity(source.root.materials.len());
    for (index, json) in source.root.materials.iter().enumerate() {
        let base = &json.pbr_metallic_roughness;
        let texture = base.base_color_texture.as_ref().and_then(|info| image(source, info.index, resolve));
        let bytes = texture.as_ref().map_or(0, Vec::len) as u64;
        source.charge(bytes.div_ceil(4), &format!("material {index}"))?;
        materials.push(Material {
            base_color: base.base_color_factor.0,
            texture,
            double_sided: json.double_sided,
        });
    }
    Ok(materials)
}

/// Encoded bytes of a texture's image.
fn image(
    source: &Source<'_>,
    texture: Index<Texture>,
    resolve: &mut dyn FnMut(&str) -> Result<Vec<u8>, Error>,
) -> Option<Vec<u8>> {
    let texture = source.root.get(texture)?;
    let image = source.root.get(texture.source)?;
    let bytes = match (&image.uri, image.buffer_view) {
        (_, Some(view)) => source.view(view, "image").ok()?.to_vec(),
        (Some(uri), None) => container::load(source.file, "image", uri, resolve).ok()?,
        (None, None) => return None,
    };
    let known = bytes.starts_with(b"\x89PNG") || bytes.starts_with(&[0xFF, 0xD8, 0xFF]);
    known.then_some(bytes)
}

/// Reference to the base color texture of a material.
pub(super) fn base_color_texture<'s>(
    source: &'s Source<'_>,
    material: Option<Index<JsonMaterial>>,
) -> Option<&'s Info> {
    source.root.get(material?)?.pbr_metallic_roughness.base_color_texture.as_ref()
}

/// Number of the texture coordinates that a texture uses.
pub(super) fn uv_set(texture: &Info) -> u32 {
    let transform = texture.extensions.as_ref().and_then(|e| e.texture_transform.as_ref());
    transform.and_then(|t| t.tex_coord).unwrap_or(texture.tex_coord)
}

/// Applies the extension `KHR_texture_transform`: scale, then rotation, then offset.
pub(super) fn transform_uvs(texture: &Info, uvs: &mut [[f32; 2]]) {
    let Some(transform) = texture.extensions.as_ref().and_then(|e| e.texture_transform.as_ref()) else {
        return;
    };
    let (sin, cos) = libm::sincos(f64::from(transform.rotation.0));
    let (offset, scale) = (transform.offset.0.map(f64::from), transform.scale.0.map(f64::from));
    for uv in uvs {
        let [u, v] = [f64::from(uv[0]) * scale[0], f64::from(uv[1]) * scale[1]];
        let turned = DVec2::new(cos * u + sin * v + offset[0], cos * v - sin * u + offset[1]);
        *uv = turned.as_vec2().to_array();
    }
}
