//! A model, ready to be drawn frame after frame.

use super::{Camera, Paint, Surface, Texture, render};
use crate::model::{Material, Model};
use glam::{DMat4, DVec3};
use image::RgbImage;
use rayon::prelude::*;

/// Color of surfaces without a material, linear: light clay.
const CLAY: [f32; 3] = [0.66, 0.60, 0.55];

/// A model with its textures decoded.
#[derive(Debug)]
pub struct Figure<'a> {
    model: &'a Model,
    /// One a material; `None` where there is none or it cannot be decoded.
    textures: Vec<Option<Texture>>,
}

/// One moment of a figure, model space.
#[derive(Clone, Copy, Debug)]
pub struct Pose<'a> {
    /// Positions of all render vertices, in the order of the primitives.
    pub positions: &'a [[f32; 3]],
    /// Unit normals, likewise.
    pub normals: &'a [[f32; 3]],
    /// Transforms of [`Model::rigid`], one each.
    pub rigid: &'a [DMat4],
    /// What is painted on it.
    pub show: Show<'a>,
}

/// What is painted on a figure.
#[derive(Clone, Copy, Debug)]
pub enum Show<'a> {
    /// Its materials.
    Materials,
    /// Heat `0..=1` a render vertex.
    Heat(&'a [f32]),
    /// A linear color a render vertex.
    Colors(&'a [[f32; 3]]),
}

impl<'a> Figure<'a> {
    /// Decodes the textures of `model`; one that cannot be decoded is left out, the material's color remains.
    #[must_use]
    pub fn new(model: &'a Model) -> Self {
        let decode = |m: &Material| m.texture.as_deref().and_then(|bytes| Texture::decode(bytes).ok());
        Self { model, textures: model.materials.par_iter().map(decode).collect() }
    }

    /// Draws one moment.
    ///
    /// # Panics
    ///
    /// If `pose` is not of this model: a slice shorter than the render vertices or the rigid meshes.
    #[must_use]
    pub fn draw(&self, pose: &Pose<'_>, camera: &Camera, width: u32, height: u32) -> RgbImage {
        let rigid: Vec<_> = self.model.rigid.iter().zip(pose.rigid).map(|(r, m)| placed(r, m)).collect();
        let mut surfaces = Vec::new();
        let mut start = 0;
        for p in &self.model.primitives {
            let range = start..start + p.positions.len();
            start = range.end;
            surfaces.push(Surface {
                positions: &pose.positions[range.clone()],
                normals: &pose.normals[range.clone()],
                uvs: &p.uvs,
                triangles: &p.indices,
                paint: match pose.show {
                    Show::Materials => self.paint(p.material),
                    Show::Heat(heat) => Paint::Heat(&heat[range]),
                    Show::Colors(colors) => Paint::Colors(&colors[range]),
                },
                double_sided: self.double_sided(p.material),
            });
        }
        for (r, (positions, normals)) in self.model.rigid.iter().zip(&rigid) {
            surfaces.push(Surface {
                positions,
                normals,
                uvs: &r.uvs,
                triangles: &r.indices,
                paint: match pose.show {
                    Show::Materials => self.paint(r.material),
                    // What hangs on a node has no flesh.
                    Show::Heat(_) | Show::Colors(_) => Paint::Heat(&[]),
                },
                double_sided: self.double_sided(r.material),
            });
        }
        render(&surfaces, camera, width, height)
    }

    fn paint(&self, material: Option<usize>) -> Paint<'_> {
        let Some((material, index)) = material.and_then(|i| Some((self.model.materials.get(i)?, i))) else {
            return Paint::Flat(CLAY);
        };
        let [r, g, b, _] = material.base_color;
        match &self.textures[index] {
            Some(texture) => Paint::Texture { texture, factor: [r, g, b] },
            // Pure white is what files say that say nothing.
            None if r.min(g).min(b) > 0.99 => Paint::Flat(CLAY),
            None => Paint::Flat([r, g, b]),
        }
    }

    fn double_sided(&self, material: Option<usize>) -> bool {
        material.and_then(|i| self.model.materials.get(i)).is_none_or(|m| m.double_sided)
    }
}

/// A rigid mesh where its node is.
#[allow(clippy::type_complexity, reason = "positions and normals")]
fn placed(mesh: &crate::model::RigidPrimitive, model_from_node: &DMat4) -> (Vec<[f32; 3]>, Vec<[f32; 3]>) {
    let wide = |v: &[f32; 3]| DVec3::from_array(v.map(f64::from));
    let turn = glam::DMat3::from_mat4(*model_from_node);
    // Normals go with the inverse transpose, here up to its length.
    let cofactor = glam::DMat3::from_cols(
        turn.y_axis.cross(turn.z_axis),
        turn.z_axis.cross(turn.x_axis),
        turn.x_axis.cross(turn.y_axis),
    );
    let positions =
        mesh.positions.iter().map(|p| model_from_node.transform_point3(wide(p)).as_vec3().to_array());
    let normal = |n: &[f32; 3]| (cofactor * wide(n)).normalize_or(DVec3::Y).as_vec3().to_array();
    (positions.collect(), mesh.normals.iter().map(normal).collect())
}
