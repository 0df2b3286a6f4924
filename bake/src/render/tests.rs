//! Pictures of simple things and of a real character.

use super::*;
use crate::import::import;
use image::RgbImage;
use rayon::prelude::*;
use std::path::Path;

/// A ball of radius 1 around the origin with its normals, in 16 × 24 faces.
struct Ball {
    points: Vec<[f32; 3]>,
    triangles: Vec<[u32; 3]>,
}

impl Ball {
    fn new() -> Self {
        let (mut points, mut triangles) = (Vec::new(), Vec::new());
        for j in 0..=16_u16 {
            for i in 0..24_u16 {
                let (s, c) = libm::sincos(f64::from(i) / 24.0 * core::f64::consts::TAU);
                let (r, y) = libm::sincos(f64::from(j) / 16.0 * core::f64::consts::PI);
                #[allow(clippy::cast_possible_truncation, reason = "single precision is meant")]
                points.push([r * s, y, r * c].map(|v| v as f32));
                let [a, b] = [u32::from(j) * 24 + u32::from(i), u32::from(j) * 24 + (u32::from(i) + 1) % 24];
                if j < 16 {
                    triangles.extend([[a, a + 24, b], [b, a + 24, b + 24]]);
                }
            }
        }
        Self { points, triangles }
    }

    fn surface<'a>(&'a self, paint: Paint<'a>) -> Surface<'a> {
        Surface {
            positions: &self.points,
            normals: &self.points,
            uvs: &[],
            triangles: &self.triangles,
            paint,
            double_sided: false,
        }
    }

    fn camera(&self) -> Camera {
        Camera::framing(self.points.iter().copied(), 1.0, 0.4, 0.25)
    }
}

const RED: Paint<'_> = Paint::Flat([0.6, 0.05, 0.05]);

fn sum(image: &RgbImage, [x, y]: [u32; 2]) -> u32 {
    image.get_pixel(x, y).0.map(u32::from).iter().sum()
}

#[test]
fn a_ball_is_lit_from_above_and_throws_a_shadow() {
    let ball = Ball::new();
    let camera = ball.camera();
    let (empty, image) = (render(&[], &camera, 120, 120), render(&[ball.surface(RED)], &camera, 120, 120));
    let [r, g, _] = image.get_pixel(60, 60).0;
    assert!(r > 90 && u32::from(r) > 2 * u32::from(g), "red in the middle, {r} {g}");
    assert!(sum(&image, [45, 35]) > sum(&image, [75, 100]) + 60, "brighter above left than below right");
    assert_eq!(image.get_pixel(2, 2), empty.get_pixel(2, 2), "the wall is as it was");
    let darkest = (0..120).map(|x| sum(&empty, [x, 112]).saturating_sub(sum(&image, [x, 112]))).max();
    assert!(darkest > Some(60), "shadow under the ball, {darkest:?}");
}

#[test]
fn the_silhouette_is_where_projection_says() {
    let ball = Ball::new();
    let camera = ball.camera();
    let size = 200_u16;
    let image = render(&[ball.surface(RED)], &camera, size.into(), size.into());
    let (mut inside, mut near) = (0, 0);
    for y in 0..size {
        for x in 0..size {
            let [u, v] = [x, y].map(|k| (f32::from(k) + 0.5) / f32::from(size));
            // Distance from the middle of the ball to the line of sight.
            let miss = camera.eye.cross(camera.ray(u, v).normalize()).length();
            let [r, g, _] = image.get_pixel(x.into(), y.into()).0;
            let red = u32::from(r) > 2 * u32::from(g);
            // The ball has corners: a little within its radius its faces may or may not cover a pixel.
            match miss {
                m if m < 0.97 => assert!(red, "a hole at {x}, {y}"),
                m if m > 1.02 => assert!(!red, "too large at {x}, {y}"),
                _ => near += 1,
            }
            inside += u32::from(red);
        }
    }
    assert!(inside > 15_000 && near < 2_500, "{inside} pixels of the ball, {near} undecided");
}

#[test]
fn the_shadow_lies_away_from_the_lamp_and_under_the_ball() {
    let ball = Ball::new();
    let camera = ball.camera();
    let (empty, image) = (render(&[], &camera, 160, 160), render(&[ball.surface(RED)], &camera, 160, 160));
    let dark = |x: u32, y: u32| f64::from(sum(&empty, [x, y])) - f64::from(sum(&image, [x, y]));
    // Along the ground in front of the ball: the lamp stands at the left.
    let (mut left, mut right) = (0.0, 0.0);
    for y in 128..160 {
        (0..80).for_each(|x| left += dark(x, y));
        (80..160).for_each(|x| right += dark(x, y));
    }
    assert!(right > 1.1 * left && left > 0.0, "left {left}, right {right}");
}

