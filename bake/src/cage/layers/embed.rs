//! Points in prisms: the inverse of `x(l, s)`, by the roots of a cubic.
//!
//! ```text
//! tᵢ(s) = aᵢ + s (bᵢ − aᵢ)                          the triangle at s moves from the inner one to the outer
//! (p − t₀)·[(t₁ − t₀)×(t₂ − t₀)] = 0                p is in its plane: a cubic in s
//! l₁ = (p − t₀)×(t₂ − t₀)·A/A²,  l₂ = (t₁ − t₀)×(p − t₀)·A/A²,  A = (t₁ − t₀)×(t₂ − t₀)
//! ```
//!
//! The cubic of parallel triangles is linear, so no formula that divides by its first coefficient will do: the roots
//! of its derivative cut the range into monotonic pieces, and each piece with a change of sign has one root (Yuksel
//! 2022, "High-performance polynomial root finding for graphics"). In a sound prism there is one in all.

use super::Layers;
use glam::DVec3;
use rayon::prelude::*;
use rstar::primitives::{GeomWithData, Rectangle};
use rstar::{AABB, RTree};

/// Roots are sought so far beyond 0 and 1.
const BEYOND: f64 = 0.25;
/// Coordinates may be negative by this much for a point to count as inside.
const INSIDE: f64 = 1e-9;
/// Prisms that are tried for a point outside all of them.
const NEAREST: usize = 24;
/// What a coordinate of 1 is in a packed point.
const UNIT: f64 = 65_535.0;

/// Where a point is in a prism.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Place {
    /// Barycentric coordinates of the second and the third corner; the first has the rest.
    pub corners: [f64; 2],
    /// 0 on the inner triangle, 1 on the outer.
    pub height: f64,
}

/// A point that moves with a prism.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Embedded {
    /// Index into [`Layers::prisms`].
    pub prism: u32,
    /// Where it is, every coordinate within 0 to 1.
    pub place: Place,
    /// What is left to the point in the rest pose, m; 0 inside the cage. Turns with the prism.
    pub residual: DVec3,
}

impl Place {
    /// Shape functions of the six nodes.
    #[must_use]
    pub fn shape(&self) -> [f64; 6] {
        let [l1, l2] = self.corners;
        let l = [1.0 - l1 - l2, l1, l2];
        let s = self.height;
        core::array::from_fn(|i| if i < 3 { (1.0 - s) * l[i] } else { s * l[i - 3] })
    }

    /// The point of a prism at this place.
    #[must_use]
    pub fn point(&self, nodes: &[DVec3; 6]) -> DVec3 {
        self.shape().iter().zip(nodes).map(|(n, x)| *n * *x).sum()
    }

    /// How far the place is outside: 0, or the most that a coordinate is past its bounds.
    fn outside(&self) -> f64 {
        let [l1, l2] = self.corners;
        let s = self.height;
        [-l1, -l2, l1 + l2 - 1.0, -s, s - 1.0].into_iter().fold(0.0, f64::max)
    }

    /// The same with every coordinate within its bounds.
    fn clamped(&self) -> Self {
        let [l1, l2] = self.corners.map(|l| l.max(0.0));
        let sum = (l1 + l2).max(1.0);
        Self { corners: [l1 / sum, l2 / sum], height: self.height.clamp(0.0, 1.0) }
    }
}

/// Where `p` is in a prism: the place with the least extrapolation; `None` if it is in no plane of the prism's.
#[must_use]
pub fn locate(nodes: &[DVec3; 6], p: DVec3) -> Option<Place> {
    let [a0, a1, a2, b0, b1, b2] = *nodes;
    let (e1, e2, g1, g2) = (a1 - a0, a2 - a0, b1 - b0 - (a1 - a0), b2 - b0 - (a2 - a0));
    let area = [e1.cross(e2), e1.cross(g2) + g1.cross(e2), g1.cross(g2)];
    let (u, v) = (p - a0, a0 - b0);
    let cubic =
        [u.dot(area[0]), u.dot(area[1]) + v.dot(area[0]), u.dot(area[2]) + v.dot(area[1]), v.dot(area[2])];
    let places = roots(cubic).into_iter().flatten().filter_map(|s| at_height(nodes, p, s));
    places.min_by(|a, b| a.outside().total_cmp(&b.outside()))
}

