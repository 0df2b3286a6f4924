//! Surfaces made by code.

use glam::DVec3;
use std::collections::BTreeMap;

/// Points and triangles.
pub(crate) type Mesh = (Vec<DVec3>, Vec<[u32; 3]>);

/// The sphere of radius 1: an octahedron with its triangles split in four, `times` times.
pub(crate) fn sphere(times: usize) -> Mesh {
    let mut points = vec![DVec3::X, DVec3::Y, DVec3::Z, -DVec3::X, -DVec3::Y, -DVec3::Z];
    let mut triangles =
        vec![[0, 1, 2], [1, 3, 2], [3, 4, 2], [4, 0, 2], [1, 0, 5], [3, 1, 5], [4, 3, 5], [0, 4, 5]];
    for _ in 0..times {
        let mut middles = BTreeMap::new();
        let mut next = Vec::new();
        for [a, b, c] in triangles {
            let mut middle = |i: u32, j: u32| {
                *middles.entry((i.min(j), i.max(j))).or_insert_with(|| {
                    points.push((points[i as usize] + points[j as usize]).normalize());
                    u32::try_from(points.len() - 1).unwrap()
                })
            };
            let (ab, bc, ca) = (middle(a, b), middle(b, c), middle(c, a));
            next.extend([[a, ab, ca], [b, bc, ab], [c, ca, bc], [ab, bc, ca]]);
        }
        triangles = next;
    }
    (points, triangles)
}

/// The box between two corners.
pub(crate) fn cuboid(low: DVec3, high: DVec3) -> Mesh {
    let corner = |i: u8| DVec3::select(glam::BVec3::new(i & 1 > 0, i & 2 > 0, i & 4 > 0), high, low);
    let sides = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
    (
        (0..8).map(corner).collect(),
        sides.into_iter().flat_map(|[a, b, c, d]| [[a, b, c], [a, c, d]]).collect(),
    )
}

/// Several meshes as one.
pub(crate) fn union(parts: impl IntoIterator<Item = Mesh>) -> Mesh {
    let mut out: Mesh = Default::default();
    for (points, triangles) in parts {
        let start = u32::try_from(out.0.len()).unwrap();
        out.0.extend(points);
        out.1.extend(triangles.into_iter().map(|t| t.map(|i| i + start)));
    }
    out
}

/// A mesh, moved.
pub(crate) fn moved((points, triangles): Mesh, by: DVec3) -> Mesh {
    (points.into_iter().map(|p| p + by).collect(), triangles)
}

/// A Wavefront file: points and triangles, larger faces as fans.
pub(crate) fn obj(text: &str) -> Mesh {
    let mut out: Mesh = Default::default();
    for line in text.lines() {
        let mut words = line.split_whitespace();
        match words.next() {
            Some("v") => {
                let x: Vec<f64> = words.map(|w| w.parse().unwrap()).collect();
                out.0.push(DVec3::new(x[0], x[1], x[2]));
            }
            Some("f") => {
                let first = |w: &str| w.split('/').next().unwrap().parse::<u32>().unwrap() - 1;
                let corners: Vec<u32> = words.map(first).collect();
                out.1.extend((2..corners.len()).map(|i| [corners[0], corners[i - 1], corners[i]]));
            }
            _ => {}
        }
    }
    out
}
