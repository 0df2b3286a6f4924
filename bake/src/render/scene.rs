//! All surfaces of a picture in one list.

use super::color;
use super::{Paint, Surface};
use glam::Vec3;

/// Surfaces one after the other; triangles and vertices are numbered through.
#[derive(Debug)]
pub(super) struct Scene<'a> {
    surfaces: &'a [Surface<'a>],
    pub(super) positions: Vec<Vec3>,
    pub(super) normals: Vec<Vec3>,
    pub(super) triangles: Vec<[u32; 3]>,
    /// Surface of each triangle.
    owner: Vec<u16>,
    /// Number of the first vertex of each surface.
    first: Vec<u32>,
    /// 1, or -1 for surfaces whose triangles are wound clockwise (mirrored characters).
    winding: Vec<f32>,
}

impl<'a> Scene<'a> {
    /// Lists surfaces; triangles with vertices that do not exist or are not finite are left out.
    pub(super) fn new(surfaces: &'a [Surface<'a>]) -> Self {
        let mut scene = Self {
            surfaces,
            positions: Vec::new(),
            normals: Vec::new(),
            triangles: Vec::new(),
            owner: Vec::new(),
            first: Vec::new(),
            winding: Vec::new(),
        };
        for (number, surface) in (0..u16::MAX).zip(surfaces) {
            scene.add(number, surface);
        }
        scene
    }

    fn add(&mut self, number: u16, surface: &Surface<'_>) {
        let first = u32::try_from(self.positions.len()).unwrap_or(u32::MAX);
        self.first.push(first);
        let count = surface.positions.len();
        self.positions.extend(surface.positions.iter().map(|p| Vec3::from_array(*p)));
        self.normals
            .extend((0..count).map(|i| surface.normals.get(i).map_or(Vec3::Y, |n| Vec3::from_array(*n))));
        let start = self.triangles.len();
        let usable = |t: &&[u32; 3]| {
            t.iter()
                .all(|&i| surface.positions.get(i as usize).is_some_and(|p| p.iter().all(|x| x.is_finite())))
        };
        self.triangles.extend(surface.triangles.iter().filter(usable).map(|t| t.map(|i| i + first)));
        self.owner.resize(self.triangles.len(), number);
        let agree = |t: &[u32; 3]| {
            let [a, b, c] = t.map(|i| self.normals[i as usize]);
            self.face_normal(t).dot(a + b + c) >= 0.0
        };
        let agreed = self.triangles[start..].iter().filter(|t| agree(t)).count();
        self.winding.push(if 2 * agreed >= self.triangles.len() - start { 1.0 } else { -1.0 });
    }

    fn face_normal(&self, t: &[u32; 3]) -> Vec3 {
        let [a, b, c] = t.map(|i| self.positions[i as usize]);
        (b - a).cross(c - a)
    }

    /// Surface of a triangle.
    pub(super) fn surface(&self, triangle: usize) -> &'a Surface<'a> {
        &self.surfaces[usize::from(self.owner[triangle])]
    }

    /// Normal of a triangle, outwards, any length.
    pub(super) fn outward(&self, triangle: usize) -> Vec3 {
        self.face_normal(&self.triangles[triangle]) * self.winding[usize::from(self.owner[triangle])]
    }

    /// Texture coordinates of the corners of a triangle.
    pub(super) fn uvs(&self, triangle: usize) -> [[f32; 2]; 3] {
        let uvs = self.surface(triangle).uvs;
        self.local(triangle).map(|i| uvs.get(i).copied().unwrap_or_default())
    }

    /// Linear color of a point of a triangle; `texels_per_pixel` at level 0.
    pub(super) fn albedo(&self, triangle: usize, weights: [f32; 3], pixel_area: f32) -> [f32; 3] {
        match self.surface(triangle).paint {
            Paint::Flat(color) => color,
            Paint::Texture { texture, factor } => {
                let [a, b, c] = self.uvs(triangle);
                let uv = [0, 1].map(|k| a[k] * weights[0] + b[k] * weights[1] + c[k] * weights[2]);
                let area = ((b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1])).abs();
                let [width, height] = texture.size();
                #[allow(clippy::cast_precision_loss, reason = "at most 2^20 texels")]
                let texels = (area * (width * height) as f32 / pixel_area.max(1e-6)).max(0.0);
                let color = texture.sample(uv, texture.level(libm::sqrtf(texels)));
                core::array::from_fn(|i| color[i] * factor[i])
            }
            Paint::Colors(colors) => {
                let at = self.local(triangle).map(|i| colors.get(i).copied().unwrap_or([0.5; 3]));
                [0, 1, 2].map(|k| at[0][k] * weights[0] + at[1][k] * weights[1] + at[2][k] * weights[2])
            }
            Paint::Heat(heat) => {
                let at = self.local(triangle).map(|i| heat.get(i).copied().unwrap_or(0.0));
                let value = at[0] * weights[0] + at[1] * weights[1] + at[2] * weights[2];
                color::to_linear(color::heat(value))
            }
        }
    }

    /// Corners of a triangle, numbered within its surface.
    fn local(&self, triangle: usize) -> [usize; 3] {
        let first = self.first[usize::from(self.owner[triangle])];
        self.triangles[triangle].map(|i| (i - first) as usize)
    }
}
