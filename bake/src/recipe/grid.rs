//! Points in cubes: neighbors within a radius, always in the same order.

use std::collections::BTreeMap;

use glam::DVec3;

/// Cubes farther from the origin than this are one: strays of no interest.
const FAR: f64 = 1e15;

/// Points sorted into cubes of a given edge.
#[derive(Debug)]
pub(crate) struct Grid {
    edge: f64,
    cubes: BTreeMap<[i64; 3], Vec<usize>>,
}

impl Grid {
    /// Sorts `points` into cubes; `edge` is the largest radius that will be asked for.
    pub(crate) fn new(points: &[DVec3], edge: f64) -> Self {
        let mut grid = Self { edge, cubes: BTreeMap::new() };
        for (i, p) in points.iter().enumerate() {
            let cube = grid.cube(*p);
            grid.cubes.entry(cube).or_default().push(i);
        }
        grid
    }

    /// Indices of the points in the 27 cubes around `p`: all those within `edge`, and some beyond.
    pub(crate) fn around(&self, p: DVec3) -> impl Iterator<Item = usize> + '_ {
        let [x, y, z] = self.cube(p);
        let columns = (-1..=1).flat_map(move |dx| (-1..=1).map(move |dy| [x + dx, y + dy]));
        columns.flat_map(move |[x, y]| {
            self.cubes.range([x, y, z - 1]..=[x, y, z + 1]).flat_map(|(_, cube)| cube.iter().copied())
        })
    }

    #[expect(clippy::cast_possible_truncation, reason = "clamped")]
    fn cube(&self, p: DVec3) -> [i64; 3] {
        (p / self.edge).floor().to_array().map(|c| c.clamp(-FAR, FAR) as i64)
    }
}
