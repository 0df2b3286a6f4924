//! Cuts through the layers, to be looked at.

use super::Layers;
use glam::DVec3;

impl Layers {
    /// Where the plane through `point` with the given normal cuts bone wrap, muscle wrap and skin: straight pieces,
    /// in the order of the triangles. The skin is on the left of a piece, seen along the normal.
    #[must_use]
    pub fn section(&self, point: DVec3, normal: DVec3) -> [Vec<[DVec3; 2]>; 3] {
        let (n, triangles) = (self.columns(), self.triangles());
        [0, 1, 2].map(|layer| {
            let places = &self.rest[layer * n..(layer + 1) * n];
            triangles.iter().filter_map(|t| cut(t.map(|i| places[i as usize]), point, normal)).collect()
        })
    }
}

/// The piece of a triangle on a plane; corners on the plane count as above it.
fn cut(t: [DVec3; 3], point: DVec3, normal: DVec3) -> Option<[DVec3; 2]> {
    let height = t.map(|p| (p - point).dot(normal));
    let (mut down, mut up) = (None, None);
    for (i, j) in [(0, 1), (1, 2), (2, 0)] {
        let place = || t[i] + height[i] / (height[i] - height[j]) * (t[j] - t[i]);
        match (height[i] < 0.0, height[j] < 0.0) {
            (false, true) => down = Some(place()),
            (true, false) => up = Some(place()),
            _ => {}
        }
    }
    Some([down?, up?])
}
