//! Folds of the skin that no column can leave: smoothed until one can.
//!
//! At the tips of toes and fingers a few triangles may turn away from all others around a point: then no direction
//! is inside of all of them, and no prism with a volume stands there. Such points move to the mean of their
//! neighbors, and once more with the ring around them, until the narrowest cone of [`most_normal`] is open.

use super::normal::most_normal;
use super::shrink::mean;
use super::skin::Skin;
use glam::DVec3;
use rayon::prelude::*;

/// Least cosine of a column with the triangles around it.
const OPEN: f64 = 0.1;
/// Rounds.
const ROUNDS: usize = 60;
/// Share of the way to the mean in a round.
const STEP: f64 = 0.5;

/// Most normal normals and their smallest cosines; moves the points that need it.
pub(super) fn unfold(skin: &mut Skin) -> (Vec<DVec3>, Vec<f64>) {
    let n = skin.points.len();
    let mut open: Vec<(DVec3, f64)> = (0..n).into_par_iter().map(|i| most_normal(skin, i)).collect();
    for round in 0..ROUNDS {
        let mut moving: Vec<usize> = (0..n).filter(|i| open[*i].1 < OPEN).collect();
        if moving.is_empty() {
            break;
        }
        // A fold that stays is wider than its point.
        for _ in 0..round / 10 {
            moving = with_ring(skin, &moving);
        }
        let step = |i: &usize| {
            let p = skin.points[*i];
            p + STEP * (mean(skin, *i, |j| skin.points[j]) - p)
        };
        let places: Vec<DVec3> = moving.iter().map(step).collect();
        for (i, place) in moving.iter().zip(places) {
            skin.points[*i] = place;
        }
        for i in with_ring(skin, &moving) {
            open[i] = most_normal(skin, i);
        }
    }
    open.into_iter().unzip()
}

/// Some points and their neighbors, ascending.
fn with_ring(skin: &Skin, points: &[usize]) -> Vec<usize> {
    let neighbors = points.iter().flat_map(|i| skin.edges[*i].iter().map(|(j, _)| *j));
    let mut out: Vec<usize> = neighbors.chain(points.iter().copied()).collect();
    out.sort_unstable();
    out.dedup();
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cage::layers::skin::sphere;

    #[test]
    fn a_fold_is_opened_and_the_rest_stays() {
        let mut skin = sphere(12);
        let (i, j) = (100, skin.edges[100][0].0);
        // Past a neighbor, so that triangles behind it turn over.
        skin.points[i] = 0.98 * skin.points[i].lerp(skin.points[j], 2.5).normalize();
        let folded = skin.points.clone();
        assert!((0..folded.len()).any(|k| most_normal(&skin, k).1 < OPEN), "not folded");
        let (_, cosines) = unfold(&mut skin);
        assert!(cosines.iter().all(|c| *c >= OPEN), "still folded");
        let moved: Vec<usize> = (0..folded.len()).filter(|k| folded[*k] != skin.points[*k]).collect();
        let near = with_ring(&skin, &with_ring(&skin, &[i]));
        assert!(!moved.is_empty() && moved.iter().all(|k| near.contains(k)), "{moved:?}");
    }

    #[test]
    fn a_smooth_surface_is_left_alone() {
        let mut skin = sphere(12);
        let before = skin.points.clone();
        let (normals, cosines) = unfold(&mut skin);
        assert_eq!(skin.points, before);
        assert!(cosines.iter().all(|c| *c > 0.9), "{cosines:?}");
        assert!(normals.iter().zip(&before).all(|(n, p)| n.dot(*p) > 0.99), "outwards");
    }
}
