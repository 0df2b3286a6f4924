//! Tetrahedra inside the bone wrap, for bones to be embedded in: every node of theirs follows the skeleton.
//!
//! ```text
//! c = b + t (q − b)        q: the foot of the column on the bones, t = 0.9 and less where a tetrahedron would be flat
//! ```
//!
//! Between the bone wrap and these inner ends of the columns stands a third layer of prisms. Each is cut into three
//! tetrahedra, `c₀c₁c₂b₂`, `c₀c₁b₁b₂`, `c₀b₀b₁b₂` with the columns in ascending order, which cuts the side between two
//! prisms the same way from both (Dompierre et al. 1999). Around joints some are inside out however thin; they are
//! left out. So is the inside of the core: what is there is nearest to a face of it.

use super::bones::Bones;
use glam::DVec3;

/// Share of the way from the bone wrap to the bones.
const REACH: f64 = 0.9;
/// Halvings of it.
const HALVINGS: usize = 6;
/// Least volume of a tetrahedron, as a share of the volume of a regular one with its longest edge.
const LEAST: f64 = 1e-4;

/// Inner ends of all columns, and the tetrahedra that are left; inner ends are numbered from `first` on.
pub(super) fn tets(
    triangles: &[[u32; 3]],
    weights: &[Vec<(usize, f64)>],
    bones: &Bones,
    bone: &[DVec3],
    first: u32,
) -> (Vec<DVec3>, Vec<[u32; 4]>) {
    let feet: Vec<DVec3> = bone.iter().zip(weights).map(|(b, row)| bones.foot(*b, row).place).collect();
    let mut share = vec![REACH; bone.len()];
    let ends = |share: &[f64]| -> Vec<DVec3> {
        bone.iter().zip(&feet).zip(share).map(|((b, q), t)| *b + *t * (*q - *b)).collect()
    };
    let solid = |tet: &[u32; 4], core: &[DVec3]| {
        let place = |i: u32| if i < first { bone[i as usize] } else { core[(i - first) as usize] };
        is_solid(tet.map(place))
    };
    for _ in 0..HALVINGS {
        let core = ends(&share);
        let bad = |t: &&[u32; 3]| cut(**t, first).iter().any(|tet| !solid(tet, &core));
        let mut flat: Vec<u32> = triangles.iter().filter(bad).flatten().copied().collect();
        flat.sort_unstable();
        flat.dedup();
        flat.into_iter().for_each(|i| share[i as usize] *= 0.5);
    }
    let core = ends(&share);
    let kept = triangles.iter().flat_map(|t| cut(*t, first)).filter(|tet| solid(tet, &core)).collect();
    (core, kept)
}

/// The three tetrahedra below a triangle.
fn cut(triangle: [u32; 3], first: u32) -> [[u32; 4]; 3] {
    let mut sorted = triangle;
    sorted.sort_unstable();
    let [i, j, k] = sorted;
    let even = triangle == [i, j, k] || triangle == [j, k, i] || triangle == [k, i, j];
    let mut tets = [[i + first, j + first, k + first, k], [i + first, j, j + first, k], [i + first, i, j, k]];
    if !even {
        tets.iter_mut().for_each(|t| t.swap(1, 2));
    }
    tets
}

fn is_solid([a, b, c, d]: [DVec3; 4]) -> bool {
    let (u, v, w) = (b - a, c - a, d - a);
    let edges = [u, v, w, v - u, w - v, w - u];
    let longest = edges.iter().map(|e| e.length_squared()).fold(0.0, f64::max);
    // Six volumes of a regular tetrahedron of edge l are l³/√2.
    u.cross(v).dot(w) > LEAST * longest * libm::sqrt(longest) * core::f64::consts::FRAC_1_SQRT_2
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Both windings of a triangle, in all rotations: the three fill the prism below it.
    #[test]
    fn three_tetrahedra_fill_a_prism() {
        let outer = [DVec3::Z, DVec3::new(1.0, 0.0, 1.0), DVec3::new(0.0, 1.0, 1.0)];
        let numbers = [[0, 1, 2], [1, 2, 0], [2, 0, 1], [0, 2, 1], [2, 1, 0], [1, 0, 2]];
        for triangle in numbers {
            let mut places = [DVec3::ZERO; 6];
            for (place, i) in outer.iter().zip(triangle) {
                (places[i as usize], places[i as usize + 3]) = (*place, *place - DVec3::Z);
            }
            let volumes = cut(triangle, 3).map(|t| {
                let [a, b, c, d] = t.map(|i| places[i as usize]);
                (b - a).cross(c - a).dot(d - a) / 6.0
            });
            assert!(volumes.iter().all(|v| (v - 1.0 / 6.0).abs() < 1e-15), "{triangle:?}: {volumes:?}");
        }
    }
}
