//! Uniform cages: all cubes of a lattice that the surface touches or encloses, six tetrahedra each.
//!
//! The pattern of the six is that of Deep Emulator's data: all cubes have the same diagonals, so that faces of
//! neighbors match, and a node deep inside has 14 neighbors.

use super::Cage;
use super::lattice::Lattice;
use super::surface::Surface;
use crate::Error;
use rayon::prelude::*;

/// Corners of the six tetrahedra of a cube; bit 0 of a corner is x, bit 1 y, bit 2 z.
pub const SIX: [[usize; 4]; 6] = [
    [0b000, 0b001, 0b010, 0b100],
    [0b001, 0b010, 0b100, 0b101],
    [0b010, 0b100, 0b101, 0b110],
    [0b001, 0b011, 0b010, 0b101],
    [0b011, 0b101, 0b111, 0b110],
    [0b011, 0b010, 0b101, 0b110],
];
/// Halvings of the interval in which the edge is sought for a number of nodes.
const HALVINGS: usize = 14;

/// How fine a cage is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Resolution {
    /// Edge of a cube, m.
    Size(f64),
    /// Most nodes that it may have; at least 8.
    Vertices(usize),
}

/// What becomes of parts that touch nowhere.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Joining {
    /// They stay apart, and a note says so.
    Apart,
    /// Cubes are added along the shortest ways between them until all is one body.
    #[default]
    Bridged,
}

/// A cage of cubes around a surface: all of the surface is inside. Nodes are in the order of the lattice.
///
/// # Errors
///
/// [`Error::Unusable`] if the edge is not above 0, or so small that the lattice has more than 2²⁷ cubes, or if no cage
/// has so few nodes.
///
/// ```
/// use sinew_bake::{builtin, cage};
/// let surface = cage::Surface::new(&builtin::character())?;
/// let cage = cage::voxels(&surface, cage::Resolution::Vertices(2000), cage::Joining::Bridged)?;
/// assert!((1600..=2000).contains(&cage.rest.len()) && cage.components == 1);
/// # Ok::<(), sinew_bake::Error>(())
/// ```
pub fn voxels(surface: &Surface, resolution: Resolution, joining: Joining) -> Result<Cage, Error> {
    let (lattice, filled) = match resolution {
        Resolution::Size(edge) => {
            let lattice = Lattice::around(surface, edge)?;
            let filled = fill(surface, &lattice, touched(surface, &lattice));
            (lattice, filled)
        }
        Resolution::Vertices(most) => halve(surface, most, |edge| Ok(try_edge(surface, edge, most)))?,
    };
    Ok(join(lattice, filled, joining))
}

/// Cubes that the surface touches.
fn touched(surface: &Surface, lattice: &Lattice) -> Vec<bool> {
    let mut filled = vec![false; lattice.len()];
    let mut held = vec![false; surface.points.len()];
    for (t, corners) in surface.triangles.iter().enumerate() {
        lattice.mark(surface.corners(t), &mut filled);
        corners.iter().for_each(|i| held[*i as usize] = true);
    }
    // Points of slivers.
    for (p, _) in surface.points.iter().zip(held).filter(|(_, held)| !held) {
        filled[lattice.cell(*p)] = true;
    }
    filled
}

/// How many cubes of an edge the surface touches; nothing where the lattice would be too large.
pub(super) fn touched_cubes(surface: &Surface, edge: f64) -> Option<usize> {
    let lattice = Lattice::around(surface, edge).ok()?;
    Some(touched(surface, &lattice).into_iter().filter(|f| *f).count())
}

/// Adds the cubes that have their middle inside.
fn fill(surface: &Surface, lattice: &Lattice, mut filled: Vec<bool>) -> Vec<bool> {
    filled.par_iter_mut().enumerate().filter(|(_, f)| !**f).for_each(|(cell, f)| {
        *f = surface.winding(lattice.middle(lattice.place(cell))) > 0.5;
    });
    filled
}

/// The finest cage of no more than `most` nodes, of those that halving an interval of edges meets; `attempt` gives
/// nothing where there are more.
pub(super) fn halve<T>(
    surface: &Surface,
    most: usize,
    attempt: impl Fn(f64) -> Result<Option<T>, Error>,
) -> Result<T, Error> {
    let (low, high) = surface.bounds();
    let mut coarse = 1.01 * (high - low).max_element();
    let mut found = attempt(coarse)?;
    // Finer than any body needs: a line of this many nodes.
    #[expect(clippy::cast_precision_loss, reason = "an estimate")]
    let mut fine = surface.size / most as f64;
    for _ in 0..HALVINGS {
        let edge = libm::sqrt(coarse * fine);
        match attempt(edge)? {
            Some(better) => (coarse, found) = (edge, Some(better)),
            None => fine = edge,
        }
    }
    found.ok_or_else(|| {
        let problem = format!("no cage has {most} nodes or fewer");
        Error::unusable(&surface.name, "cage", problem, "ask for more")
    })
}