/// Where the foot of `p` is on the triangle at a height; `None` if that has no area.
fn at_height(nodes: &[DVec3; 6], p: DVec3, s: f64) -> Option<Place> {
    let t = |i: usize| (1.0 - s) * nodes[i] + s * nodes[i + 3];
    let (t1, t2, to_p) = (t(1) - t(0), t(2) - t(0), p - t(0));
    let normal = t1.cross(t2);
    let square = normal.length_squared();
    let corners = [to_p.cross(t2).dot(normal) / square, t1.cross(to_p).dot(normal) / square];
    corners.iter().all(|l| l.is_finite()).then_some(Place { corners, height: s })
}

/// Roots of `Σ cₖ sᵏ` within the range, ascending.
fn roots(c: [f64; 4]) -> [Option<f64>; 3] {
    let value = |s: f64| ((c[3] * s + c[2]) * s + c[1]) * s + c[0];
    let (low, high) = (-BEYOND, 1.0 + BEYOND);
    let mut cuts = [low, high, high, high];
    let turns = turning_points(c).into_iter().flatten().filter(|s| (low..high).contains(s));
    for (cut, turn) in cuts[1..].iter_mut().zip(turns) {
        *cut = turn;
    }
    core::array::from_fn(|i| {
        let (from, to) = (cuts[i], cuts[i + 1]);
        let (first, last) = (value(from), value(to));
        let change = first < 0.0 && last > 0.0 || first > 0.0 && last < 0.0 || last == 0.0 && to > from;
        change.then(|| root_between(c, from, to))
    })
}

/// Roots of the derivative `c₁ + 2 c₂ s + 3 c₃ s²`, ascending, without cancellation.
fn turning_points([_, c1, c2, c3]: [f64; 4]) -> [Option<f64>; 2] {
    let square = c2 * c2 - 3.0 * c3 * c1;
    if square.is_nan() || square < 0.0 {
        return [None, None];
    }
    let q = -(c2 + libm::copysign(libm::sqrt(square), c2));
    let (x, y) = (q / (3.0 * c3), c1 / q);
    let kept = |s: f64| s.is_finite().then_some(s);
    [kept(x.min(y)), kept(x.max(y))]
}

/// The root in a monotonic piece: Newton's steps, halving where they leave it.
fn root_between(c: [f64; 4], mut from: f64, mut to: f64) -> f64 {
    let value = |s: f64| ((c[3] * s + c[2]) * s + c[1]) * s + c[0];
    let slope = |s: f64| (3.0 * c[3] * s + 2.0 * c[2]) * s + c[1];
    let rising = value(to) > value(from);
    let mut s = 0.5 * (from + to);
    for _ in 0..80 {
        let v = value(s);
        if (v > 0.0) == rising {
            to = s;
        } else {
            from = s;
        }
        let step = s - v / slope(s);
        let next = if step > from && step < to { step } else { 0.5 * (from + to) };
        if (next - s).abs() <= f64::EPSILON || v == 0.0 {
            return if v == 0.0 { s } else { next };
        }
        s = next;
    }
    s
}

impl Embedded {
    /// Ten bytes: the prism, then the two corners and the height as shares of 65,535; little-endian. The residual is
    /// left out.
    #[must_use]
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped")]
    pub fn packed(&self) -> [u8; 10] {
        let [l1, l2] = self.place.corners;
        let unit = |x: f64| (libm::round(x.clamp(0.0, 1.0) * UNIT) as u16).to_le_bytes();
        let [p, c1, c2, s] = [&self.prism.to_le_bytes()[..], &unit(l1), &unit(l2), &unit(self.place.height)];
        let mut out = [0; 10];
        for (byte, from) in out.iter_mut().zip([p, c1, c2, s].concat()) {
            *byte = from;
        }
        out
    }

