//! Few poses that cover many: farthest-point sampling.
//!
//! ```text
//! p₀ given,   pₖ = argmax over poses p of min over j < k of d(p, pⱼ),   d(p, q) = Σ over joints of the angle between
//! ```
//!
//! The greedy rule covers all poses within twice the smallest radius that is possible with as many (Gonzalez,
//! *Clustering to minimize the maximum intercluster distance*, Theoretical Computer Science 38, 1985, theorem 2.2).

use super::{Pose, angle_between};
use rayon::prelude::*;

/// Poses whose angles add up to less, rad, count as equal: what `f32` keys leave of equal ones.
const EQUAL: f64 = 1e-5;

/// The chosen poses.
#[derive(Clone, Debug, PartialEq)]
pub struct Selection {
    /// Numbers of the poses, in the order of choice: the first `k` are the choice of `k`.
    pub indices: Vec<usize>,
    /// Distance of each from those before it, rad, descending; infinite for the first. The last bounds how far any
    /// pose that was not taken is from one that was.
    pub distances: Vec<f64>,
}

/// Chooses `n` of `poses`, the first pose first; fewer where there are fewer that differ. `nodes` are those whose
/// angles count. In time `O(n·poses·nodes)`; the same for any number of threads.
///
/// ```
/// use sinew_bake::{builtin, pose::{Pose, farthest}};
/// let model = builtin::character();
/// let mut poses = vec![Pose::rest(&model); 4];
/// poses[2].rotations[3] *= glam::DQuat::from_rotation_x(0.3);
/// poses[3].rotations[3] *= glam::DQuat::from_rotation_x(0.5);
/// assert_eq!(farthest::select(&poses, &[3], 4).indices, [0, 3, 2]);
/// ```
///
/// # Panics
///
/// If a pose has fewer nodes than `nodes` name.
#[must_use]
pub fn select(poses: &[Pose], nodes: &[usize], n: usize) -> Selection {
    let mut selection = Selection { indices: Vec::new(), distances: Vec::new() };
    if poses.is_empty() || n == 0 {
        return selection;
    }
    let mut nearest = vec![f64::INFINITY; poses.len()];
    let mut next = (0, f64::INFINITY);
    while selection.indices.len() < n && next.1 > EQUAL {
        selection.indices.push(next.0);
        selection.distances.push(next.1);
        let taken = &poses[next.0];
        next = (poses.par_iter().zip(&mut nearest).enumerate())
            .map(|(i, (pose, nearest))| {
                *nearest = nearest.min(distance(pose, taken, nodes));
                (i, *nearest)
            })
            .reduce(|| (usize::MAX, -1.0), farther);
    }
    selection
}

/// The farther of two, of equally far ones the first: the same in whatever order pairs are compared.
fn farther(a: (usize, f64), b: (usize, f64)) -> (usize, f64) {
    let b_first = b.1 > a.1 || (b.1.total_cmp(&a.1).is_eq() && b.0 < a.0);
    if b_first { b } else { a }
}

fn distance(a: &Pose, b: &Pose, nodes: &[usize]) -> f64 {
    nodes.iter().map(|n| angle_between(a.rotations[*n], b.rotations[*n])).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DQuat;

    /// Poses of three nodes with angles that look random; every third is there twice, once with its signs turned.
    fn poses(count: u32) -> Vec<Pose> {
        let one = |i: u32| {
            let (i, sign) = if i % 3 == 2 { (i - 1, -1.0) } else { (i, 1.0) };
            let part = |k: u32| f64::from(sinew::math::noise::lattice(i, k));
            let turn =
                |k| DQuat::from_scaled_axis(glam::DVec3::new(part(k), part(k + 1), part(k + 2))) * sign;
            Pose { rotations: vec![turn(0), turn(3), turn(6)], translations: vec![glam::DVec3::ZERO; 3] }
        };
        (0..count).map(one).collect()
    }

    /// Straight from the definition.
    fn oracle(poses: &[Pose], n: usize) -> Vec<usize> {
        let mut taken = vec![0];
        while taken.len() < n {
            let far = |p: &Pose| taken.iter().map(|t| p.distance(&poses[*t])).fold(f64::MAX, f64::min);
            let best = poses.iter().map(far).fold(0.0, f64::max);
            taken.push(poses.iter().position(|p| far(p) >= best).unwrap());
        }
        taken
    }

    #[test]
    fn the_choice_is_that_of_the_definition() {
        let poses = poses(150);
        let selection = select(&poses, &[0, 1, 2], 40);
        assert_eq!(selection.indices, oracle(&poses, 40));
        assert!(selection.distances.is_sorted_by(|a, b| a >= b), "{:?}", selection.distances);
        let covered =
            |p: &Pose| selection.indices.iter().any(|t| p.distance(&poses[*t]) <= selection.distances[39]);
        assert!(poses.iter().all(covered));
    }

    #[test]
    fn equal_poses_are_never_both_taken() {
        // Of 150 poses 50 are there twice.
        assert_eq!(select(&poses(150), &[0, 1, 2], 1000).indices.len(), 100);
        assert!(select(&[], &[0], 3).indices.is_empty());
        assert!(select(&poses(9), &[0], 0).indices.is_empty());
        assert_eq!(select(&poses(9), &[], 3).indices, [0], "without joints all poses are equal");
    }

    #[test]
    fn the_number_of_threads_does_not_matter() {
        let poses = poses(900);
        let with = |threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| select(&poses, &[0, 1, 2], 60))
        };
        let one = with(1);
        assert!([2, 3, 7].iter().all(|n| with(*n) == one));
    }

    /// Goal: a thousand of ten thousand poses while one gets a coffee.
    #[test]
    #[ignore = "a measurement: run it alone, with --release --nocapture"]
    fn speed() {
        let mut poses = poses(10_000);
        poses.iter_mut().for_each(|p| p.rotations = p.rotations.repeat(10));
        let nodes: Vec<usize> = (0..30).collect();
        let start = std::time::Instant::now();
        let selection = select(&poses, &nodes, 1000);
        println!("{} poses in {:.2} s", selection.indices.len(), start.elapsed().as_secs_f64());
    }
}
