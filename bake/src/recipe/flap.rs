//! Small and flat ears: parts of the head with much more skin than the hole they would leave.
//!
//! Around each tip a disc grows over the surface. The hole it leaves is the length of the sum of its area vectors (that
//! of a closed surface is 0, so a part's is its hole's); skin by hole is 1 on a plane, 2 on a half ball, `1 + 2 L / r`
//! on a cylinder of length `L` and radius `r` and as much on a flap of that length and thickness `r`. Beyond the base
//! it falls, wherever the head's middle is and however the ear lies: so this finds what [`super::protrusion`] cannot.

use std::collections::{BTreeMap, BTreeSet};

use glam::DVec3;

use super::mirror::Symmetry;
use super::protrusion::{Protrusion, ways};
use super::surface::Surface;

/// Skin by hole, at least: noses and chins have less.
const SKIN_BY_HOLE: f64 = 2.5;
/// The disc ends where skin by hole has fallen to this share of its largest value.
const FALLEN: f64 = 0.85;
/// Largest share of the head's skin.
const MOST: f64 = 0.2;
/// Shortest flap, body sizes.
const SHORTEST: f64 = 0.012;
/// Length from which a tip is entirely soft, body sizes: people's ears are shorter.
const SOFT: f64 = 0.02;
/// Twins' middles agree to this share of their length.
const TWIN: f64 = 0.5;
/// The face begins at this share of the way from the back of the head to the nose.
const FACE: f64 = 0.6;
/// How much rather the head's own shell goes on below the head than not, as hair.
const BODY: f64 = 4.0;
/// The middle is this share of the length off the hole's.
const OFF: f64 = 0.2;

/// A disc around a tip.
#[derive(Clone, Debug)]
struct Disc {
    points: Vec<usize>,
    middle: DVec3,
    /// Skin by hole.
    ratio: f64,
    /// Volume over the hole: mouths and nostrils leave a small hole too, but go inwards.
    volume: f64,
    /// Farthest from the rest of the head, body sizes.
    length: f64,
    /// Place of each point from base (0) to tip (1).
    places: Vec<f64>,
}

/// Finds pairs of flaps among the points marked in `head` (with the neck) that are not `taken`, behind the face; not on
/// other shells than the head's own: hair is made of flaps too.
pub(super) fn find(
    surface: &Surface,
    symmetry: &Symmetry,
    front: f64,
    head: &[bool],
    taken: &[bool],
) -> Vec<Protrusion> {
    let Some(own) = own_shell(surface, head) else { return Vec::new() };
    let head: Vec<bool> = (0..head.len()).map(|i| head[i] && surface.shell[i] == own).collect();
    let inside = || (0..head.len()).filter(|i| head[*i]);
    let all: f64 = inside().map(|i| surface.area[i]).sum();
    let ahead = |i: usize| surface.points[i].z * front;
    let (back, nose) = inside().map(ahead).fold((f64::MAX, f64::MIN), |(a, b), z| (a.min(z), b.max(z)));
    let free = |i: usize| head[i] && !taken[i];
    let skin: Vec<usize> = (0..head.len()).filter(|i| surface.shell[*i] == own).collect();
    let outward = volume(surface, skin.iter().copied(), surface.points[skin[0]]);
    let mut discs: Vec<Disc> = tips(surface, &head)
        .into_iter()
        .filter(|i| free(*i) && ahead(*i) < back + FACE * (nose - back))
        .flat_map(|tip| grow(surface, symmetry, tip, MOST * all, &free))
        .filter(|disc| disc.volume * outward > 0.0)
        .collect();
    discs.sort_by(|a, b| (b.ratio * b.length).total_cmp(&(a.ratio * a.length)));
    let mut used = vec![false; head.len()];
    let mut apart: Vec<Disc> = Vec::new();
    for disc in discs {
        if disc.points.iter().all(|i| !used[*i]) {
            disc.points.iter().for_each(|i| used[*i] = true);
            apart.push(disc);
        }
    }
    let twin = |a: &Disc| {
        let image = symmetry.mirrored(a.middle);
        apart.iter().any(|b| image.distance(b.middle) < TWIN * a.length.max(b.length) && b.middle != a.middle)
    };
    let paired = apart.iter().filter(|d| twin(d));
    let protrusion = |d: &Disc| Protrusion {
        points: d.points.iter().copied().zip(d.places.iter().copied()).collect(),
        length: d.length,
        peak: (d.length / SOFT).min(1.0),
        paired: true,
    };
    paired.map(protrusion).collect()
}

/// The shell that has most of the head's skin; one that goes on below the head is preferred.
fn own_shell(surface: &Surface, head: &[bool]) -> Option<usize> {
    let (mut areas, mut below) = (vec![0.0; surface.shells], vec![false; surface.shells]);
    for (i, inside) in head.iter().enumerate() {
        let shell = surface.shell[i];
        areas[shell] += if *inside { surface.area[i] } else { 0.0 };
        below[shell] |= !inside;
    }
    let score = |s: &usize| areas[*s] * if below[*s] { BODY } else { 1.0 };
    let best = (0..surface.shells).max_by(|a, b| score(a).total_cmp(&score(b)).then(b.cmp(a)));
    best.filter(|s| areas[*s] > 0.0)
}

