//! Skin: triangles whose points are nodes, or are moved by a few of them.
//!
//! ```text
//! pᵢ = Σⱼ wᵢⱼ xⱼ
//! ```

use super::assembly::Assembly;
use super::blocks::Blocks;
use glam::DVec3;

/// Triangles over points that nodes move.
///
/// ```
/// use glam::DVec3;
/// use sinew_bake::fem::surface::Surface;
/// let nodes = [DVec3::ZERO, DVec3::X, DVec3::Y];
/// let skin = Surface::of_nodes(&nodes, vec![[0, 1, 2]])?;
/// assert_eq!(skin.edges, [[0, 1], [0, 2], [1, 2]]);
/// let middle = Surface::new(&nodes, &[[(0, 0.5), (1, 0.5), (0, 0.0), (0, 0.0)]; 3], vec![[0, 1, 2]])?;
/// assert_eq!(middle.points(&nodes)[0], DVec3::new(0.5, 0.0, 0.0));
/// # Ok::<(), sinew_bake::fem::surface::SurfaceError>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Surface {
    /// Corners of each triangle.
    pub triangles: Vec<[u32; 3]>,
    /// Ends of each edge, the smaller first, in order.
    pub edges: Vec<[u32; 2]>,
    /// Points that are corners, in order: no others collide.
    pub corners: Vec<u32>,
    /// Points at rest, m.
    pub rest: Vec<DVec3>,
    /// A third of the area of the triangles around each point, m².
    pub areas: Vec<f64>,
    /// A third of the area of the triangles at each edge, m².
    pub edge_areas: Vec<f64>,
    /// Begin of each point's weights, and the end of the last's.
    starts: Vec<usize>,
    /// Nodes and weights.
    weights: Vec<(u32, f64)>,
}

/// A surface that cannot be.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum SurfaceError {
    /// A triangle has a corner that there is not, or one twice.
    #[error(
        "triangle {triangle} has the corners {corners:?}; there are {points} points, and corners must differ"
    )]
    Triangle {
        /// Its index.
        triangle: usize,
        /// Its corners.
        corners: [u32; 3],
        /// How many points there are.
        points: usize,
    },
    /// A point is moved by a node that there is not, or is no number at rest.
    #[error("point {point} is not a finite sum of the {nodes} nodes")]
    Point {
        /// Its index.
        point: usize,
        /// How many nodes there are.
        nodes: usize,
    },
}

impl Surface {
    /// Points as sums of at most four nodes each, with weights; those of weight 0 do not count.
    ///
    /// Points in the same place are different points: where triangles share a corner, so should their indices, or they
    /// collide with each other.
    ///
    /// # Errors
    ///
    /// [`SurfaceError`] at the first triangle or point that cannot be.
    pub fn new(
        nodes: &[DVec3],
        points: &[[(u32, f64); 4]],
        triangles: Vec<[u32; 3]>,
    ) -> Result<Self, SurfaceError> {
        Self::build(nodes, points.iter().map(|p| p.as_slice()), triangles)
    }

    /// Points that are the nodes.
    ///
    /// # Errors
    ///
    /// As [`new`](Self::new).
    pub fn of_nodes(nodes: &[DVec3], triangles: Vec<[u32; 3]>) -> Result<Self, SurfaceError> {
        let points: Vec<(u32, f64)> = (0..).take(nodes.len()).map(|i| (i, 1.0)).collect();
        Self::build(nodes, points.chunks(1), triangles)
    }