#[test]
fn the_same_picture_is_the_same_bytes() {
    let ball = Ball::new();
    let draw = || {
        let mut png = Vec::new();
        let image = render(&[ball.surface(RED)], &ball.camera(), 97, 61);
        encode_png(&image, &mut png).expect("memory");
        png
    };
    let (first, second) = (draw(), draw());
    assert_eq!(first, second);
    let digest = sinew::math::digest::of_bytes(&first);
    assert!(image::load_from_memory(&first).is_ok(), "{digest:016x}");
}

#[test]
fn the_inner_side_is_drawn_only_where_it_should() {
    let mut ball = Ball::new();
    ball.triangles.retain(|t| t.iter().all(|&i| ball.points[i as usize][2] < 0.2));
    let camera = Camera::framing(ball.points.iter().copied(), 1.0, 0.0, 0.0);
    let mut surface = ball.surface(RED);
    let one = render(&[surface], &camera, 60, 60);
    surface.double_sided = true;
    let both = render(&[surface], &camera, 60, 60);
    let is_red = |image: &RgbImage| {
        let [r, g, _] = image.get_pixel(30, 30).0;
        u32::from(r) > 2 * u32::from(g)
    };
    assert_eq!((is_red(&one), is_red(&both)), (false, true));
}

#[test]
fn a_mirrored_surface_shows_its_outer_side() {
    let mut ball = Ball::new();
    for p in &mut ball.points {
        p[0] = -p[0];
    }
    let image = render(&[ball.surface(RED)], &ball.camera(), 60, 60);
    let [r, g, _] = image.get_pixel(30, 30).0;
    assert!(u32::from(r) > 2 * u32::from(g) && r > 90, "lit and not culled: {r} {g}");
}

#[test]
fn heat_is_painted_between_cold_and_hot() {
    let ball = Ball::new();
    let heat: Vec<f32> = ball.points.iter().map(|p| if p[1] > 0.3 { 1.0 } else { 0.0 }).collect();
    let image = render(&[ball.surface(Paint::Heat(&heat))], &ball.camera(), 120, 120);
    assert!(sum(&image, [60, 80]) > sum(&image, [60, 25]) + 150, "cold is pale, hot is dark");
    let monotone = (0..=50_u8).map(|i| heat_color(f32::from(i) / 50.0).map(u32::from).iter().sum::<u32>());
    let steps: Vec<u32> = monotone.collect();
    assert!(steps.windows(2).skip(6).all(|w| w[1] <= w[0] + 2), "darker and darker: {steps:?}");
    assert_eq!(heat_color(f32::NAN), heat_color(0.0));
}

#[test]
fn hostile_surfaces_are_drawn_without_what_is_broken() {
    let ball = Ball::new();
    let mut broken = Ball::new();
    broken.points[7] = [f32::NAN, f32::INFINITY, 0.0];
    broken.points[50] = [1e30, 0.0, -1e30];
    broken.triangles.push([0, 1, 1_000_000]);
    let mut surface = broken.surface(Paint::Heat(&[f32::NAN]));
    surface.normals = &surface.normals[..3];
    let image = render(&[surface, ball.surface(RED)], &ball.camera(), 40, 40);
    assert_eq!((image.width(), image.height()), (40, 40));
    let _ = render(&[surface], &Camera::framing([], 1.0, 0.0, 0.0), 0, 5);
}

#[test]
fn a_real_character_is_drawn_alike_on_any_number_of_threads() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../shared/data/khronos/Fox.glb");
    if !path.exists() {
        assert!(std::env::var("CI").as_deref() != Ok("true"), "{} is missing", path.display());
        println!("skipped: {} is missing", path.display());
        return;
    }
    let model = import(&path).expect("a character");
    let figure = Figure::new(&model);
    #[allow(clippy::cast_possible_truncation, reason = "single precision is meant")]
    let positions: Vec<[f32; 3]> =
        model.rest_positions().iter().map(|p| p.to_array().map(|v| v as f32)).collect();
    let normals: Vec<[f32; 3]> = model.primitives.iter().flat_map(|p| p.normals.clone()).collect();
    let heat: Vec<f32> = positions.iter().map(|p| p[1] / 80.0).collect();
    let pose = |show| Pose { positions: &positions, normals: &normals, rigid: &[], show };
    let poses = [Show::Materials, Show::Heat(&heat), Show::Materials].map(pose);
    let camera = Camera::framing(positions.iter().copied(), 1.5, 0.7, 0.2);
    let draw = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        pool.install(|| {
            poses.par_iter().map(|pose| figure.draw(pose, &camera, 150, 100)).collect::<Vec<RgbImage>>()
        })
    };
    let pictures = draw(1);
    assert_eq!(pictures, draw(3));
    let orange = pictures[0].pixels().filter(|p| p.0[0] > 180 && p.0[2] < 120).count();
    assert!(orange > 500, "the fox is orange: {orange} pixels");
    assert_eq!((pictures[0] == pictures[2], pictures[0] == pictures[1]), (true, false));
}
