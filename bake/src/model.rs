//! A rigged character in memory: what every importer makes and every later step reads.
//!
//! Positions and normals are in *bind space* (the space of the glTF position attribute); a skinned
//! vertex is in *model space* (the scene of the file):
//! `x = Σₖ wₖ · model_from_joint(jₖ) · joint_from_bind(jₖ) · p`.

use glam::{DMat4, DQuat, DVec3};

/// A character: skeleton, skinned meshes, clips.
#[derive(Clone, Debug, Default)]
pub struct Model {
    /// Name of the character: the file's stem, or the built-in's name.
    pub name: String,
    /// All nodes of the file; a parent may come after its child.
    pub nodes: Vec<Node>,
    /// Joints of all skins; `(node, joint_from_bind)` pairs, each pair once.
    pub joints: Vec<Joint>,
    /// Skinned triangle meshes, in file order (node, then mesh, then primitive). Render vertices are
    /// numbered through them in this order.
    pub primitives: Vec<Primitive>,
    /// Meshes without a skin that hang on a node: drawn, never deformed.
    pub rigid: Vec<RigidPrimitive>,
    /// Animation clips.
    pub clips: Vec<Clip>,
    /// Materials; [`Primitive::material`] indexes them.
    pub materials: Vec<Material>,
    /// What a VRM file says about spring bones; `None` for other files.
    pub vrm: Option<Vrm>,
}

/// A node: a transform relative to its parent.
#[derive(Clone, Debug, PartialEq)]
pub struct Node {
    /// Name in the file, or empty.
    pub name: String,
    /// Index of the parent node.
    pub parent: Option<usize>,
    /// Rest translation.
    pub translation: DVec3,
    /// Rest rotation, normalized.
    pub rotation: DQuat,
    /// Rest scale; may be negative.
    pub scale: DVec3,
}

/// A joint of a skin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Joint {
    /// Node that moves it.
    pub node: usize,
    /// Inverse bind matrix.
    pub joint_from_bind: DMat4,
}

/// A skinned triangle mesh with one material.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Primitive {
    /// Node that carries the mesh.
    pub node: usize,
    /// Index of the mesh in the file.
    pub mesh: usize,
    /// Index of the primitive in the mesh.
    pub primitive: usize,
    /// Positions, bind space.
    pub positions: Vec<[f32; 3]>,
    /// Unit normals, bind space; computed where the file has none.
    pub normals: Vec<[f32; 3]>,
    /// Texture coordinates; empty where the file has none.
    pub uvs: Vec<[f32; 2]>,
    /// Influences a vertex: a multiple of 4, at least 4.
    pub stride: usize,
    /// `stride` rows of [`Model::joints`] a vertex.
    pub joints: Vec<u16>,
    /// `stride` weights a vertex, not negative, descending, sum 1.
    pub weights: Vec<f32>,
    /// Triangles.
    pub indices: Vec<[u32; 3]>,
    /// Painted softness `0..=1` from the vertex attribute `_SINEW`.
    pub painted: Option<Vec<f32>>,
    /// Whether the primitive has morph targets (they are left alone).
    pub morphs: bool,
    /// Index into [`Model::materials`].
    pub material: Option<usize>,
}

/// A mesh that hangs on a node.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RigidPrimitive {
    /// Node that carries the mesh.
    pub node: usize,
    /// Positions, node space.
    pub positions: Vec<[f32; 3]>,
    /// Unit normals, node space.
    pub normals: Vec<[f32; 3]>,
    /// Texture coordinates; empty where the file has none.
    pub uvs: Vec<[f32; 2]>,
    /// Triangles.
    pub indices: Vec<[u32; 3]>,
    /// Index into [`Model::materials`].
    pub material: Option<usize>,
}

/// What is needed to draw a surface.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Material {
    /// Base colour, linear RGBA.
    pub base_color: [f32; 4],
    /// Encoded image (PNG or JPEG) of the base colour.
    pub texture: Option<Vec<u8>>,
    /// Draw both sides.
    pub double_sided: bool,
}

/// An animation clip.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Clip {
    /// Name in the file, or `clip N`.
    pub name: String,
    /// Length in seconds: the last key of any channel.
    pub duration: f32,
    /// Animated properties.
    pub channels: Vec<Channel>,
}

