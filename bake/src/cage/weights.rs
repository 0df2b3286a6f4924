//! Skin weights of a cage's nodes: those of the closest skin near it, harmonic inside (as Baran and Popović, Automatic
//! rigging and animation of 3D characters, 2007, spread heat from the skin's side).

use super::Cage;
use super::harmonic::{Graph, Work};
use super::surface::{Row, Surface};
use rayon::prelude::*;
use std::collections::BTreeMap;

/// A node closer to the surface than this many edges of the lattice takes the weights of the surface.
const NEAR: f64 = 1.0;
/// Weights below this are left out.
const NOTHING: f64 = 1e-7;

/// What skin weights of nodes were made of.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct NodeWeights {
    /// Nodes of the model that move each node of the cage, above 0, sum 1.
    pub rows: Vec<Row>,
    /// Greatest distance of a sum from 1 before it was made so.
    pub defect: f64,
    /// Smallest weight before those below 0 were left out.
    pub least: f64,
}

/// Carries the weights of a surface to the nodes of its cage. A surface without weights gives empty rows.
#[must_use]
pub fn weights(surface: &Surface, cage: &Cage) -> NodeWeights {
    if surface.weights.is_empty() {
        return NodeWeights { rows: vec![Row::new(); cage.rest.len()], ..NodeWeights::default() };
    }
    let (near, rows) = near(surface, cage);
    let graph = Graph::new(&cage.links, &near);
    let mut columns: BTreeMap<u32, Vec<(usize, f64)>> = BTreeMap::new();
    for (i, row) in rows.iter().enumerate() {
        row.iter().for_each(|(node, w)| columns.entry(*node).or_default().push((i, *w)));
    }
    let columns: Vec<(u32, Vec<(usize, f64)>)> = columns.into_iter().collect();
    let solve = |work: &mut Work, (node, fixed): &(u32, Vec<(usize, f64)>)| {
        let mut values = vec![0.0; near.len()];
        fixed.iter().for_each(|(i, w)| values[*i] = *w);
        graph.solve(&mut values, work);
        (*node, values)
    };
    let solved: Vec<(u32, Vec<f64>)> = columns.par_iter().map_init(|| graph.work(), solve).collect();
    gather(cage.rest.len(), &solved)
}

/// Nodes that the surface gives weights to, and these.
fn near(surface: &Surface, cage: &Cage) -> (Vec<bool>, Vec<Row>) {
    let nearest: Vec<_> = cage.rest.par_iter().map(|p| surface.nearest(*p)).collect();
    let mut near: Vec<bool> = nearest.iter().map(|n| n.distance <= NEAR * cage.edge).collect();
    for i in unreached(cage, &near) {
        near[i] = true;
    }
    let row = |i: usize| if near[i] { blend(surface, &nearest[i]) } else { Row::new() };
    let rows = (0..near.len()).map(row).collect();
    (near, rows)
}

/// Nodes that no way leads to from one near the surface.
fn unreached(cage: &Cage, near: &[bool]) -> Vec<usize> {
    let mut neighbors = vec![Vec::new(); near.len()];
    for [a, b] in &cage.links {
        neighbors[*a as usize].push(*b as usize);
        neighbors[*b as usize].push(*a as usize);
    }
    let mut reached = near.to_vec();
    let mut open: Vec<usize> = (0..near.len()).filter(|i| near[*i]).collect();
    while let Some(i) = open.pop() {
        for &j in &neighbors[i] {
            if !reached[j] {
                reached[j] = true;
                open.push(j);
            }
        }
    }
    (0..near.len()).filter(|i| !reached[*i]).collect()
}

/// Weights of a point of the surface.
pub(super) fn blend(surface: &Surface, at: &super::tree::Nearest) -> Row {
    let mut sums = BTreeMap::new();
    for (corner, share) in surface.triangles[at.triangle as usize].iter().zip(at.at) {
        for (node, w) in &surface.weights[*corner as usize] {
            *sums.entry(*node).or_insert(0.0) += w * share;
        }
    }
    sums.into_iter().filter(|(_, w)| *w > 0.0).collect()
}

fn gather(nodes: usize, solved: &[(u32, Vec<f64>)]) -> NodeWeights {
    let mut out = NodeWeights { rows: Vec::with_capacity(nodes), ..NodeWeights::default() };
    for i in 0..nodes {
        let all = || solved.iter().map(|(node, values)| (*node, values[i]));
        out.defect = out.defect.max((all().map(|(_, w)| w).sum::<f64>() - 1.0).abs());
        out.least = all().map(|(_, w)| w).fold(out.least, f64::min);
        let kept: Row = all().filter(|(_, w)| *w > NOTHING).collect();
        let total: f64 = kept.iter().map(|(_, w)| w).sum();
        out.rows.push(kept.into_iter().map(|(node, w)| (node, w / total)).collect());
    }
    out
}