fn try_edge(surface: &Surface, edge: f64, most: usize) -> Option<(Lattice, Vec<bool>)> {
    let lattice = Lattice::around(surface, edge).ok()?;
    let filled = touched(surface, &lattice);
    // There are more corners than cubes.
    if filled.iter().filter(|f| **f).count() > most {
        return None;
    }
    let filled = fill(surface, &lattice, filled);
    let nodes = corners(&lattice, &filled).len();
    (nodes <= most).then_some((lattice, filled))
}

/// Corners of the cubes that are filled, by their number on a lattice with one more place along each axis, ascending.
fn corners(lattice: &Lattice, filled: &[bool]) -> Vec<usize> {
    let mut used: Vec<usize> =
        (0..filled.len()).filter(|c| filled[*c]).flat_map(|c| around(lattice, c)).collect();
    used.sort_unstable();
    used.dedup();
    used
}

/// Corners of a cube, by their number; bit 0 of the place is x, bit 1 y, bit 2 z.
fn around(lattice: &Lattice, cell: usize) -> [usize; 8] {
    let [x, y, z] = lattice.place(cell);
    let [nx, ny, _] = lattice.cells.map(|n| n + 1);
    core::array::from_fn(|bits| (x + (bits & 1)) + nx * ((y + (bits >> 1 & 1)) + ny * (z + (bits >> 2))))
}

/// Finds components, bridges them if that is asked for, and makes tetrahedra.
fn join(lattice: Lattice, mut filled: Vec<bool>, joining: Joining) -> Cage {
    let mut notes = Vec::new();
    let (mut component, mut components) = label(&lattice, &filled);
    if components > 1 && joining == Joining::Bridged {
        let added = bridge(&lattice, &mut filled, &component, components);
        notes.push(format!("{components} parts that touch nowhere are bridged by {added} cubes"));
        (component, components) = label(&lattice, &filled);
    } else if components > 1 {
        notes.push(format!("{components} parts touch nowhere and stay apart"));
    }
    build(&lattice, &filled, &component, components, notes)
}

/// No component.
const NONE: u32 = u32::MAX;

/// Component of each cube that is filled, joined by faces, in the order of their first cubes; and how many.
fn label(lattice: &Lattice, filled: &[bool]) -> (Vec<u32>, usize) {
    let mut component = vec![NONE; filled.len()];
    let mut count = 0;
    for start in 0..filled.len() {
        if !filled[start] || component[start] != NONE {
            continue;
        }
        component[start] = count;
        let mut open = vec![start];
        while let Some(cell) = open.pop() {
            for next in lattice.beside(cell).filter(|n| filled[*n]) {
                if component[next] == NONE {
                    component[next] = count;
                    open.push(next);
                }
            }
        }
        count += 1;
    }
    (component, count as usize)
}

/// Grows the first component through empty cubes to the nearest other one, fills the way, and so on.
fn bridge(lattice: &Lattice, filled: &mut [bool], component: &[u32], components: usize) -> usize {
    let mut joined = vec![false; components];
    joined[0] = true;
    let mut added = 0;
    for _ in 1..components {
        // Where each cube was reached from; itself at the start.
        let mut from = vec![usize::MAX; filled.len()];
        let whole = |c: &usize| component[*c] == NONE || joined[component[*c] as usize];
        let mut front: Vec<usize> = (0..filled.len()).filter(|c| filled[*c] && whole(c)).collect();
        front.iter().for_each(|c| from[*c] = *c);
        let mut met = None;
        while met.is_none() && !front.is_empty() {
            let mut next = Vec::new();
            for cell in front {
                for beside in lattice.beside(cell) {
                    if from[beside] == usize::MAX {
                        from[beside] = cell;
                        next.push(beside);
                        met = met.or_else(|| filled[beside].then_some(beside));
                    }
                }
            }
            front = next;
        }
        let Some(end) = met else { break };
        joined[component[end] as usize] = true;
        let mut cell = from[end];
        while from[cell] != cell {
            filled[cell] = true;
            added += 1;
            cell = from[cell];
        }
    }
    added
}

fn build(
    lattice: &Lattice,
    filled: &[bool],
    component: &[u32],
    components: usize,
    notes: Vec<String>,
) -> Cage {
    let used = corners(lattice, filled);
    let [nx, ny, _] = lattice.cells.map(|n| n + 1);
    let rest = used.iter().map(|i| lattice.point([i % nx, i / nx % ny, i / nx / ny])).collect();
    let mut cage = Cage {
        rest,
        edge: lattice.edge,
        component: vec![NONE; used.len()],
        components,
        notes,
        ..Cage::default()
    };
    let number = |corner: usize| u32::try_from(used.partition_point(|u| *u < corner)).unwrap_or(NONE);
    for cell in (0..filled.len()).filter(|c| filled[*c]) {
        let nodes = around(lattice, cell).map(number);
        cage.tets.extend(SIX.map(|tet| tet.map(|corner| nodes[corner])));
        for (corner, node) in nodes.iter().enumerate() {
            // A node that two components share belongs to the first.
            let of = &mut cage.component[*node as usize];
            *of = (*of).min(component[cell]);
            let along = [1, 2, 4].into_iter().filter(|bit| corner & bit == 0);
            cage.links.extend(along.map(|bit| [*node, nodes[corner | bit]]));
        }
    }
    cage.links.sort_unstable();
    cage.links.dedup();
    cage
}
