//! The direction into the body that all triangles around a point see from inside.
//!
//! ```text
//! max over |n| = 1 of  min over triangles t around the point of  n·nₜ
//! ```
//!
//! The "most normal" normal (Aubry, Löhner 2008): the axis of the narrowest cone around the triangles' normals. A
//! column along it has a positive volume on every triangle if any column has.

use super::skin::Skin;
use glam::DVec3;

/// Steps of the ascent; its error falls as their inverse.
const STEPS: u32 = 200;
/// Cosines that differ by less are equal.
const TIE: f64 = 1e-9;

/// Unit normal of a point, outwards, and its smallest cosine with the triangles around.
pub(super) fn most_normal(skin: &Skin, point: usize) -> (DVec3, f64) {
    let mut start = DVec3::ZERO;
    let mut normals = Vec::with_capacity(8);
    for t in &skin.around[point] {
        let [a, b, c] = skin.triangles[*t as usize].map(|i| skin.points[i as usize]);
        let vector = (b - a).cross(c - a);
        start += vector;
        normals.extend(vector.try_normalize());
    }
    narrowest(&normals, start.normalize_or_zero())
}

/// Axis of the narrowest cone: steps towards the worst normals, ever shorter (Bădoiu, Clarkson 2003), from the mean.
fn narrowest(normals: &[DVec3], start: DVec3) -> (DVec3, f64) {
    let least = |n: DVec3| normals.iter().map(|t| n.dot(*t)).fold(1.0, f64::min);
    let mut best = (start, least(start));
    let mut n = start;
    let mut cosine = best.1;
    for step in 0..STEPS {
        // All of the worst: on a plane of symmetry they come in pairs, and none is before the other.
        let worst: DVec3 = normals.iter().filter(|t| n.dot(**t) <= cosine + TIE).sum();
        n = (n + worst.normalize_or_zero() / f64::from(step + 2)).normalize_or_zero();
        cosine = least(n);
        if cosine > best.1 {
            best = (n, cosine);
        }
    }
    best
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_axis_is_in_the_middle_of_the_cone_whatever_the_number_of_normals() {
        let normals = [DVec3::X, DVec3::Y, DVec3::Z, DVec3::Z, DVec3::Z];
        let (axis, cosine) = narrowest(&normals, normals.iter().sum::<DVec3>().normalize());
        // cos = 1/√3 in the middle; the steps come within their last length of it.
        assert!((cosine - libm::sqrt(1.0 / 3.0)).abs() < 1.0 / f64::from(STEPS), "{axis} {cosine}");
    }

    #[test]
    fn normals_that_oppose_each_other_have_no_axis() {
        let normals = [DVec3::X, -DVec3::X, DVec3::Y];
        assert!(narrowest(&normals, DVec3::Y).1 <= 0.0);
    }
}
