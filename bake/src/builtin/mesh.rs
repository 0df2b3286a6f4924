//! The mesh of the implicit surface: surface nets, drawn onto the surface, evened out, mirrored exactly.

use super::shape::{distance, gradient};
use fast_surface_nets::ndshape::{RuntimeShape, Shape};
use fast_surface_nets::{SurfaceNetsBuffer, surface_nets};
use glam::DVec3;
use std::collections::BTreeMap;

/// Width of a cell.
const CELL: f64 = 0.0285;
/// Corner of the grid; in x it is symmetric.
const LOW: DVec3 = DVec3::new(-26.0 * CELL, -3.0 * CELL, -34.0 * CELL);
/// Samples each way.
const COUNT: [u32; 3] = [53, 74, 54];

/// Points and triangles, counter-clockwise seen from outside.
pub(super) fn surface() -> (Vec<DVec3>, Vec<[u32; 3]>) {
    let shape = RuntimeShape::<u32, 3>::new(COUNT);
    let sample = |i: u32| {
        let at = shape.delinearize(i);
        let p = LOW + CELL * DVec3::from_array(at.map(f64::from));
        crate::pack::narrow(distance(p) / CELL)
    };
    let samples: Vec<f32> = (0..shape.size()).map(sample).collect();
    let mut net = SurfaceNetsBuffer::default();
    surface_nets(&samples, &shape, [0; 3], COUNT.map(|n| n - 1), &mut net);
    let place = |p: &[f32; 3]| LOW + CELL * DVec3::from_array(p.map(f64::from));
    let mut points: Vec<DVec3> = net.positions.iter().map(place).collect();
    let triangles: Vec<[u32; 3]> = net.indices.as_chunks().0.to_vec();
    let mut partner = partners(&points);
    for _ in 0..6 {
        relax(&mut points, &triangles);
        mirror(&mut points, &mut partner);
    }
    (points, triangles)
}

/// Moves each point towards the middle of its neighbours along the surface, then onto it.
fn relax(points: &mut [DVec3], triangles: &[[u32; 3]]) {
    let mut sums = vec![(DVec3::ZERO, 0.0); points.len()];
    for t in triangles {
        for k in 0..3 {
            let (sum, n) = &mut sums[t[k] as usize];
            *sum += points[t[(k + 1) % 3] as usize];
            *n += 1.0;
        }
    }
    for (p, (sum, n)) in points.iter_mut().zip(sums) {
        let normal = gradient(*p).normalize();
        let pull = sum / n - *p;
        *p += 0.5 * (pull - normal * pull.dot(normal));
        for _ in 0..2 {
            let slope = gradient(*p);
            *p -= slope * (distance(*p) / slope.length_squared());
        }
    }
}

/// Mirror partner of each point, itself on the middle plane: the nearest to its image.
fn partners(points: &[DVec3]) -> Vec<usize> {
    #[allow(clippy::cast_possible_truncation, reason = "a small grid")]
    let key = |p: DVec3| (p / CELL).round().to_array().map(|x| x as i64);
    let mut known: BTreeMap<[i64; 3], Vec<usize>> = BTreeMap::new();
    for (i, p) in points.iter().enumerate() {
        known.entry(key(*p)).or_default().push(i);
    }
    let find = |(i, p): (usize, &DVec3)| {
        let image = DVec3::new(-p.x, p.y, p.z);
        let [x, y, z] = key(image);
        let around = (0..27).map(|k| [x + k % 3 - 1, y + k / 3 % 3 - 1, z + k / 9 - 1]);
        let distance = |j: &usize| (points[*j] - image).length();
        let near = around.filter_map(|c| known.get(&c)).flatten().copied();
        near.min_by(|a, b| distance(a).total_cmp(&distance(b))).unwrap_or(i)
    };
    points.iter().enumerate().map(find).collect()
}

/// Gives partners mirrored coordinates, bit for bit.
fn mirror(points: &mut [DVec3], partner: &mut [usize]) {
    for i in 0..points.len() {
        let j = partner[i];
        if j == i {
            points[i].x = 0.0;
        } else if j > i {
            let (a, b) = (points[i], points[j]);
            let mean = 0.5 * DVec3::new(a.x - b.x, a.y + b.y, a.z + b.z);
            points[i] = mean;
            points[j] = DVec3::new(-mean.x, mean.y, mean.z);
        }
    }
}
