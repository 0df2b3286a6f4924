//! Linear blend skinning.
//!
//! ```text
//! x = B·p,   n = cof(B₃ₓ₃)·n₀ / |…|,   cof(B) = det(B)·B⁻ᵀ
//! ```
//!
//! Point by point, as it is defined; or, where there are vector registers, in blocks with a lane a point.

pub use super::blend::{BLOCK, Influences, LinearBlock, Rows, Vectors};
use super::blend::{blend, blend_block, dominant_map, linear_of};
use super::cofactor::{Cofactors, Linear};
use super::copy::copy;
use crate::dispatch::{self, Level};
use crate::lanes::block::{GROUPS, filled, four, put, read, write};
use crate::lanes::{Number, VECTORS, three};
use crate::math::float::{max, sqrt};
use crate::math::vec3;

/// The vector of a lane.
#[inline(always)]
pub(crate) fn vector_of(v: &Vectors, lane: usize) -> [f32; 3] {
    three(|r| v[r][lane])
}

/// The linear map of a lane.
#[inline(always)]
pub(crate) fn map_of(columns: &LinearBlock, lane: usize) -> Linear {
    three(|c| vector_of(&columns[c], lane))
}

/// `M·p + t`.
#[inline(always)]
fn apply<T: Number>([a, b, c]: &[[T; 3]; 3], t: [T; 3], [x, y, z]: [T; 3]) -> [T; 3] {
    three(|r| (a[r] * x + b[r] * y) + (c[r] * z + t[r]))
}

/// Skins points and keeps the linear parts of their blended maps.
///
/// * `palette`: a map a joint.
/// * `influences`, `rest` (bind space), `out` (model space): one a point; the shorter decides how many.
/// * `linear`: one a block of points.
pub fn skin(
    palette: &[Rows],
    influences: Influences<'_>,
    rest: &[[f32; 3]],
    out: &mut [[f32; 3]],
    linear: &mut [LinearBlock],
) {
    skin_at(dispatch::widest(), palette, influences, rest, out, linear);
}

/// [`skin`] on some registers.
fn skin_at(
    level: Level,
    palette: &[Rows],
    influences: Influences<'_>,
    rest: &[[f32; 3]],
    out: &mut [[f32; 3]],
    linear: &mut [LinearBlock],
) {
    if !VECTORS {
        return skin_each(palette, influences, rest, out, linear);
    }
    skin_blocks_at(level, palette, influences, rest, out, linear);
    let n = rest.len().min(out.len()).min(linear.len() * BLOCK);
    let whole = n / BLOCK * BLOCK;
    if whole < n {
        let mut last = [[0.0; 3]; BLOCK];
        let (influences, linear) = (influences.after(whole), &mut linear[whole / BLOCK..]);
        skin_blocks_at(level, palette, influences, &filled(&rest[whole..n]), &mut last, linear);
        copy(&last, &mut out[whole..n]);
    }
}

/// The definition of [`skin`].
fn skin_each(
    palette: &[Rows],
    influences: Influences<'_>,
    rest: &[[f32; 3]],
    out: &mut [[f32; 3]],
    linear: &mut [LinearBlock],
) {
    let blocks = rest.chunks(BLOCK).zip(out.chunks_mut(BLOCK)).zip(linear);
    for (start, ((rest, out), linear)) in (0..).step_by(BLOCK).zip(blocks) {
        for (lane, (rest, out)) in (0..BLOCK).zip(rest.iter().zip(out)) {
            let b = blend(palette, &influences, start + lane);
            let m = linear_of(&b);
            *out = apply(&m, b.map(|row| row[3]), *rest);
            for c in 0..3 {
                (linear[c][0][lane], linear[c][1][lane], linear[c][2][lane]) = m[c].into();
            }
        }
    }
}

dispatch::copies!(skin_blocks_at, skin_blocks, (
    palette: &[Rows], influences: Influences<'_>, rest: &[[f32; 3]], out: &mut [[f32; 3]], linear: &mut [LinearBlock],
));