/// Points of the head that are farther than their neighbors, from the neck along the surface or from the middle.
fn tips(surface: &Surface, head: &[bool]) -> BTreeSet<usize> {
    let inside: Vec<usize> = (0..head.len()).filter(|i| head[*i]).collect();
    let area: f64 = inside.iter().map(|i| surface.area[*i]).sum();
    let middle =
        inside.iter().map(|i| surface.points[*i] * surface.area[*i]).sum::<DVec3>() / area.max(1e-12);
    let lowest = inside.iter().copied().min_by(|a, b| surface.points[*a].y.total_cmp(&surface.points[*b].y));
    let neck = |i: usize| Some(i) == lowest || head[i] && surface.links[i].iter().any(|(j, _)| !head[*j]);
    let start: Vec<f64> = (0..head.len()).map(|i| if neck(i) { 0.0 } else { f64::INFINITY }).collect();
    let along = ways(&surface.links, &start, |i| head[i]);
    let across: Vec<f64> = surface.points.iter().map(|p| p.distance(middle)).collect();
    let farthest = |far: &[f64], i: usize| {
        far[i].is_finite() && surface.edges[i].iter().all(|(j, _)| !head[*j] || far[*j] <= far[i])
    };
    inside.into_iter().filter(|i| farthest(&along, *i) || farthest(&across, *i)).collect()
}

/// The discs around a tip that have more skin by hole than somewhat larger ones.
fn grow(
    surface: &Surface,
    symmetry: &Symmetry,
    tip: usize,
    most: f64,
    free: &impl Fn(usize) -> bool,
) -> Vec<Disc> {
    let order = nearest(surface, tip, most, free);
    let (mut area, mut hole) = (0.0, DVec3::ZERO);
    let mut ratios = Vec::with_capacity(order.len());
    for i in &order {
        area += surface.area[*i];
        hole += surface.vector[*i];
        ratios.push(area / hole.length().max(1e-9 * area).max(1e-18));
    }
    bases(&ratios).into_iter().filter_map(|n| disc(surface, symmetry, &order[..=n], ratios[n])).collect()
}

/// Where flaps may end: before skin by hole falls.
fn bases(ratios: &[f64]) -> Vec<usize> {
    let (mut best, mut last, mut bases) = (0.0, None, Vec::new());
    // The first points of a coarse mesh may enclose anything.
    for (n, ratio) in ratios.iter().enumerate().skip(3) {
        best = f64::max(best, *ratio);
        if *ratio >= FALLEN * best {
            last = Some(n);
        } else {
            bases.extend(last.take().filter(|_| best >= SKIN_BY_HOLE));
            best = *ratio;
        }
    }
    bases
}

/// A disc, if it is a flap.
fn disc(surface: &Surface, symmetry: &Symmetry, points: &[usize], ratio: f64) -> Option<Disc> {
    let inside: BTreeSet<usize> = points.iter().copied().collect();
    let mut start = vec![f64::INFINITY; surface.points.len()];
    for &i in points {
        let beyond = surface.edges[i].iter().filter(|(j, _)| !inside.contains(j)).map(|(_, l)| *l / 2.0);
        start[i] = beyond.fold(f64::INFINITY, f64::min);
    }
    let way = ways(&surface.edges, &start, |i| inside.contains(&i));
    let length = points.iter().map(|i| way[*i]).fold(0.0, f64::max);
    let mean = |of: &dyn Fn(usize) -> DVec3, weight: &dyn Fn(usize) -> f64| {
        let all: f64 = points.iter().map(|i| weight(*i)).sum();
        points.iter().map(|i| of(*i) * weight(*i)).sum::<DVec3>() / all.max(1e-12)
    };
    let area = |i: usize| surface.area[i];
    let middle = mean(&|i| symmetry.centered[i], &area);
    let hole = mean(&|i| surface.points[i], &|i| if start[i].is_finite() { 1.0 } else { 0.0 });
    let off = mean(&|i| surface.points[i], &area).distance(hole);
    let aside = points.iter().all(|i| symmetry.centered[*i][symmetry.axis] * middle[symmetry.axis] > 0.0);
    (length >= SHORTEST && aside && off > OFF * length && length.is_finite()).then(|| Disc {
        points: points.to_vec(),
        middle,
        ratio,
        volume: volume(surface, points.iter().copied(), hole),
        length,
        places: points.iter().map(|i| way[*i] / length).collect(),
    })
}

/// Three times the volume between some points' skin and `from`; negative inside a surface that is inside out.
fn volume(surface: &Surface, points: impl Iterator<Item = usize>, from: DVec3) -> f64 {
    points.map(|i| (surface.points[i] - from).dot(surface.vector[i])).sum()
}

/// Points in the order of their way from `tip`, up to an area.
fn nearest(surface: &Surface, tip: usize, most: f64, free: &impl Fn(usize) -> bool) -> Vec<usize> {
    let mut reached = BTreeSet::new();
    let mut way = BTreeMap::new();
    let key = |w: f64| w.to_bits();
    reached.insert((key(0.0), tip));
    way.insert(tip, 0.0);
    let mut order = Vec::new();
    let mut area = 0.0;
    while let Some((w, i)) = reached.pop_first() {
        area += surface.area[i];
        if area > most {
            break;
        }
        order.push(i);
        for (j, length) in surface.edges[i].iter().filter(|(j, _)| free(*j)) {
            let there = f64::from_bits(w) + length;
            let known = way.get(j).copied().unwrap_or(f64::INFINITY);
            if there < known {
                reached.remove(&(key(known), *j));
                reached.insert((key(there), *j));
                way.insert(*j, there);
            }
        }
    }
    order
}
