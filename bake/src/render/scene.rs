//! A character in light.

use super::camera::Camera;
use super::raster::{Canvas, Corner, SAMPLES, decode};
use crate::model::{Material, Model};
use glam::{DMat4, DVec3, Vec3};

/// Background, linear.
const BACKGROUND: [f32; 3] = [0.80, 0.82, 0.85];
/// Direction to the key light, and its colour.
const KEY: (Vec3, Vec3) = (Vec3::new(0.45, 0.75, 0.55), Vec3::new(1.0, 0.95, 0.87));
/// Direction to the fill light, and its colour.
const FILL: (Vec3, Vec3) = (Vec3::new(-0.7, 0.25, 0.45), Vec3::new(0.16, 0.20, 0.28));
/// Light from above and from below.
const SKY: Vec3 = Vec3::new(0.34, 0.37, 0.42);
const GROUND: Vec3 = Vec3::new(0.20, 0.17, 0.15);

/// How surfaces are coloured.
#[derive(Clone, Copy, Debug)]
pub enum Look<'a> {
    /// By their materials.
    Materials,
    /// By a value a render vertex, `0..=1`, as heat; rigid parts are grey.
    Heat(&'a [f32]),
}

/// A decoded texture, linear.
struct Texture {
    width: usize,
    height: usize,
    pixels: Vec<Vec3>,
}

/// A model with its textures decoded.
pub struct Scene<'a> {
    model: &'a Model,
    textures: Vec<Option<Texture>>,
    /// Height of the ground.
    pub ground: f64,
}

impl core::fmt::Debug for Scene<'_> {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.debug_struct("Scene").field("model", &self.model.name).finish_non_exhaustive()
    }
}

/// A frame to draw: positions and normals of all render vertices, and the rigid meshes' transforms.
#[derive(Clone, Copy, Debug)]
pub struct Drawn<'a> {
    /// Positions, model space.
    pub positions: &'a [[f32; 3]],
    /// Normals.
    pub normals: &'a [[f32; 3]],
    /// One transform a rigid mesh.
    pub rigid: &'a [DMat4],
}

impl<'a> Scene<'a> {
    /// Decodes the textures; one that cannot be decoded leaves its material's colour.
    #[must_use]
    pub fn new(model: &'a Model, ground: f64) -> Self {
        let texture = |m: &Material| {
            let image = image::load_from_memory(m.texture.as_deref()?).ok()?.thumbnail(1024, 1024).to_rgb8();
            let (width, height) = (image.width() as usize, image.height() as usize);
            let pixels = image.pixels().map(|p| Vec3::from_array(p.0.map(decode))).collect();
            Some(Texture { width, height, pixels })
        };
        Self { model, textures: model.materials.iter().map(texture).collect(), ground }
    }

    /// An empty picture with the background of scenes.
    #[must_use]
    pub fn canvas(width: usize, height: usize) -> Canvas {
        Canvas::new(width, height, BACKGROUND)
    }

    /// Draws a frame.
    pub fn draw(&self, canvas: &mut Canvas, camera: &Camera, drawn: Drawn<'_>, look: Look<'_>) {
        self.draw_shadow(canvas, camera, drawn.positions);
        let mut first = 0;
        for p in &self.model.primitives {
            let range = first..first + p.positions.len();
            first = range.end;
            let heat = match look {
                Look::Materials => None,
                Look::Heat(values) => Some(&values[range.clone()]),
            };
            let mesh = Mesh {
                positions: &drawn.positions[range.clone()],
                normals: &drawn.normals[range],
                uvs: &p.uvs,
                triangles: &p.indices,
                material: p.material,
                heat,
            };
            self.draw_mesh(canvas, camera, &mesh, matches!(look, Look::Heat(_)));
        }
        for (r, m) in self.model.rigid.iter().zip(drawn.rigid) {
            let point = |p: &[f32; 3]| m.transform_point3(wide(*p)).to_array().map(crate::pack::narrow);
            let turn = |n: &[f32; 3]| m.transform_vector3(wide(*n)).to_array().map(crate::pack::narrow);
            let (positions, normals): (Vec<_>, Vec<_>) =
                (r.positions.iter().map(point).collect(), r.normals.iter().map(turn).collect());
            let mesh = Mesh {
                positions: &positions,
                normals: &normals,
                uvs: &r.uvs,
                triangles: &r.indices,
                material: r.material,
                heat: None,
            };
            self.draw_mesh(canvas, camera, &mesh, matches!(look, Look::Heat(_)));
        }
    }

