//! Bodies to test with.

use glam::DVec3;
use sinew_bake::cage::SIX;
use sinew_bake::fem::element::Elements;
use sinew_bake::fem::material::Lame;

/// Nodes and tetrahedra of the voxels, `edge` wide, of a lattice of `n` that `kept` keeps.
pub(crate) fn voxels(n: [usize; 3], edge: f64, kept: impl Fn(DVec3) -> bool) -> (Vec<DVec3>, Vec<[u32; 4]>) {
    let [nx, ny, nz] = n;
    let mut number = vec![u32::MAX; (nx + 1) * (ny + 1) * (nz + 1)];
    let mut used = Vec::new();
    for i in 0..nx * ny * nz {
        let (x, y, z) = (i % nx, i / nx % ny, i / nx / ny);
        if kept(edge * (place(x, y, z) + DVec3::splat(0.5))) {
            let at = |b: usize| ((z + (b >> 2)) * (ny + 1) + y + (b >> 1 & 1)) * (nx + 1) + x + (b & 1);
            used.push([0, 1, 2, 3, 4, 5, 6, 7].map(at));
        }
    }
    used.iter().flatten().for_each(|node| number[*node] = 0);
    let mut rest = Vec::new();
    for (x, number) in lattice(n).into_iter().zip(&mut number).filter(|(_, n)| **n == 0) {
        *number = u32::try_from(rest.len()).expect("few");
        rest.push(edge * x);
    }
    let tets = used.iter().flat_map(|v| SIX.map(|tet| tet.map(|c| number[v[c]]))).collect();
    (rest, tets)
}

/// Corners of all voxels of a lattice, x first.
fn lattice([nx, ny, nz]: [usize; 3]) -> Vec<DVec3> {
    let all = 0..(nx + 1) * (ny + 1) * (nz + 1);
    all.map(|i| place(i % (nx + 1), i / (nx + 1) % (ny + 1), i / (nx + 1) / (ny + 1))).collect()
}

fn place(x: usize, y: usize, z: usize) -> DVec3 {
    DVec3::new(x as f64, y as f64, z as f64)
}

/// A block of `n` voxels.
pub(crate) fn block(n: [usize; 3], edge: f64) -> (Vec<DVec3>, Elements<4>) {
    let (rest, tets) = voxels(n, edge, |_| true);
    let tets = Elements::tets(&rest, tets).expect("tetrahedra");
    (rest, tets)
}

/// The same of prisms: two a voxel, standing on the xz plane.
pub(crate) fn prism_block([nx, ny, nz]: [usize; 3], edge: f64) -> (Vec<DVec3>, Elements<6>) {
    let at = |x: usize, y: usize, z: usize| u32::try_from((z * (ny + 1) + y) * (nx + 1) + x).expect("few");
    let rest: Vec<DVec3> = lattice([nx, ny, nz]).into_iter().map(|x| edge * x).collect();
    let mut prisms = Vec::new();
    for i in 0..nx * ny * nz {
        let (x, y, z) = (i % nx, i / nx % ny, i / nx / ny);
        for [a, b, c] in [[(0, 0), (0, 1), (1, 1)], [(0, 0), (1, 1), (1, 0)]] {
            let side = |y: usize| [a, b, c].map(|(dx, dz)| at(x + dx, y, z + dz));
            let ([a, b, c], [d, e, f]) = (side(y), side(y + 1));
            prisms.push([a, b, c, d, e, f]);
        }
    }
    let prisms = Elements::prisms(&rest, prisms).expect("prisms");
    (rest, prisms)
}

/// Nodes that `of` is true for.
pub(crate) fn nodes(rest: &[DVec3], of: impl Fn(DVec3) -> bool) -> Vec<u32> {
    (0..).zip(rest).filter(|(_, x)| of(**x)).map(|(i, _)| i).collect()
}

/// Fat.
pub(crate) fn fat() -> Lame {
    Lame::new(15_000.0, 0.47).expect("a material")
}

/// Numbers from -1 to 1, the same on every run.
pub(crate) fn noise(seed: u64) -> impl FnMut() -> f64 {
    let mut state = seed;
    move || {
        state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = state;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        (z ^ (z >> 31)) as f64 / (1_u64 << 63) as f64 - 1.0
    }
}