/// One animated property of one node.
#[derive(Clone, Debug, PartialEq)]
pub struct Channel {
    /// Animated node.
    pub node: usize,
    /// Animated property.
    pub property: Property,
    /// How keys are joined.
    pub interpolation: Interpolation,
    /// Key times, s, strictly ascending, at least one.
    pub times: Vec<f32>,
    /// Values: 3 (translation, scale) or 4 (rotation, `[x, y, z, w]`) floats a key; for
    /// [`Interpolation::CubicSpline`] three times as many (in-tangent, value, out-tangent).
    pub values: Vec<f32>,
}

/// Property of a node that a channel animates.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Property {
    /// Translation.
    Translation,
    /// Rotation.
    Rotation,
    /// Scale.
    Scale,
}

/// How a channel's keys are joined (glTF 2.0, appendix C).
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Interpolation {
    /// Value of the key before.
    Step,
    /// Linear; rotations by slerp.
    Linear,
    /// Cubic Hermite spline with tangents.
    CubicSpline,
}

/// What a VRM file says that matters to flesh.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Vrm {
    /// 0 for `VRM`, 1 for `VRMC_vrm`.
    pub major_version: u8,
    /// Nodes that spring bones move, chain descendants included.
    pub spring_nodes: Vec<usize>,
}

impl Node {
    /// Transform of the rest pose: parent from node.
    #[must_use]
    pub fn parent_from_node(&self) -> DMat4 {
        DMat4::from_scale_rotation_translation(self.scale, self.rotation, self.translation)
    }
}

impl Model {
    /// Number of render vertices of all skinned primitives.
    #[must_use]
    pub fn vertex_count(&self) -> usize {
        self.primitives.iter().map(|p| p.positions.len()).sum()
    }

    /// Transforms of all nodes in the rest pose: model from node.
    ///
    /// A node whose ancestors form a cycle counts as a root (the importer refuses such files).
    #[must_use]
    pub fn rest_transforms(&self) -> Vec<DMat4> {
        let local: Vec<DMat4> = self.nodes.iter().map(Node::parent_from_node).collect();
        self.compose(&local)
    }

    /// Transforms of all nodes, model from node, from their local transforms.
    ///
    /// In time linear in the nodes, however they are ordered.
    ///
    /// # Panics
    ///
    /// If `local` is shorter than the list of nodes.
    #[must_use]
    pub fn compose(&self, local: &[DMat4]) -> Vec<DMat4> {
        let mut model_from_node: Vec<Option<DMat4>> = vec![None; self.nodes.len()];
        for start in 0..self.nodes.len() {
            let mut chain = vec![start];
            while let Some(parent) = self.nodes[*chain.last().unwrap_or(&start)].parent {
                // A chain longer than the list goes round in a circle.
                if model_from_node[parent].is_some() || chain.len() > self.nodes.len() {
                    break;
                }
                chain.push(parent);
            }
            for &node in chain.iter().rev() {
                let above = self.nodes[node].parent.and_then(|p| model_from_node[p]);
                model_from_node[node] = Some(above.unwrap_or(DMat4::IDENTITY) * local[node]);
            }
        }
        model_from_node.into_iter().map(|m| m.unwrap_or(DMat4::IDENTITY)).collect()
    }

    /// Blended matrices, model from bind, of all render vertices of a primitive in the rest pose.
    #[must_use]
    pub fn rest_blend(&self, primitive: &Primitive) -> Vec<DMat4> {
        let model_from_node = self.rest_transforms();
        let palette: Vec<DMat4> =
            self.joints.iter().map(|j| model_from_node[j.node] * j.joint_from_bind).collect();
        let rows = primitive.joints.chunks_exact(primitive.stride);
        rows.zip(primitive.weights.chunks_exact(primitive.stride))
            .map(|(joints, weights)| {
                let terms = joints.iter().zip(weights).filter(|(_, w)| **w > 0.0);
                terms.fold(DMat4::ZERO, |sum, (j, w)| sum + palette[usize::from(*j)] * f64::from(*w))
            })
            .collect()
    }

    /// Positions of all render vertices in the rest pose, model space, in the order of the primitives.
    #[must_use]
    pub fn rest_positions(&self) -> Vec<DVec3> {
        let mut out = Vec::with_capacity(self.vertex_count());
        for primitive in &self.primitives {
            let blend = self.rest_blend(primitive);
            let bind = primitive.positions.iter().map(|p| DVec3::from_array(p.map(f64::from)));
            out.extend(bind.zip(blend).map(|(p, m)| m.transform_point3(p)));
        }
        out
    }
}
