//! Softness made smooth over the surface, and the same across shells that touch.

use super::field::ease;
use super::protrusion::ways;
use super::surface::Surface;

/// Length over which softness is evened out, body sizes.
const EVEN: f64 = 0.014;
/// Passes of the solver.
const PASSES: usize = 80;
/// What is below this after smoothing is rigid.
const FLOOR: f64 = 0.04;
/// Steepest change of softness per body size.
const STEEPEST: f64 = 25.0;
/// Shells with a box smaller than this (body sizes) move as a piece.
const PIECE: f64 = 0.08;
/// Beside a border between regions softness is taken to 0 over this length, body sizes.
const BORDER: f64 = 0.02;

/// Evens out: minimizes `Σ aᵢ (sᵢ − rᵢ)² + EVEN² Σ aᵢⱼ ((sᵢ − sⱼ) / lᵢⱼ)²`, area `a` (the smaller of two), length `l`.
pub(super) fn even(surface: &Surface, soft: &mut [f64]) {
    let raw = soft.to_vec();
    let mass: Vec<f64> = surface.area.iter().map(|a| a + 1e-9).collect();
    let pulls: Vec<Vec<(usize, f64)>> = surface
        .links
        .iter()
        .enumerate()
        .map(|(i, row)| {
            row.iter()
                .map(|(j, length)| {
                    let length = length.max(1e-3);
                    (*j, EVEN * EVEN * mass[i].min(mass[*j]) / (length * length))
                })
                .collect()
        })
        .collect();
    for _ in 0..PASSES {
        for i in 0..soft.len() {
            let (mut sum, mut weight) = (mass[i] * raw[i], mass[i]);
            for (j, pull) in &pulls[i] {
                sum += pull * soft[*j];
                weight += pull;
            }
            soft[i] = sum / weight;
        }
    }
    for s in soft.iter_mut() {
        *s = ((*s - FLOOR) / (1.0 - FLOOR)).clamp(0.0, 1.0);
    }
}

/// A shell so small that it moves as one: a button, an eye, a tooth.
#[derive(Clone, Debug)]
pub(super) struct Piece {
    pub(super) points: Vec<usize>,
    /// Points of larger shells that it sits on, or its own where it sits on none.
    pub(super) decided_by: Vec<usize>,
}

/// Small shells, in order; the one with the most points is never a piece.
pub(super) fn pieces(surface: &Surface) -> Vec<Piece> {
    let mut members = vec![Vec::new(); surface.shells];
    for (i, shell) in surface.shell.iter().enumerate() {
        members[*shell].push(i);
    }
    let biggest = members.iter().map(Vec::len).max().unwrap_or(0);
    let small = |points: &[usize]| {
        let first = surface.points[points[0]];
        let (low, high) = points.iter().fold((first, first), |(low, high), i| {
            (low.min(surface.points[*i]), high.max(surface.points[*i]))
        });
        points.len() < biggest && low.distance(high) <= PIECE
    };
    let is_small: Vec<bool> = members.iter().map(|m| small(m)).collect();
    let piece = |points: Vec<usize>| {
        let touched = points.iter().flat_map(|i| surface.links[*i].iter().map(|(j, _)| *j));
        let under: Vec<usize> = touched.filter(|j| !is_small[surface.shell[*j]]).collect();
        let decided_by = if under.is_empty() { points.clone() } else { under };
        Piece { points, decided_by }
    };
    members.into_iter().filter(|m| small(m)).map(piece).collect()
}

/// Gives each piece one softness: the mean where it sits.
pub(super) fn unite(pieces: &[Piece], soft: &mut [f64]) {
    for piece in pieces {
        #[expect(clippy::cast_precision_loss, reason = "a mean over a count")]
        let mean = piece.decided_by.iter().map(|i| soft[*i]).sum::<f64>() / piece.decided_by.len() as f64;
        piece.points.iter().for_each(|i| soft[*i] = mean);
    }
}

/// Lowers softness where it rises more steeply than an ear's.
pub(super) fn limit_slope(surface: &Surface, soft: &mut [f64]) {
    let scaled: Vec<f64> = soft.iter().map(|s| s / STEEPEST).collect();
    let limited = ways(&surface.links, &scaled, |_| true);
    soft.iter_mut().zip(limited).for_each(|(s, l)| *s = (l * STEEPEST).min(*s));
}

/// Takes softness to 0 towards borders between regions, so that nothing tears there: the harder side of a border
/// where both sides are soft becomes rigid.
pub(super) fn fade_borders<T: PartialEq>(surface: &Surface, region: &[T], soft: &mut [f64]) {
    let torn = |i: usize| {
        let other = surface.links[i].iter().filter(|(j, _)| region[*j] != region[i]);
        soft[i] > 0.0 && other.into_iter().any(|(j, _)| soft[*j] >= soft[i])
    };
    let start: Vec<f64> = (0..soft.len()).map(|i| if torn(i) { 0.0 } else { f64::INFINITY }).collect();
    let way = ways(&surface.links, &start, |_| true);
    soft.iter_mut().zip(way).for_each(|(s, way)| *s *= ease(0.0, BORDER, way));
}
