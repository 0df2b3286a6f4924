//! The built-in character: Plum, a plump creature with a big belly, long ears and a chunky tail, made by code.
//!
//! ```text
//! shape ─▶ mesh (half, mirrored) ─▶ weights, paint ─┐
//!    └───▶ face (eyes, nose, mouth) ────────────────┴─▶ Model ◀─ skeleton, clips
//! ```
//!
//! Ears, belly, cheeks and most of the tail have no joints: they are left to the flesh. All numbers come
//! from `f64` arithmetic, square roots and `libm`, in one thread and one order: the same bits on every host.

mod clips;
mod face;
mod mesh;
mod paint;
mod shape;
mod skeleton;
#[cfg(test)]
mod tests;
mod texture;
mod weights;

use crate::Model;
use crate::model::{Material, Node, Primitive};
use crate::pack::narrow;
use face::Feature;
use glam::{DQuat, DVec3};
use mesh::Half;
use shape::Shape;
use weights::{Influences, STRIDE};

/// Name of the character.
pub const NAME: &str = "Plum";

/// The character: about 1.6 units high, feet on `y = 0`, facing `+Z`, mirror-symmetric in `x`.
///
/// Clips: `idle`, `walk`, `jump` and `shake`, all of which loop.
#[must_use]
pub fn character() -> Model {
    let shape = Shape::creature();
    let mut nodes = skeleton::nodes();
    let carrier = nodes.len();
    nodes.push(Node {
        name: NAME.to_owned(),
        parent: None,
        translation: DVec3::ZERO,
        rotation: DQuat::IDENTITY,
        scale: DVec3::ONE,
    });
    let mut body = body(&shape);
    let mut face = Primitive { primitive: 1, ..empty() };
    for feature in face::features(&shape) {
        push_feature(&mut face, &feature);
    }
    (body.node, face.node) = (carrier, carrier);
    let material = Material { base_color: [1.0; 4], texture: Some(texture::png()), double_sided: false };
    Model {
        name: NAME.to_owned(),
        nodes,
        joints: skeleton::joints(),
        primitives: vec![body, face],
        rigid: Vec::new(),
        clips: clips::clips(),
        materials: vec![material],
        vrm: None,
    }
}

fn empty() -> Primitive {
    Primitive { stride: STRIDE, material: Some(0), ..Primitive::default() }
}

/// The body: the half, then its mirror image without the vertices on the plane.
fn body(shape: &Shape) -> Primitive {
    let half = Half::of(shape);
    let influences = weights::weights(shape, &half);
    let mut out = empty();
    let mut image: Vec<usize> = (0..half.positions.len()).collect();
    let left = 0..half.positions.len();
    for i in left.clone() {
        let paint = paint::uv(half.positions[i], half.normals[i]);
        push(&mut out, half.positions[i], half.normals[i], paint, &influences[i]);
    }
    for i in left.filter(|i| !half.seam[*i]) {
        image[i] = out.positions.len();
        let flip = |v: DVec3| v.with_x(-v.x);
        let paint = paint::uv(half.positions[i], half.normals[i]);
        push(&mut out, flip(half.positions[i]), flip(half.normals[i]), paint, &influences[i].mirrored());
    }
    for t in &half.triangles {
        out.indices.push(t.map(index));
        let [a, b, c] = t.map(|v| image[v]);
        out.indices.push([a, c, b].map(index));
    }
    out
}

fn push_feature(out: &mut Primitive, feature: &Feature) {
    let first = out.positions.len();
    let influences = Influences::only(feature.joint);
    for (k, p) in feature.positions.iter().enumerate() {
        push(out, *p, feature.normals[k], feature.uvs[k], &influences);
    }
    out.indices.extend(feature.triangles.iter().map(|t| t.map(|v| index(first + v))));
}

fn push(out: &mut Primitive, p: DVec3, normal: DVec3, uv: [f64; 2], influences: &Influences) {
    out.positions.push(p.to_array().map(narrow));
    out.normals.push(normal.to_array().map(narrow));
    out.uvs.push(uv.map(narrow));
    out.joints.extend(influences.joints.map(|j| u16::try_from(j).unwrap_or(0)));
    out.weights.extend(influences.weights.map(narrow));
}

fn index(v: usize) -> u32 {
    u32::try_from(v).unwrap_or(0)
}
