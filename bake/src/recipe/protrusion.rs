//! Ears, horns and tufts, with joints of their own or without: parts of the head that stick out far and thin.
//!
//! The way along the surface from the skull (what is near the middle of the head) has a peak at each tip. Sweeping it
//! downwards, the surface above the level falls into islands; an island that is long for its area when it meets
//! another one is a protrusion.

use core::cmp::Ordering;
use std::collections::BinaryHeap;

use glam::DVec3;

use super::mirror::Symmetry;
use super::surface::Surface;

/// Shortest protrusion, body sizes.
const SHORTEST: f64 = 0.034;
/// Smallest ratio of length to width: of one with a twin, as ears have; of one in the middle, as noses are.
const ELONGATED: (f64, f64) = (1.25, 2.5);
/// The skull reaches this far from its middle, times the median of the head's points. A small one shows ears to their
/// base, a large one keeps the ears of a coarse mesh apart; the smallest that shows an ear decides.
const SKULLS: [f64; 5] = [0.6, 0.75, 0.9, 1.05, 1.2];
/// Steps in which an island is cut shorter until it is thin.
const STEPS: usize = 24;

/// A part that sticks out.
#[derive(Clone, Debug)]
pub(super) struct Protrusion {
    /// Points with their place from base (0) to tip (1).
    pub(super) points: Vec<(usize, f64)>,
    /// Base to tip, body sizes.
    pub(super) length: f64,
    /// Has a twin on the other side.
    pub(super) paired: bool,
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
pub(super) fn find(surface: &Surface, symmetry: &Symmetry, head: &[bool]) -> Vec<Protrusion> {
    let inside: Vec<usize> = (0..head.len()).filter(|i| head[*i]).collect();
    let shape = Shape::new(surface, &inside);
    let mut taken = vec![false; head.len()];
    let mut found: Vec<Protrusion> = Vec::new();
    for reach in SKULLS {
        let skull = |i: usize| !head[i] || shape.place(surface.points[i]) < reach * shape.typical;
        let start: Vec<f64> = (0..head.len()).map(|i| if skull(i) { 0.0 } else { f64::INFINITY }).collect();
        let way = ways(&surface.links, &start, |i| head[i]);
        let out = |i: &usize| way[*i].is_finite() && way[*i] > 0.0;
        let mut order: Vec<usize> = inside.iter().copied().filter(out).collect();
        order.sort_by(|a, b| way[*b].total_cmp(&way[*a]).then(a.cmp(b)));
        for protrusion in (Sweep { surface, symmetry, way: &way, shape: &shape }).run(&order) {
            if protrusion.points.iter().all(|(i, _)| !taken[*i]) {
                protrusion.points.iter().for_each(|(i, _)| taken[*i] = true);
                found.push(protrusion);
            }
        }
    }
    found
}

/// An ellipsoid like the head, and the head's area; by quantiles over the area, which long ears do not shift.
struct Shape {
    middle: DVec3,
    half: DVec3,
    typical: f64,
    area: f64,
}

impl Shape {
    fn new(surface: &Surface, points: &[usize]) -> Self {
        let area: f64 = points.iter().map(|i| surface.area[*i]).sum();
        let quantile = |share: f64, of: &dyn Fn(usize) -> f64| {
            let mut values: Vec<(f64, f64)> = points.iter().map(|i| (of(*i), surface.area[*i])).collect();
            values.sort_by(|a, b| a.0.total_cmp(&b.0));
            let mut left = area * share;
            let reached = values.iter().find(|(_, area)| {
                left -= area;
                left <= 0.0
            });
            reached.map_or(0.0, |(value, _)| *value)
        };
        let along =
            |share: f64| DVec3::from_array([0, 1, 2].map(|a| quantile(share, &|i| surface.points[i][a])));
        let (low, high) = (along(0.25), along(0.75));
        let half = ((high - low) / 2.0).max(DVec3::splat(1e-6));
        let mut shape = Self { middle: (low + high) / 2.0, half, typical: 0.0, area };
        shape.typical = quantile(0.5, &|i| shape.place(surface.points[i]));
        shape
    }

    /// Distance from the middle in half axes.
    fn place(&self, p: DVec3) -> f64 {
        ((p - self.middle) / self.half).length()
    }
}

struct Sweep<'a> {
    surface: &'a Surface,
    symmetry: &'a Symmetry,
    way: &'a [f64],
    shape: &'a Shape,
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

    /// The island down to `level`, or as far down as it is thin, if that is long enough.
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
        let aside = |i: &&usize| self.symmetry.centered[**i][self.symmetry.axis].abs() > 0.01;
        let paired = 10 * island.points.iter().filter(aside).count() > 9 * island.points.len();
        let least = if paired { ELONGATED.0 } else { ELONGATED.1 };
        let ends = (1..=STEPS).rev().map(|end| {
            #[expect(clippy::cast_precision_loss, reason = "a small count")]
            let length = step * end as f64;
            (length, area[..end].iter().sum::<f64>())
        });
        // A strip of this length and area (both sides) has the width area / (2 length).
        let thin = |(length, area): &(f64, f64)| *area > 0.0 && 2.0 * length * length > least * area;
        let (length, area) = ends.into_iter().find(thin)?;
        let base = island.peak - length;
        let place = |i: &usize| (*i, ((self.way[*i] - base) / length).clamp(0.0, 1.0));
        let points: Vec<(usize, f64)> =
            island.points.iter().filter(|i| self.way[**i] > base).map(place).collect();
        (length >= SHORTEST && points.len() > 2 && area < 0.35 * self.shape.area).then_some(Protrusion {
            points,
            length,
            paired,
        })
    }
}
