//! Symmetric characters get symmetric flesh: pairs of points at `x` and `−x` share one softness.

use super::surface::Surface;
use glam::DVec3;
use std::collections::BTreeMap;

/// Partners may be this far from the mirror image, body sizes.
const TOLERANCE: f64 = 0.002;

/// Mirror partner of each point, where at least nine tenths have one.
pub(super) fn partners(surface: &Surface) -> Option<Vec<Option<usize>>> {
    let width = TOLERANCE * surface.size;
    #[allow(clippy::cast_possible_truncation, reason = "saturating")]
    let cell = |p: DVec3| (p / width).round().to_array().map(|x| x as i64);
    let mut grid: BTreeMap<[i64; 3], Vec<usize>> = BTreeMap::new();
    for (i, p) in surface.points.iter().enumerate() {
        grid.entry(cell(*p)).or_default().push(i);
    }
    let nearest = |p: DVec3| {
        let [x, y, z] = cell(p);
        let around = (0..27).map(|k| [x + k % 3 - 1, y + k / 3 % 3 - 1, z + k / 9 - 1]);
        let found = around.filter_map(|c| grid.get(&c)).flatten().copied();
        let distance = |i: usize| (surface.points[i] - p).length();
        let best = found.min_by(|a, b| distance(*a).total_cmp(&distance(*b)));
        best.filter(|i| distance(*i) <= width)
    };
    let one_way: Vec<Option<usize>> =
        surface.points.iter().map(|p| nearest(DVec3::new(-p.x, p.y, p.z))).collect();
    let mutual = |(i, j): (usize, &Option<usize>)| j.filter(|j| one_way[*j] == Some(i));
    let pairs: Vec<Option<usize>> = one_way.iter().enumerate().map(mutual).collect();
    let matched = pairs.iter().flatten().count();
    (matched * 10 >= pairs.len() * 9).then_some(pairs)
}

/// Gives both partners the mean.
pub(super) fn average(softness: &mut [f64], partners: &[Option<usize>]) {
    for (i, partner) in partners.iter().enumerate() {
        if let Some(j) = partner.filter(|j| *j > i) {
            let mean = 0.5 * (softness[i] + softness[j]);
            (softness[i], softness[j]) = (mean, mean);
        }
    }
}
