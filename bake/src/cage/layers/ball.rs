//! Inscribed balls: how thick the body is below each point of the skin.
//!
//! ```text
//! c = p − r n,   r ← |p − q|²/(2 n·(p − q))     q: the point of the skin nearest to c
//! ```
//!
//! The ball touches the skin at `p` and shrinks until no other point is inside it; its center is on the medial axis
//! (Ma, Bae, Choi 2012, "3D medial axis point approximation using nearest neighbors and the normal field").

use super::skin::Skin;
use glam::DVec3;
use rayon::prelude::*;
use rstar::RTree;
use rstar::primitives::GeomWithData;

/// Shrinking ends: more steps than ever seen.
const STEPS: usize = 40;
/// Balls that two points touch under less than this angle (cosine, seen from the center) are noise of the surface,
/// not the other side of the body.
const NOISE: f64 = 0.8;

/// Radii, m, of the balls below all points, whose unit normals are given.
pub(super) fn radii(skin: &Skin, normals: &[DVec3]) -> Vec<f64> {
    let entries = skin.points.iter().enumerate().map(|(i, p)| GeomWithData::new(p.to_array(), i)).collect();
    let tree = RTree::bulk_load(entries);
    skin.points.par_iter().zip(normals).map(|(p, n)| radius(skin, &tree, *p, *n)).collect()
}

fn radius(skin: &Skin, tree: &RTree<GeomWithData<[f64; 3], usize>>, p: DVec3, n: DVec3) -> f64 {
    let mut r = 0.5 * skin.size;
    for _ in 0..STEPS {
        let c = p - r * n;
        let Some(q) = tree.nearest_neighbor(&c.to_array()).map(|q| skin.points[q.data]) else { break };
        let way = p - q;
        let rise = n.dot(way);
        if q == p || rise <= 0.0 {
            break;
        }
        let shrunk = way.length_squared() / (2.0 * rise);
        let center = p - shrunk * n;
        let seen = n.dot((q - center).normalize_or_zero());
        if shrunk >= r * (1.0 - 1e-9) || seen > NOISE {
            break;
        }
        r = shrunk;
    }
    r
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cage::layers::skin::sphere;

    /// Every point of a sphere has the sphere as its ball.
    #[test]
    fn a_sphere_is_its_own_ball() {
        let skin = sphere(12);
        let radii = radii(&skin, &skin.points);
        assert!(radii.iter().all(|r| (r - 1.0).abs() < 1e-9), "{radii:?}");
    }

    /// A lens of half thickness 0.1: where it is thickest the ball has that radius, as the points there are close to
    /// the opposite of each other; at its edge it has the radius of curvature, 0.1².
    #[test]
    fn a_lens_is_as_thin_as_it_is() {
        let mut skin = sphere(40);
        skin.points.iter_mut().for_each(|p| p.z *= 0.1);
        let normal = |p: &DVec3| DVec3::new(p.x, p.y, p.z / 0.01).normalize();
        let normals: Vec<DVec3> = skin.points.iter().map(normal).collect();
        let radii = radii(&skin, &normals);
        let top = skin.points.iter().position(|p| p.z > 0.0999).expect("a pole");
        assert!((radii[top] - 0.1).abs() < 1e-9, "{}", radii[top]);
        // A quarter of the way out: z = 0.1 √(1 − ρ²), and its center on the plane of symmetry.
        let i = skin.points.iter().position(|p| p.z > 0.0 && p.y == 0.0 && (0.2..0.3).contains(&p.x));
        let i = i.expect("a point of the meridian");
        let want = skin.points[i].z / normals[i].z;
        assert!((radii[i] - want).abs() < 0.02 * want, "{} for {want}", radii[i]);
    }
}