/// [`skin`] of whole blocks.
#[inline(always)]
fn skin_blocks(
    palette: &[Rows],
    influences: Influences<'_>,
    rest: &[[f32; 3]],
    out: &mut [[f32; 3]],
    linear: &mut [LinearBlock],
) {
    let points = rest.as_chunks().0.iter().zip(out.as_chunks_mut().0).zip(linear);
    for (start, ((rest, out), linear)) in (0..).step_by(BLOCK).zip(points) {
        let (mut t, [a, b, c]) = ([[0.0; BLOCK]; 3], &mut *linear);
        blend_block(palette, &influences, |lane| start + lane, [a, b, c, &mut t]);
        let mut p = read(rest);
        // Four points in a register each: of one loop over all lanes no vector instructions come in WebAssembly.
        for group in 0..GROUPS {
            let m = three(|c| four(&linear[c], group));
            let moved = apply(&m, four(&t, group), four(&p, group));
            put(&mut p, group, moved);
        }
        write(&p, out);
    }
}

/// Skins the vertices of a surface with their normals; vertex `v` has the influences of point `point_of_vertex[v]`.
///
/// `positions` and `normals` go in in bind space and come out in model space; the shortest slice decides how many.
/// A blended map that flattens a normal counts as the dominant joint's; one without a direction then too stays.
pub fn skin_surface(
    palette: &[Rows],
    influences: Influences<'_>,
    point_of_vertex: &[u32],
    positions: &mut [[f32; 3]],
    normals: &mut [[f32; 3]],
) {
    // |cof(B)·n|² is of the order of the fourth power of the columns.
    let least = 1e-12 * longest_square(palette) * longest_square(palette);
    surface_at(dispatch::widest(), palette, influences, point_of_vertex, least, positions, normals);
}

/// [`skin_surface`] on some registers: normals whose square would not be above `least` follow the dominant joint.
fn surface_at(
    level: Level,
    palette: &[Rows],
    influences: Influences<'_>,
    points: &[u32],
    least: f32,
    positions: &mut [[f32; 3]],
    normals: &mut [[f32; 3]],
) {
    if !VECTORS {
        return surface_each(palette, influences, points, least, positions, normals);
    }
    let n = points.len().min(positions.len()).min(normals.len());
    let (points, positions, normals) = (&points[..n], &mut positions[..n], &mut normals[..n]);
    surface_blocks_at(level, palette, influences, points, least, positions, normals);
    let whole = n / BLOCK * BLOCK;
    if whole < n {
        let (positions, normals) = (&mut positions[whole..], &mut normals[whole..]);
        let (mut p, mut v) = (filled(positions), filled(normals));
        surface_blocks_at(level, palette, influences, &filled(&points[whole..]), least, &mut p, &mut v);
        copy(&p, positions);
        copy(&v, normals);
    }
}

/// The definition of [`skin_surface`].
fn surface_each(
    palette: &[Rows],
    influences: Influences<'_>,
    points: &[u32],
    least: f32,
    positions: &mut [[f32; 3]],
    normals: &mut [[f32; 3]],
) {
    for (point, (position, normal)) in points.iter().zip(positions.iter_mut().zip(normals)) {
        let b = blend(palette, &influences, *point as usize);
        let m = linear_of(&b);
        *position = apply(&m, b.map(|row| row[3]), *position);
        let (turned, usable) = turn_normal(&m, *normal, least);
        *normal = turned;
        if !usable {
            *normal = turn_normal(&dominant_map(palette, &influences, *point as usize), turned, 0.0).0;
        }
    }
}

dispatch::copies!(surface_blocks_at, surface_blocks, (
    palette: &[Rows], influences: Influences<'_>, points: &[u32], least: f32, positions: &mut [[f32; 3]],
    normals: &mut [[f32; 3]],
));

