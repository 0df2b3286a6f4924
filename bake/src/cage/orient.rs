//! A triangle soup put in order: no slivers, no duplicates, every part right side out.

use glam::DVec3;

/// A triangle with less area than this share of the body size squared is none.
const SLIVER: f64 = 1e-14;
/// An open patch is inside out where the volume that it bends around is below minus this share of `area^1.5`; a sphere
/// has 0.094. Flatter ones are left as they are.
const BENT: f64 = 0.01;

/// What was found and done.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Repairs {
    /// Triangles without area that were left out.
    pub(super) slivers: usize,
    /// Triangles with the corners of one before that were left out.
    pub(super) duplicates: usize,
    /// Edges of one triangle.
    pub(super) open: usize,
    /// Edges of three or more triangles.
    pub(super) crowded: usize,
    /// Triangles that were turned to agree with their neighbors.
    pub(super) turned: usize,
    /// Patches that were inside out.
    pub(super) inverted: usize,
}

/// An edge of a triangle: its points in ascending order, and the triangle.
type Side = ([u32; 2], u32);

/// Leaves out what is no triangle, then turns patches (triangles joined by edges of two) right side out.
pub(super) fn orient(points: &[DVec3], size: f64, triangles: &mut Vec<[u32; 3]>) -> Repairs {
    let mut repairs = Repairs::default();
    let all = triangles.len();
    triangles.retain(|t| area(points, t).length() > SLIVER * size * size);
    repairs.slivers = all - triangles.len();
    let kept = first_of_each(triangles);
    repairs.duplicates = triangles.len() - kept.len();
    *triangles = kept;
    let sides = sides(triangles);
    let mut neighbors = vec![Vec::new(); triangles.len()];
    let mut closed = vec![true; triangles.len()];
    for edge in sides.chunk_by(|a, b| a.0 == b.0) {
        match edge {
            [(_, a), (_, b)] => {
                neighbors[*a as usize].push(*b);
                neighbors[*b as usize].push(*a);
            }
            _ => edge.iter().for_each(|(_, t)| closed[*t as usize] = false),
        }
        repairs.open += usize::from(edge.len() == 1);
        repairs.crowded += usize::from(edge.len() > 2);
    }
    let mut seen = vec![false; triangles.len()];
    for start in 0..triangles.len() {
        if !seen[start] {
            let (patch, turned) = spread(start, triangles, &neighbors, &mut seen);
            let shut = patch.iter().all(|t| closed[*t as usize]);
            settle(points, triangles, &patch, turned, shut, &mut repairs);
        }
    }
    repairs
}

/// Area vector of a triangle, twice.
fn area(points: &[DVec3], t: &[u32; 3]) -> DVec3 {
    let [a, b, c] = t.map(|i| points[i as usize]);
    (b - a).cross(c - a)
}

/// Triangles without those that have the corners of an earlier one, in whatever order.
fn first_of_each(triangles: &[[u32; 3]]) -> Vec<[u32; 3]> {
    let key = |t: &[u32; 3]| {
        let mut key = *t;
        key.sort_unstable();
        key
    };
    let mut order: Vec<usize> = (0..triangles.len()).collect();
    order.sort_unstable_by_key(|i| (key(&triangles[*i]), *i));
    let mut first: Vec<usize> =
        order.chunk_by(|a, b| key(&triangles[*a]) == key(&triangles[*b])).map(|same| same[0]).collect();
    first.sort_unstable();
    first.into_iter().map(|i| triangles[i]).collect()
}

fn sides(triangles: &[[u32; 3]]) -> Vec<Side> {
    let mut sides: Vec<Side> = Vec::with_capacity(3 * triangles.len());
    for (number, [a, b, c]) in (0..).zip(triangles) {
        sides.extend([(a, b), (b, c), (c, a)].map(|(a, b)| ([*a.min(b), *a.max(b)], number)));
    }
    sides.sort_unstable();
    sides
}

/// Turns the triangles of the patch of `start` to agree with it; returns the patch, and which of it were turned.
fn spread(
    start: usize,
    triangles: &mut [[u32; 3]],
    neighbors: &[Vec<u32>],
    seen: &mut [bool],
) -> (Vec<u32>, Vec<bool>) {
    let mut patch = vec![u32::try_from(start).unwrap_or(u32::MAX)];
    let mut turned = vec![false];
    seen[start] = true;
    let mut next = 0;
    while let Some(t) = patch.get(next).copied() {
        next += 1;
        for &other in neighbors[t as usize].iter().filter(|o| **o != t) {
            if seen[other as usize] {
                continue;
            }
            seen[other as usize] = true;
            let turn = agrees(&triangles[t as usize], &triangles[other as usize]);
            if turn {
                triangles[other as usize].swap(1, 2);
            }
            patch.push(other);
            turned.push(turn);
        }
    }
    (patch, turned)
}

/// Whether two triangles run along an edge of both in the same direction: one of them must be turned.
fn agrees(a: &[u32; 3], b: &[u32; 3]) -> bool {
    let runs = |t: &[u32; 3]| [(t[0], t[1]), (t[1], t[2]), (t[2], t[0])];
    runs(a).iter().any(|edge| runs(b).contains(edge))
}

/// Turns a whole patch that is inside out; a patch that bends around nothing keeps the side of most of its triangles.
fn settle(
    points: &[DVec3],
    triangles: &mut [[u32; 3]],
    patch: &[u32],
    turned: Vec<bool>,
    shut: bool,
    repairs: &mut Repairs,
) {
    let changed = turned.iter().filter(|t| **t).count();
    let mostly = 2 * changed > patch.len();
    let (volume, total) = volume(points, triangles, patch);
    // As the file meant it.
    let volume = if mostly { -volume } else { volume };
    let inverted = if shut { volume < 0.0 } else { volume < -BENT * total * libm::sqrt(total) };
    repairs.turned += if mostly { patch.len() - changed } else { changed };
    repairs.inverted += usize::from(inverted);
    if mostly != inverted {
        patch.iter().for_each(|t| triangles[*t as usize].swap(1, 2));
    }
}

/// Volume between a patch and its middle, and its area.
fn volume(points: &[DVec3], triangles: &[[u32; 3]], patch: &[u32]) -> (f64, f64) {
    let middle = |t: &[u32; 3]| t.iter().map(|i| points[*i as usize]).sum::<DVec3>() / 3.0;
    let of = || patch.iter().map(|t| &triangles[*t as usize]);
    let sum = of().fold((DVec3::ZERO, 0.0), |(m, s), t| {
        let half = 0.5 * area(points, t).length();
        (m + middle(t) * half, s + half)
    });
    let center = sum.0 / sum.1.max(f64::MIN_POSITIVE);
    (of().map(|t| (middle(t) - center).dot(area(points, t)) / 6.0).sum(), sum.1)
}