    /// What [`Embedded::packed`] packed; the residual is 0.
    #[must_use]
    pub fn unpacked(b: [u8; 10]) -> Self {
        let unit = |i: usize| f64::from(u16::from_le_bytes([b[i], b[i + 1]])) / UNIT;
        let place = Place { corners: [unit(4), unit(6)], height: unit(8) };
        Self { prism: u32::from_le_bytes([b[0], b[1], b[2], b[3]]), place, residual: DVec3::ZERO }
    }
}

impl Layers {
    /// Embeds points, rest pose, model space; those outside all prisms in the nearest place found, with a residual.
    ///
    /// ```
    /// use sinew_bake::cage::layers::{Layers, Settings};
    /// let layers = Layers::new(&sinew_bake::builtin::character(), &Settings::default())?;
    /// let middle = layers.prisms[7].map(|i| layers.rest[i as usize]).iter().sum::<glam::DVec3>() / 6.0;
    /// let at = layers.embed(&[middle])[0];
    /// assert_eq!(at.prism, 7);
    /// assert!((at.place.height - 0.5).abs() < 1e-9 && at.residual.length() < 1e-12);
    /// # Ok::<(), sinew_bake::Error>(())
    /// ```
    #[must_use]
    pub fn embed(&self, points: &[DVec3]) -> Vec<Embedded> {
        let boxes = self.prisms.iter().zip(0_u32..).map(|(prism, number)| {
            let nodes = prism.map(|i| self.rest[i as usize]);
            let low = nodes.iter().fold(nodes[0], |low, x| low.min(*x));
            let high = nodes.iter().fold(nodes[0], |high, x| high.max(*x));
            GeomWithData::new(Rectangle::from_corners(low.to_array(), high.to_array()), number)
        });
        let tree = RTree::bulk_load(boxes.collect());
        points.par_iter().map(|p| self.embed_one(&tree, *p)).collect()
    }

