//! Simulation cages: tetrahedra around a character, with all that a simulation in them needs.
//!
//! ```text
//! Model ─▶ surface ─▶ winding (inside?) ─▶ voxel | stuffing ─▶ Cage ─┬─▶ embed    (surface in tetrahedra)
//!             └────────────────────────────────────────────────────┼─▶ weights  (skin weights of nodes)  ├─▶ Body
//!                                                                  └─▶ skeleton (what follows the bones) ┘
//! ```
//!
//! Lengths are in the file's units (metres), places in model space, in the rest pose.

mod body;
pub mod embed;
mod harmonic;
mod lattice;
pub mod layers;
mod orient;
pub mod skeleton;
pub mod stuffing;
pub mod surface;
mod tree;
pub mod voxel;
pub mod weights;
mod winding;

use glam::DVec3;

pub use body::{Body, Options, Shape};
pub use stuffing::stuffed;
pub use surface::{STRAY, Surface};
pub use voxel::{Joining, Resolution, SIX, voxels};

/// Tetrahedra around a surface.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Cage {
    /// Nodes at rest, m.
    pub rest: Vec<DVec3>,
    /// Nodes of each tetrahedron, the fourth on the side that the first three turn to by the right hand.
    pub tets: Vec<[u32; 4]>,
    /// Edge of the lattice, m.
    pub edge: f64,
    /// Pairs of nodes that are neighbors, along the axes of a lattice of cubes or along all edges of fitted
    /// tetrahedra; the smaller first, ascending.
    pub links: Vec<[u32; 2]>,
    /// Component of each node. Components do not touch by as much as a face.
    pub component: Vec<u32>,
    /// How many there are.
    pub components: usize,
    /// What a person may want to know, a sentence each.
    pub notes: Vec<String>,
}

impl Cage {
    /// Six times the signed volume of a tetrahedron, m³.
    fn volume6(&self, [a, b, c, d]: [u32; 4]) -> f64 {
        let [a, b, c, d] = [a, b, c, d].map(|i| self.rest[i as usize]);
        (b - a).cross(c - a).dot(d - a)
    }

    /// Volume of all tetrahedra, m³.
    #[must_use]
    pub fn volume(&self) -> f64 {
        self.tets.iter().map(|t| self.volume6(*t)).sum::<f64>() / 6.0
    }

    /// Sets links to all edges of tetrahedra, and components by the faces they share.
    fn connect(&mut self) {
        for [a, b, c, d] in &self.tets {
            let edges = [[a, b], [a, c], [a, d], [b, c], [b, d], [c, d]];
            self.links.extend(edges.map(|[i, j]| [*i.min(j), *i.max(j)]));
        }
        self.links.sort_unstable();
        self.links.dedup();
        let mut faces: Vec<([u32; 3], usize)> = Vec::with_capacity(4 * self.tets.len());
        for (t, [a, b, c, d]) in self.tets.iter().enumerate() {
            for mut face in [[*b, *c, *d], [*a, *c, *d], [*a, *b, *d], [*a, *b, *c]] {
                face.sort_unstable();
                faces.push((face, t));
            }
        }
        faces.sort_unstable();
        let mut beside = vec![Vec::new(); self.tets.len()];
        for pair in faces.windows(2).filter(|pair| pair[0].0 == pair[1].0) {
            beside[pair[0].1].push(pair[1].1);
            beside[pair[1].1].push(pair[0].1);
        }
        self.component = vec![u32::MAX; self.rest.len()];
        let mut seen = vec![false; self.tets.len()];
        for start in 0..self.tets.len() {
            if seen[start] {
                continue;
            }
            seen[start] = true;
            let number = u32::try_from(self.components).unwrap_or(u32::MAX);
            let mut open = vec![start];
            while let Some(t) = open.pop() {
                for i in self.tets[t] {
                    let of = &mut self.component[i as usize];
                    *of = (*of).min(number);
                }
                open.extend(beside[t].iter().filter(|b| !core::mem::replace(&mut seen[**b], true)));
            }
            self.components += 1;
        }
        if self.components > 1 {
            self.notes.push(format!("{} parts touch nowhere and stay apart", self.components));
        }
    }

    /// Triangles that belong to one of the given tetrahedra only, seen from outside against the clock, in their order.
    #[must_use]
    pub fn boundary(&self, tets: &[[u32; 4]]) -> Vec<[u32; 3]> {
        let faces = |[a, b, c, d]: &[u32; 4]| [[*b, *c, *d], [*a, *d, *c], [*a, *b, *d], [*a, *c, *b]];
        let mut all: Vec<([u32; 3], usize, [u32; 3])> = Vec::with_capacity(4 * tets.len());
        for face in tets.iter().flat_map(faces) {
            let mut key = face;
            key.sort_unstable();
            all.push((key, all.len(), face));
        }
        all.sort_unstable();
        let alone = all.chunk_by(|a, b| a.0 == b.0).filter(|same| same.len() == 1);
        let mut alone: Vec<_> = alone.map(|same| (same[0].1, same[0].2)).collect();
        alone.sort_unstable();
        alone.into_iter().map(|(_, face)| face).collect()
    }
}