    fn build<'a>(
        nodes: &[DVec3],
        points: impl Iterator<Item = &'a [(u32, f64)]>,
        triangles: Vec<[u32; 3]>,
    ) -> Result<Self, SurfaceError> {
        let mut out = Self { starts: vec![0], ..Self::default() };
        for (point, of) in points.enumerate() {
            for (node, w) in of.iter().filter(|(_, w)| *w != 0.0) {
                let met = out.weights[out.starts[point]..].iter_mut().find(|(i, _)| i == node);
                match met {
                    Some((_, sum)) => *sum += w,
                    None => out.weights.push((*node, *w)),
                }
            }
            let known = |(i, w): &(u32, f64)| (*i as usize) < nodes.len() && w.is_finite();
            if !out.weights[out.starts[point]..].iter().all(known) {
                return Err(SurfaceError::Point { point, nodes: nodes.len() });
            }
            out.starts.push(out.weights.len());
        }
        out.rest = out.points(nodes);
        if let Some(point) = out.rest.iter().position(|p| !p.is_finite()) {
            return Err(SurfaceError::Point { point, nodes: nodes.len() });
        }
        let points = out.rest.len();
        let sound = |t: &[u32; 3]| {
            t.iter().all(|i| (*i as usize) < points) && t[0] != t[1] && t[1] != t[2] && t[2] != t[0]
        };
        if let Some(triangle) = triangles.iter().position(|t| !sound(t)) {
            return Err(SurfaceError::Triangle { triangle, corners: triangles[triangle], points });
        }
        out.triangles = triangles;
        out.measure();
        Ok(out)
    }

    /// Finds edges, corners and areas.
    fn measure(&mut self) {
        let mut edges: Vec<([u32; 2], f64)> = Vec::new();
        self.areas = vec![0.0; self.rest.len()];
        for t in &self.triangles {
            let [a, b, c] = t.map(|i| self.rest[i as usize]);
            let third = (b - a).cross(c - a).length() / 6.0;
            for k in 0..3 {
                let (i, j) = (t[k], t[(k + 1) % 3]);
                self.areas[i as usize] += third;
                edges.push(([i.min(j), i.max(j)], third));
            }
        }
        edges.sort_by_key(|(edge, _)| *edge);
        edges.dedup_by(|next, kept| {
            let same = next.0 == kept.0;
            if same {
                kept.1 += next.1;
            }
            same
        });
        (self.edges, self.edge_areas) = edges.into_iter().unzip();
        self.corners = self.triangles.iter().flatten().copied().collect();
        self.corners.sort_unstable();
        self.corners.dedup();
    }

    /// Nodes that move point `i`, and their weights.
    #[must_use]
    pub fn weights(&self, i: u32) -> &[(u32, f64)] {
        &self.weights[self.starts[i as usize]..self.starts[i as usize + 1]]
    }

    /// All points where the nodes are at `x`; or what they move by where the nodes move by `x`.
    ///
    /// # Panics
    ///
    /// If `x` are fewer than the nodes.
    #[must_use]
    pub fn points(&self, x: &[DVec3]) -> Vec<DVec3> {
        let sum = |of: &[(u32, f64)]| of.iter().fold(DVec3::ZERO, |p, (i, w)| p + *w * x[*i as usize]);
        self.starts.windows(2).map(|range| sum(&self.weights[range[0]..range[1]])).collect()
    }

    /// Adds forces against a few points to those against the nodes that move them.
    pub(super) fn spread(&self, points: &[u32], forces: &[DVec3], out: &mut [DVec3]) {
        for (i, force) in points.iter().zip(forces) {
            for (node, w) in self.weights(*i) {
                out[*node as usize] += *w * *force;
            }
        }
    }

    /// Adds the Hessian by a few points as one by the nodes that move them.
    pub(super) fn assemble<const N: usize>(&self, points: &[u32; N], h: &Blocks<N>, out: &mut Assembly<'_>) {
        for (i, row) in h.iter().enumerate() {
            for (j, block) in row[..=i].iter().enumerate() {
                let (of_i, of_j) = (self.weights(points[i]), self.weights(points[j]));
                for (k, (a, v)) in of_i.iter().enumerate() {
                    // Within a point each pair of nodes is met twice.
                    let of_j = if i == j { &of_j[..=k] } else { of_j };
                    for (b, w) in of_j {
                        let block = *block * (v * w);
                        let both = i != j && a == b;
                        out.add(*a, *b, if both { block + block.transpose() } else { block });
                    }
                }
            }
        }
    }

    /// Calls `visit` with the nodes that move a few points.
    pub(super) fn stencil(&self, points: &[u32], nodes: &mut Vec<u32>, visit: &mut dyn FnMut(&[u32])) {
        nodes.clear();
        nodes.extend(points.iter().flat_map(|i| self.weights(*i)).map(|(node, _)| *node));
        visit(nodes);
    }
}
