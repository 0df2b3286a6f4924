//! Ears, horns and tufts that have no joint of their own: parts of the head that stick out far and thin.
//!
//! The way along the surface from the neck has a peak at each tip. Sweeping it downwards, the surface above the
//! level falls into islands; an island that is long for its area when it meets another one is a protrusion.

use core::cmp::Ordering;
use std::collections::BinaryHeap;

use glam::DVec3;

use super::surface::Surface;

/// Shortest protrusion, body sizes.
const SHORTEST: f64 = 0.045;
/// Smallest ratio of length to width.
const ELONGATED: f64 = 1.25;
/// An island ends where it is this many times as wide as before.
const FLARE: f64 = 2.0;
/// Steps in which width is measured.
const STEPS: usize = 24;

/// A part that sticks out.
#[derive(Clone, Debug)]
pub(super) struct Protrusion {
    /// Points with their place from base (0) to tip (1).
    pub(super) points: Vec<(usize, f64)>,
    /// Base to tip, body sizes.
    pub(super) length: f64,
}

/// Points and how far they are; nearest first in a heap.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Front(f64, usize);

impl Eq for Front {}

impl Ord for Front {
    fn cmp(&self, other: &Self) -> Ordering {
        other.0.total_cmp(&self.0).then(other.1.cmp(&self.1))
    }
}

impl PartialOrd for Front {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

/// Shortest ways along `links` from the points where `start` is finite, begun with its values; ways only pass
/// through points that are `open`.
pub(super) fn ways(links: &[Vec<(usize, f64)>], start: &[f64], open: impl Fn(usize) -> bool) -> Vec<f64> {
    let mut way = start.to_vec();
    let begun = way.iter().enumerate().filter(|(_, w)| w.is_finite());
    let mut heap: BinaryHeap<Front> = begun.map(|(i, w)| Front(*w, i)).collect();
    while let Some(Front(w, i)) = heap.pop() {
        if w > way[i] {
            continue;
        }
        for (j, length) in links[i].iter().filter(|(j, _)| open(*j)) {
            if w + length < way[*j] {
                way[*j] = w + length;
                heap.push(Front(way[*j], *j));
            }
        }
    }
    way
}

/// An island of the surface above the current level.
#[derive(Clone, Debug, Default)]
struct Island {
    points: Vec<usize>,
    peak: f64,
    taken: bool,
}

/// Finds what sticks out of the points marked in `head`.
pub(super) fn find(surface: &Surface, head: &[bool]) -> Vec<Protrusion> {
    let start: Vec<f64> = head.iter().map(|h| if *h { f64::INFINITY } else { 0.0 }).collect();
    let way = ways(&surface.links, &start, |i| head[i]);
    let mut order: Vec<usize> = (0..head.len()).filter(|i| head[*i] && way[*i].is_finite()).collect();
    order.sort_by(|a, b| way[*b].total_cmp(&way[*a]).then(a.cmp(b)));
    let sweep = Sweep { surface, way: &way, shape: Shape::new(surface, &order) };
    sweep.run(&order)
}

/// Middle, radius and area of the head.
struct Shape {
    middle: DVec3,
    radius: f64,
    area: f64,
}

impl Shape {
    fn new(surface: &Surface, points: &[usize]) -> Self {
        let area: f64 = points.iter().map(|i| surface.area[*i]).sum();
        let mean = |of: &dyn Fn(usize) -> f64| {
            points.iter().map(|i| of(*i) * surface.area[*i]).sum::<f64>() / area.max(1e-12)
        };
        let middle = DVec3::from_array([0, 1, 2].map(|axis| mean(&|i| surface.points[i][axis])));
        Self { middle, radius: mean(&|i| surface.points[i].distance(middle)), area }
    }
}

struct Sweep<'a> {
    surface: &'a Surface,
    way: &'a [f64],
    shape: Shape,
}

impl Sweep<'_> {
    fn run(&self, order: &[usize]) -> Vec<Protrusion> {
        let mut island_of = vec![usize::MAX; self.way.len()];
        let mut islands: Vec<Island> = Vec::new();
        let mut found = Vec::new();
        for &i in order {
            let level = self.way[i];
            let mut near: Vec<usize> = self.surface.links[i]
                .iter()
                .map(|(j, _)| island_of[*j])
                .filter(|n| *n != usize::MAX)
                .collect();
            near.sort_by(|a, b| islands[*b].peak.total_cmp(&islands[*a].peak).then(a.cmp(b)));
            near.dedup();
            let Some((&home, others)) = near.split_first() else {
                island_of[i] = islands.len();
                islands.push(Island { points: vec![i], peak: level, taken: false });
                continue;
            };
            for &other in others {
                let met = core::mem::take(&mut islands[other]);
                if !met.taken
                    && let Some(protrusion) = self.measure(&met, level)
                {
                    found.push(protrusion);
                    if !islands[home].taken {
                        found.extend(self.measure(&islands[home], level));
                    }
                    islands[home].taken = true;
                }
                islands[home].taken |= met.taken;
                met.points.iter().for_each(|p| island_of[*p] = home);
                islands[home].points.extend(met.points);
            }
            islands[home].points.push(i);
            island_of[i] = home;
        }
        let alone = islands.iter().filter(|island| !island.taken && !island.points.is_empty());
        found.extend(alone.filter_map(|island| self.measure(island, 0.0)));
        found
    }

    /// The island down to `level`, or to where it flares out before, if it is long, thin and sticks out.
    fn measure(&self, island: &Island, level: f64) -> Option<Protrusion> {
        let height = island.peak - level;
        if height < SHORTEST {
            return None;
        }
        #[expect(clippy::cast_precision_loss, reason = "a small count")]
        let step = height / STEPS as f64;
        let mut area = [0.0; STEPS];
        for i in &island.points {
            #[expect(
                clippy::cast_possible_truncation,
                clippy::cast_sign_loss,
                reason = "clamped to the steps"
            )]
            let slot = ((island.peak - self.way[*i]) / step).clamp(0.0, STEPS as f64 - 1.0) as usize;
            area[slot] += self.surface.area[*i];
        }
        let flare = |k: &usize| {
            let above = area[1..*k].iter().sum::<f64>();
            #[expect(clippy::cast_precision_loss, reason = "a small count")]
            let mean = above / (*k - 1) as f64;
            (area[*k] + area[(*k + 1).min(STEPS - 1)]) / 2.0 > FLARE * mean
        };
        let end = (8..STEPS).find(flare).unwrap_or(STEPS);
        #[expect(clippy::cast_precision_loss, reason = "a small count")]
        let length = step * end as f64;
        let covered: f64 = area[..end].iter().sum();
        let tip = island.points.first().map(|i| self.surface.points[*i])?;
        let sticks_out = tip.distance(self.shape.middle) > 1.3 * self.shape.radius;
        let thin = 2.0 * length * length > ELONGATED * covered && covered < 0.35 * self.shape.area;
        let base = island.peak - length;
        let place = |i: &usize| (*i, ((self.way[*i] - base) / length).clamp(0.0, 1.0));
        let points = island.points.iter().filter(|i| self.way[**i] > base).map(place).collect();
        (sticks_out && thin && length >= SHORTEST && covered > 0.0).then_some(Protrusion { points, length })
    }
}