/// [`skin_surface`] of whole blocks.
#[inline(always)]
fn surface_blocks(
    palette: &[Rows],
    influences: Influences<'_>,
    points: &[u32],
    least: f32,
    positions: &mut [[f32; 3]],
    normals: &mut [[f32; 3]],
) {
    let (mut linear, mut t) = ([[[0.0; BLOCK]; 3]; 3], [[0.0; BLOCK]; 3]);
    let surface = positions.as_chunks_mut().0.iter_mut().zip(normals.as_chunks_mut().0);
    for (points, (positions, normals)) in points.as_chunks::<BLOCK>().0.iter().zip(surface) {
        let point = |lane: usize| points[lane] as usize;
        let [a, b, c] = &mut linear;
        blend_block(palette, &influences, point, [a, b, c, &mut t]);
        let (mut p, mut n, mut usable) = (read(positions), read(normals), [true; BLOCK]);
        for lane in 0..BLOCK {
            let m = map_of(&linear, lane);
            let moved = apply(&m, vector_of(&t, lane), vector_of(&p, lane));
            let (turned, fine) = turn_normal(&m, vector_of(&n, lane), least);
            (p[0][lane], p[1][lane], p[2][lane]) = moved.into();
            (n[0][lane], n[1][lane], n[2][lane]) = turned.into();
            usable[lane] = fine;
        }
        write(&p, positions);
        write(&n, normals);
        if usable != [true; BLOCK] {
            for ((lane, normal), _) in (0..).zip(normals).zip(usable).filter(|(_, usable)| !usable) {
                let m = dominant_map(palette, &influences, point(lane));
                *normal = turn_normal(&m, *normal, 0.0).0;
            }
        }
    }
}

/// Square of the longest column of the linear parts.
fn longest_square(palette: &[Rows]) -> f32 {
    let columns = palette.iter().flat_map(linear_of);
    columns.fold(0.0, |longest, c| max(longest, vec3::dot(c, c)))
}

/// A normal turned, and whether it is usable: finite, and its square above `least`. Otherwise it stays.
#[inline(always)]
fn turn_normal(m: &Linear, n: [f32; 3], least: f32) -> ([f32; 3], bool) {
    let cofactors = Cofactors::new(m);
    let turned = cofactors.turn(n);
    let square = vec3::dot(turned, turned);
    let sign = if cofactors.determinant < 0.0 { -1.0 } else { 1.0 };
    let (scale, usable) = (sign / sqrt(square), (least < square) & (square < f32::INFINITY));
    (three(|k| if usable { turned[k] * scale } else { n[k] }), usable)
}

#[cfg(test)]
mod tests {
    extern crate std;
    use super::*;
    use crate::math::affine::{self, to_rows};
    use crate::math::quat;
    use std::vec;
    use std::vec::Vec;

    fn turn(angle: f32) -> [f32; 4] {
        let (s, c) = crate::math::trig::sin_cos(0.5 * angle);
        [0.0, s, 0.0, c]
    }

    #[test]
    fn a_rigid_joint_moves_points_rigidly() {
        let m = affine::from_trs([1.0, -2.0, 0.5], turn(0.8), [1.0; 3]);
        let influences = Influences { sets: 1, joints: &[[0; 4]], weights: &[[1.0, 0.0, 0.0, 0.0]] };
        let (mut out, mut linear) = ([[0.0; 3]], [[[[0.0; BLOCK]; 3]; 3]]);
        skin(&[to_rows(&m)], influences, &[[0.3, 0.2, -0.1]], &mut out, &mut linear);
        assert_eq!(out[0], affine::transform(&m, [0.3, 0.2, -0.1]));
        assert_eq!(linear[0].map(|c| c.map(|lanes| lanes[0])), [m[0], m[1], m[2]]);
    }

    #[test]
    fn normals_follow_the_inverse_transpose_and_mirrors() {
        let influences = Influences { sets: 1, joints: &[[0; 4]], weights: &[[1.0, 0.0, 0.0, 0.0]] };
        for (scale, want) in [([2.0, 1.0, 1.0], [1.0, 2.0]), ([-2.0, 1.0, 1.0], [-1.0, 2.0])] {
            let m = affine::from_trs([0.0; 3], quat::IDENTITY, scale);
            let (mut p, mut n) = ([[0.0; 3]], [vec3::normalize_or([1.0, 1.0, 0.0], [0.0; 3])]);
            skin_surface(&[to_rows(&m)], influences, &[0], &mut p, &mut n);
            let want = vec3::normalize_or([want[0], want[1], 0.0], [0.0; 3]);
            assert!(vec3::dot(n[0], want) > 1.0 - 1e-6, "{:?} {want:?}", n[0]);
        }
    }

