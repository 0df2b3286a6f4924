//! A tree of boxes over triangles: the closest point of a surface, and moments for the winding number.
//!
//! One tree serves both, which is why the closest point is not taken from a crate.

use glam::DVec3;

/// Triangles of a leaf.
const LEAF: usize = 8;

/// A box of triangles. The left child follows its parent.
#[derive(Clone, Copy, Debug)]
pub(super) struct Node {
    low: DVec3,
    high: DVec3,
    /// Range in [`Tree::order`].
    pub(super) start: u32,
    pub(super) end: u32,
    /// The right child; 0 for a leaf.
    pub(super) right: u32,
    /// Sum of the area vectors.
    pub(super) vector: DVec3,
    /// Middle, by area.
    pub(super) center: DVec3,
    /// Distance of the farthest corner from it.
    pub(super) radius: f64,
    /// `Σ a cᵀ`: area vectors times places of triangles from the middle, by columns.
    pub(super) slope: glam::DMat3,
}

/// Boxes over triangles; the first is the root.
#[derive(Clone, Debug)]
pub(super) struct Tree {
    pub(super) nodes: Vec<Node>,
    /// Triangles in the order of the leaves.
    pub(super) order: Vec<u32>,
}

/// A point of a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Nearest {
    /// Its triangle.
    pub triangle: u32,
    /// Its barycentric coordinates there, not negative, sum 1.
    pub at: [f64; 3],
    /// Itself, m.
    pub point: DVec3,
    /// How far it is, m.
    pub distance: f64,
}

impl Tree {
    pub(super) fn new(points: &[DVec3], triangles: &[[u32; 3]]) -> Self {
        let mut tree = Self { nodes: Vec::new(), order: (0..).take(triangles.len()).collect() };
        let middles: Vec<DVec3> =
            triangles.iter().map(|t| t.iter().map(|i| points[*i as usize]).sum::<DVec3>() / 3.0).collect();
        if !triangles.is_empty() {
            tree.split(points, triangles, &middles, 0, triangles.len());
        }
        tree
    }

    fn split(
        &mut self,
        points: &[DVec3],
        triangles: &[[u32; 3]],
        middles: &[DVec3],
        start: usize,
        end: usize,
    ) {
        let number = self.nodes.len();
        let range = &self.order[start..end];
        self.nodes.push(node(points, triangles, middles, range, start));
        if range.len() <= LEAF {
            return;
        }
        let nothing = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        let (low, high) =
            range.iter().map(|t| middles[*t as usize]).fold(nothing, |(l, h), p| (l.min(p), h.max(p)));
        let axis = (high - low).max_position();
        let half = range.len() / 2;
        self.order[start..end].select_nth_unstable_by(half, |a, b| {
            middles[*a as usize][axis].total_cmp(&middles[*b as usize][axis]).then(a.cmp(b))
        });
        self.split(points, triangles, middles, start, start + half);
        self.nodes[number].right = u32::try_from(self.nodes.len()).unwrap_or(0);
        self.split(points, triangles, middles, start + half, end);
    }

    /// The point of the surface that is closest to `p`; of equals the one of the first triangle.
    pub(super) fn nearest(&self, points: &[DVec3], triangles: &[[u32; 3]], p: DVec3) -> Nearest {
        let mut best = Nearest { triangle: 0, at: [0.0; 3], point: p, distance: f64::INFINITY };
        let mut stack = vec![0_usize];
        while let Some(at) = stack.pop() {
            let node = &self.nodes[at];
            // Equals are looked at too, so that the first triangle is found.
            if node.distance_squared(p) > best.distance * (1.0 + 1e-12) {
                continue;
            }
            if node.right > 0 {
                let (left, right) = (at + 1, node.right as usize);
                let left_first =
                    self.nodes[left].distance_squared(p) <= self.nodes[right].distance_squared(p);
                stack.extend(if left_first { [right, left] } else { [left, right] });
                continue;
            }
            for &t in &self.order[node.start as usize..node.end as usize] {
                let corners = triangles[t as usize].map(|i| points[i as usize]);
                let at = closest(p, corners);
                let point = corners[0] * at[0] + corners[1] * at[1] + corners[2] * at[2];
                let distance = point.distance_squared(p);
                #[expect(clippy::float_cmp, reason = "a tie is a tie")]
                if distance < best.distance || (distance == best.distance && t < best.triangle) {
                    best = Nearest { triangle: t, at, point, distance };
                }
            }
        }
        Nearest { distance: libm::sqrt(best.distance), ..best }
    }
}

impl Node {
    fn distance_squared(&self, p: DVec3) -> f64 {
        p.clamp(self.low, self.high).distance_squared(p)
    }
}

fn node(points: &[DVec3], triangles: &[[u32; 3]], middles: &[DVec3], range: &[u32], start: usize) -> Node {
    let corners = || range.iter().flat_map(|t| triangles[*t as usize]).map(|i| points[i as usize]);
    let nothing = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    let (low, high) = corners().fold(nothing, |(l, h), p| (l.min(p), h.max(p)));
    let vector = |t: u32| {
        let [a, b, c] = triangles[t as usize].map(|i| points[i as usize]);
        0.5 * (b - a).cross(c - a)
    };
    let (mut sum, mut area, mut middle) = (DVec3::ZERO, 0.0, DVec3::ZERO);
    for &t in range {
        let a = vector(t);
        sum += a;
        area += a.length();
        middle += middles[t as usize] * a.length();
    }
    let center = if area > 0.0 { middle / area } else { 0.5 * (low + high) };
    let radius = corners().map(|p| p.distance(center)).fold(0.0, f64::max);
    let slope = range.iter().fold(glam::DMat3::ZERO, |sum, t| {
        let (a, c) = (vector(*t), middles[*t as usize] - center);
        sum + glam::DMat3::from_cols(a * c.x, a * c.y, a * c.z)
    });
    let [start, end] = [start, start + range.len()].map(|n| u32::try_from(n).unwrap_or(u32::MAX));
    Node { low, high, start, end, right: 0, vector: sum, center, radius, slope }
}

/// Barycentric coordinates of the point of a triangle that is closest to `p` (Ericson, Real-Time Collision Detection,
/// 2005, 5.1.5).
fn closest(p: DVec3, [a, b, c]: [DVec3; 3]) -> [f64; 3] {
    let (ab, ac, ap, bp, cp) = (b - a, c - a, p - a, p - b, p - c);
    let (d1, d2) = (ab.dot(ap), ac.dot(ap));
    if d1 <= 0.0 && d2 <= 0.0 {
        return [1.0, 0.0, 0.0];
    }
    let (d3, d4) = (ab.dot(bp), ac.dot(bp));
    if d3 >= 0.0 && d4 <= d3 {
        return [0.0, 1.0, 0.0];
    }
    let vc = d1 * d4 - d3 * d2;
    if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        let v = d1 / (d1 - d3);
        return [1.0 - v, v, 0.0];
    }
    let (d5, d6) = (ab.dot(cp), ac.dot(cp));
    if d6 >= 0.0 && d5 <= d6 {
        return [0.0, 0.0, 1.0];
    }
    let vb = d5 * d2 - d1 * d6;
    if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        let w = d2 / (d2 - d6);
        return [1.0 - w, 0.0, w];
    }
    let va = d3 * d6 - d5 * d4;
    if va <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0 {
        let w = (d4 - d3) / ((d4 - d3) + (d5 - d6));
        return [0.0, 1.0 - w, w];
    }
    let sum = va + vb + vc;
    let (v, w) = (vb / sum, vc / sum);
    [(1.0 - v - w).max(0.0), v, w]
}