    fn draw_mesh(&self, canvas: &mut Canvas, camera: &Camera, mesh: &Mesh<'_>, grey: bool) {
        let height = real(canvas.rows());
        let material = mesh.material.and_then(|m| self.model.materials.get(m));
        let texture = mesh.material.and_then(|m| self.textures.get(m)?.as_ref());
        let [r, g, b, _] = material.map_or([0.72, 0.70, 0.68, 1.0], |m| m.base_color);
        let base = if grey { Vec3::splat(0.5) } else { Vec3::new(r, g, b) };
        for triangle in mesh.triangles {
            let corner = |v: u32| {
                let v = v as usize;
                Some(Corner {
                    at: camera.project(wide(mesh.positions[v]), height)?,
                    normal: Vec3::from_array(mesh.normals[v]),
                    uv: mesh.uvs.get(v).copied().unwrap_or_default(),
                    value: mesh.heat.map_or(0.0, |h| h[v]),
                })
            };
            let [Some(a), Some(b), Some(c)] = triangle.map(corner) else { continue };
            let at = |v: u32| wide(mesh.positions[v as usize]);
            let view = camera.eye - at(triangle[0]);
            let facing =
                (at(triangle[1]) - at(triangle[0])).cross(at(triangle[2]) - at(triangle[0])).dot(view);
            let flip = if facing < 0.0 { -1.0 } else { 1.0 };
            let eye = view.normalize_or_zero().as_vec3();
            canvas.triangle([a, b, c], |normal, uv, value| {
                let albedo = match (mesh.heat, texture) {
                    (Some(_), _) => heat_color(value),
                    (None, Some(t)) if !grey => base * t.sample(uv),
                    _ => base,
                };
                // A normal that points away from a face that points here belongs to the back of a sheet.
                let n = normal.normalize_or_zero();
                let n = if n.dot(eye) * 1.0 < -0.35 || (flip < 0.0 && n.dot(eye) < 0.0) { -n } else { n };
                lit(albedo, n, eye)
            });
        }
    }

    /// The shadow on the ground: the triangles along the key light, blurred.
    fn draw_shadow(&self, canvas: &mut Canvas, camera: &Camera, positions: &[[f32; 3]]) {
        let height = real(canvas.rows());
        let light = KEY.0.as_dvec3();
        let mut mask = vec![0.0; canvas.width * canvas.height * SAMPLES * SAMPLES];
        let mut first = 0;
        for p in &self.model.primitives {
            for triangle in &p.indices {
                let corner = |v: u32| {
                    let q = wide(positions[first + v as usize]);
                    let along = (q.y - self.ground).max(0.0) / light.y;
                    let at = camera.project(
                        DVec3::new(q.x, self.ground, q.z) - DVec3::new(light.x, 0.0, light.z) * along,
                        height,
                    )?;
                    Some(Corner { at, normal: Vec3::ZERO, uv: [0.0; 2], value: 0.0 })
                };
                if let [Some(a), Some(b), Some(c)] = triangle.map(corner) {
                    canvas.mark([a, b, c], &mut mask);
                }
            }
            first += p.positions.len();
        }
        let radius = canvas.rows() / 90;
        canvas.shadow(&mask, 0.38, radius);
    }
}

/// A mesh in place.
struct Mesh<'a> {
    positions: &'a [[f32; 3]],
    normals: &'a [[f32; 3]],
    uvs: &'a [[f32; 2]],
    triangles: &'a [[u32; 3]],
    material: Option<usize>,
    heat: Option<&'a [f32]>,
}

impl Texture {
    /// Bilinear, repeating.
    fn sample(&self, [u, v]: [f32; 2]) -> Vec3 {
        #[allow(clippy::cast_precision_loss, reason = "at most 1024")]
        let (x, y) = (
            (u - libm::floorf(u)) * self.width as f32 - 0.5,
            (v - libm::floorf(v)) * self.height as f32 - 0.5,
        );
        let (fx, fy) = (x - libm::floorf(x), y - libm::floorf(y));
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "wrapped to the image")]
        let at = |dx: f32, dy: f32| {
            let x = (libm::floorf(x) + dx) as i64;
            let y = (libm::floorf(y) + dy) as i64;
            let wrap = |i: i64, n: usize| i.rem_euclid(i64::try_from(n).unwrap_or(1)) as usize;
            self.pixels[wrap(y, self.height) * self.width + wrap(x, self.width)]
        };
        let top = at(0.0, 0.0).lerp(at(1.0, 0.0), fx);
        top.lerp(at(0.0, 1.0).lerp(at(1.0, 1.0), fx), fy)
    }
}

/// Key with a soft terminator, fill, sky and ground, and a rim.
fn lit(albedo: Vec3, n: Vec3, eye: Vec3) -> Vec3 {
    let wrap = |light: Vec3| ((n.dot(light.normalize()) + 0.25) / 1.25).max(0.0);
    let hemisphere = GROUND.lerp(SKY, 0.5 + 0.5 * n.y);
    let diffuse = KEY.1 * wrap(KEY.0) * 0.95 + FILL.1 * wrap(FILL.0) + hemisphere;
    let half = (KEY.0.normalize() + eye).normalize_or_zero();
    let gloss = n.dot(half).max(0.0);
    let g4 = gloss * gloss * gloss * gloss;
    let edge = 1.0 - n.dot(eye).max(0.0);
    let rim = edge * edge * edge * edge * 0.18;
    albedo * diffuse * 0.86 + Vec3::splat(g4 * g4 * g4 * 0.10) + Vec3::splat(rim * (0.5 + 0.5 * n.y))
}

/// Heat, 0 to 1, linear.
fn heat_color(value: f32) -> Vec3 {
    let c = colorous::TURBO.eval_continuous(f64::from(value.clamp(0.0, 1.0)) * 0.92 + 0.06);
    Vec3::new(decode(c.r), decode(c.g), decode(c.b))
}

fn wide(p: [f32; 3]) -> DVec3 {
    DVec3::from_array(p.map(f64::from))
}

#[allow(clippy::cast_precision_loss, reason = "pixels")]
fn real(n: usize) -> f64 {
    n as f64
}