    fn embed_one(&self, tree: &RTree<GeomWithData<Rectangle<[f64; 3]>, u32>>, p: DVec3) -> Embedded {
        let nodes = |prism: u32| self.prisms[prism as usize].map(|i| self.rest[i as usize]);
        let clamped = |prism: u32, place: Place| {
            let inside = place.clamped();
            let residual = p - inside.point(&nodes(prism));
            (place.outside(), Embedded { prism, place: inside, residual })
        };
        let candidate = |prism: u32| locate(&nodes(prism), p).map(|place| clamped(prism, place));
        let at = p.to_array();
        let around = tree.locate_in_envelope_intersecting(&AABB::from_point(at)).map(|g| g.data);
        let mut found: Vec<(f64, Embedded)> = around.filter_map(candidate).collect();
        if !found.iter().any(|(outside, _)| *outside <= INSIDE) {
            for prism in tree.nearest_neighbor_iter(&at).take(NEAREST).map(|g| g.data) {
                found.extend(candidate(prism));
                let ends = [0.0, 1.0].into_iter().filter_map(|s| at_height(&nodes(prism), p, s));
                found.extend(ends.map(|place| (f64::INFINITY, clamped(prism, place).1)));
            }
        }
        let least =
            |(outside, e): &(f64, Embedded)| if *outside <= INSIDE { 0.0 } else { e.residual.length() };
        let best =
            found.into_iter().min_by(|a, b| least(a).total_cmp(&least(b)).then(a.1.prism.cmp(&b.1.prism)));
        best.map_or(Embedded { prism: 0, place: Place::default(), residual: p }, |(_, e)| e)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cage::layers::sound::is_sound;

    /// Numbers in 0..1 (`SplitMix64`).
    fn random(state: &mut u64) -> f64 {
        *state = state.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = *state;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        #[expect(clippy::cast_precision_loss, reason = "53 bits")]
        let unit = ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64;
        unit
    }

    /// A prism with every node up to `by` off the upright one.
    fn warped(state: &mut u64, by: f64) -> [DVec3; 6] {
        let upright = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
        core::array::from_fn(|i| {
            let base = DVec3::from_array(upright[i % 3]) + if i < 3 { DVec3::ZERO } else { DVec3::Z };
            base + by * (2.0 * DVec3::new(random(state), random(state), random(state)) - DVec3::ONE)
        })
    }

    fn inside(state: &mut u64) -> Place {
        let (a, b) = (random(state), random(state));
        let corners = if a + b > 1.0 { [1.0 - a, 1.0 - b] } else { [a, b] };
        Place { corners, height: random(state) }
    }

    /// Points of 3,000 prisms, sound and warped as far as that goes, and of upright ones, whose cubic is linear.
    #[test]
    fn points_inside_are_found_again() {
        let mut state = 1;
        let (mut tried, mut worst) = (0, 0.0_f64);
        while tried < 3000 {
            let nodes = warped(&mut state, if tried % 10 == 0 { 0.0 } else { 0.45 });
            if !is_sound(&nodes, 0.01) {
                continue;
            }
            tried += 1;
            let place = inside(&mut state);
            let p = place.point(&nodes);
            let found = locate(&nodes, p).expect("a plane");
            assert!(found.outside() < 1e-12, "{found:?} of {place:?}");
            worst = worst.max(found.point(&nodes).distance(p));
        }
        // Rounding of coordinates of size 1, divided by the least Jacobian of 0.01 where the map is steepest.
        assert!(worst < 1e-12, "{worst}");
    }

    /// In a sound prism the inverse is one: the coordinates come back, not only the point.
    #[test]
    fn a_sound_prism_has_one_place_for_a_point() {
        let mut state = 2;
        let mut tried = 0;
        while tried < 3000 {
            let nodes = warped(&mut state, 0.4);
            if is_sound(&nodes, 0.05) {
                tried += 1;
                let place = inside(&mut state);
                let found = locate(&nodes, place.point(&nodes)).expect("a plane");
                let off = (found.height - place.height).abs()
                    + (0..2).map(|i| (found.corners[i] - place.corners[i]).abs()).sum::<f64>();
                assert!(off < 1e-11, "{off}");
            }
        }
    }

    #[test]
    fn ten_bytes_keep_a_point_to_a_part_in_65535() {
        let mut state = 3;
        for prism in 0..1000 {
            let place = inside(&mut state);
            let back = Embedded::unpacked(Embedded { prism, place, residual: DVec3::ZERO }.packed());
            assert_eq!(back.prism, prism);
            let coordinates = |p: &Place| [p.corners[0], p.corners[1], p.height];
            let pairs = coordinates(&back.place).into_iter().zip(coordinates(&place));
            assert!(pairs.into_iter().all(|(a, b)| (a - b).abs() <= 0.5 / UNIT + 1e-15));
        }
    }

    #[test]
    fn roots_are_all_those_in_the_range() {
        // (s − ¼)(s − ½)(s − ¾), a double root, a line, a constant, a root at the very end.
        let near = |c: [f64; 4], want: &[f64]| {
            let found: Vec<f64> = roots(c).into_iter().flatten().collect();
            assert_eq!(found.len(), want.len(), "{found:?}");
            assert!(found.iter().zip(want).all(|(a, b)| (a - b).abs() < 1e-15), "{found:?}");
        };
        near([-3.0 / 32.0, 11.0 / 16.0, -1.5, 1.0], &[0.25, 0.5, 0.75]);
        near([-1.0, 2.0, 0.0, 0.0], &[0.5]);
        near([1.0, 0.0, 0.0, 0.0], &[]);
        near([-1.0, 1.0, 0.0, 0.0], &[1.0]);
        near([0.0, 1.0, 0.0, 0.0], &[0.0]);
        near([-0.125, 0.0, 1.0, 0.0], &[libm::sqrt(0.125)]);
    }
}
