//! Normals for meshes that bring none.

use glam::DVec3;

/// Smooth unit normals: the normals of the triangles around a position, weighted by area.
///
/// Vertices at the same position count as one, so that seams of texture coordinates do not show. A vertex without
/// any area around it gets +Y.
pub(super) fn smooth(positions: &[[f32; 3]], triangles: &[[u32; 3]]) -> Vec<[f32; 3]> {
    let welded = weld(positions);
    let mut sums = vec![DVec3::ZERO; positions.len()];
    for triangle in triangles {
        let corner = triangle.map(|v| DVec3::from_array(positions[v as usize].map(f64::from)));
        let normal = (corner[1] - corner[0]).cross(corner[2] - corner[0]);
        for v in triangle {
            sums[welded[*v as usize]] += normal;
        }
    }
    welded.iter().map(|w| to_unit(sums[*w]).unwrap_or([0.0, 1.0, 0.0])).collect()
}

/// The direction of a vector; `None` if it has none.
pub(super) fn to_unit(vector: DVec3) -> Option<[f32; 3]> {
    vector.try_normalize().map(|n| n.as_vec3().to_array())
}

/// For each vertex the first vertex at the same position.
fn weld(positions: &[[f32; 3]]) -> Vec<usize> {
    // `+ 0.0` makes -0 and 0 the same.
    let key = |v: usize| positions[v].map(|x| (x + 0.0).to_bits());
    let mut order: Vec<usize> = (0..positions.len()).collect();
    order.sort_by_key(|v| (key(*v), *v));
    let mut welded: Vec<usize> = (0..positions.len()).collect();
    for pair in order.windows(2) {
        if key(pair[0]) == key(pair[1]) {
            welded[pair[1]] = welded[pair[0]];
        }
    }
    welded
}

#[cfg(test)]
#[expect(clippy::float_cmp, reason = "the expected numbers are exact in f32")]
mod tests {
    use super::*;

    #[test]
    fn seam_vertices_share_a_normal_weighted_by_area() {
        // A large triangle facing +Z and a small one facing +X that share an edge by position, not by index.
        let positions = [
            [0.0, 0.0, 0.0],
            [0.0, 1.0, 0.0],
            [-2.0, 0.0, 0.0],
            [0.0, 0.0, -0.0],
            [0.0, 0.0, -1.0],
            [0.0, 1.0, 0.0],
        ];
        let normals = smooth(&positions, &[[0, 1, 2], [3, 4, 5]]);
        assert_eq!(normals[0], normals[3]);
        assert_eq!(normals[1], normals[5]);
        assert_eq!(normals[2], [0.0, 0.0, 1.0]);
        assert_eq!(normals[4], [1.0, 0.0, 0.0]);
        let expected = DVec3::new(1.0, 0.0, 2.0).normalize().as_vec3().to_array();
        assert_eq!(normals[0], expected);
    }

    #[test]
    fn vertices_without_area_get_up() {
        assert_eq!(smooth(&[[1.0; 3]; 3], &[[0, 1, 2]]), [[0.0, 1.0, 0.0]; 3]);
    }
}