    #[test]
    fn a_flattened_blend_falls_back_to_the_dominant_joint() {
        // Half a turn apart: the blend collapses the plane to a line.
        let half = affine::from_trs([0.0; 3], turn(core::f32::consts::PI), [1.0; 3]);
        let palette = [to_rows(&affine::IDENTITY), to_rows(&half)];
        let influences = Influences { sets: 1, joints: &[[0, 1, 0, 0]], weights: &[[0.5, 0.5, 0.0, 0.0]] };
        let (mut p, mut n) = ([[1.0, 0.0, 0.0]], [[1.0, 0.0, 0.0]]);
        skin_surface(&palette, influences, &[0], &mut p, &mut n);
        assert_eq!(n[0], [1.0, 0.0, 0.0]);
    }

    /// Skins vertices in place: points, positions, normals.
    type Skin<'a> = &'a dyn Fn(&[u32], &mut [[f32; 3]], &mut [[f32; 3]]);

    /// A vertex has the same bits in a block, in the tail and alone, in each copy that this machine can run and as
    /// defined, beside a flattened blend too.
    #[test]
    fn a_vertex_does_not_depend_on_its_place() {
        let turned =
            |i: u8| affine::from_trs([f32::from(i), 0.1, -0.2], turn(0.7 * f32::from(i)), [1.0, 1.3, -0.8]);
        let mut palette: Vec<Rows> = (0..5).map(|i| to_rows(&turned(i))).collect();
        palette.push([[0.0; 4]; 3]);
        let n = 67_u16;
        let joints: Vec<[u16; 4]> = (0..2 * n).map(|i| [0, 3, 2, 4].map(|k| (k + i * 7) % 6)).collect();
        let row = |i: u16| match i % 6 {
            5 => [[1.0, 0.0, 0.0, 0.0], [0.0; 4]],
            4 => [[0.4, 0.2, 0.1, 0.1], [0.1, 0.1, 0.0, 0.0]],
            _ => [[0.6, 0.4, 0.0, 0.0], [0.0; 4]],
        };
        let weights: Vec<[f32; 4]> = (0..n).flat_map(row).collect();
        let influences = Influences { sets: 2, joints: &joints, weights: &weights };
        let rest: Vec<[f32; 3]> = (0..n).map(|i| [0.3, -0.02 * f32::from(i), 0.9]).collect();
        let run = |points: &[u32], kernel: Skin<'_>| {
            let mut p: Vec<[f32; 3]> = points.iter().map(|i| rest[*i as usize]).collect();
            let mut n: Vec<[f32; 3]> = p.iter().map(|p| vec3::normalize_or(*p, [0.0; 3])).collect();
            kernel(points, &mut p, &mut n);
            p.into_iter().zip(n).map(|vertex| <[_; 2]>::from(vertex).map(|v| v.map(f32::to_bits)))
        };
        let least = 1e-12 * longest_square(&palette) * longest_square(&palette);
        let all: Vec<u32> = (0..u32::from(n)).collect();
        let alone = |vertex: &u32| {
            run(&[*vertex], &|v, p, n| surface_each(&palette, influences, v, least, p, n)).next()
        };
        let want: Vec<_> = all.iter().filter_map(alone).collect();
        // An interpreter takes its time.
        for count in (0..all.len()).step_by(if cfg!(miri) { 13 } else { 1 }) {
            let from = all.len() - count;
            for level in dispatch::levels() {
                let found: Vec<_> = run(&all[from..], &|v, p, n| {
                    surface_at(level, &palette, influences, v, least, p, n);
                })
                .collect();
                assert_eq!(found, want[from..], "{level:?}: {count} vertices");
                let (mut out, mut linear) = (vec![[9.0; 3]; count], vec![[[[0.0; BLOCK]; 3]; 3]; 3]);
                skin_at(level, &palette, influences, &rest[..count], &mut out, &mut linear);
                let (mut each, mut maps) = (out.clone(), linear.clone());
                skin_each(&palette, influences, &rest[..count], &mut each, &mut maps);
                let lanes = |maps: &[LinearBlock], i: usize| map_of(&maps[i / BLOCK], i % BLOCK);
                assert_eq!(each, out, "{level:?}: {count} points");
                (0..count).for_each(|i| assert_eq!(lanes(&maps, i), lanes(&linear, i), "{level:?}: map {i}"));
                let bits: Vec<_> = out.iter().map(|p| p.map(f32::to_bits)).collect();
                let first: Vec<_> = want.iter().take(count).map(|[p, _]| *p).collect();
                assert_eq!(bits, first, "{level:?}: {count} points");
            }
        }
    }
}
