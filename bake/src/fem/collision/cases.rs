//! Pairs in every position to each other, and what derivatives and distances are checked against.

use super::advance::advance;
use super::distance::Nearest;
use super::mollifier;
use super::pair::{Kind, Pair, Touch};
use crate::fem::blocks::Blocks;
use glam::DVec3;
use nalgebra::SMatrix;

type Matrix = SMatrix<f64, 12, 12>;

/// Numbers from -1 to 1 of a linear congruential generator.
fn random() -> impl FnMut() -> f64 {
    let mut state = 1_u32;
    move || {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        f64::from(state >> 8) / f64::from(1 << 23) - 1.0
    }
}

fn pair(kind: Kind) -> Pair {
    Pair { points: [0, 1, 2, 3], kind, reach: 8.0, area: 0.3 }
}

/// Corners and what they are: of both kinds, near, far and random; edges crossing at all angles down to nearly none.
fn cases() -> Vec<(String, Pair, [DVec3; 4])> {
    let p = |x, y, z| DVec3::new(x, y, z);
    let triangle = [p(0.0, 0.0, 0.0), p(1.0, 0.1, 0.0), p(0.2, 0.9, 0.1)];
    let mut out = Vec::new();
    let mut add = |name: String, kind, corners| out.push((name, pair(kind), corners));
    for (name, at) in [
        ("inside", p(0.4, 0.3, 0.2)),
        ("inside, near", p(0.4, 0.3, 0.06)),
        ("edge", p(0.5, -0.3, 0.2)),
        ("other edge", p(1.0, 1.0, -0.2)),
        ("corner", p(-0.4, -0.3, 0.1)),
        ("other corner", p(0.2, 1.5, 0.4)),
    ] {
        add(format!("point, {name}"), Kind::PointTriangle, [at, triangle[0], triangle[1], triangle[2]]);
    }
    let sliver = [p(0.3, 0.1, 0.4), p(0.0, 0.0, 0.0), p(1.0, 0.0, 0.0), p(0.4, 1e-5, 0.0)];
    add("point, sliver".into(), Kind::PointTriangle, sliver);
    let edges = |angle: f64, along: f64| {
        let e = p(libm::cos(angle), libm::sin(angle), 0.03);
        let middle = p(along, 0.0, 0.3);
        [p(-1.0, 0.0, 0.0), p(1.0, 0.0, 0.0), middle - 0.8 * e, middle + e]
    };
    for angle in [1.5, 0.3, 0.05, 0.02, 0.005, 3.12] {
        for along in [0.1, 1.9, 5.0] {
            let parallel = mollifier::limit(edges(1.0, along));
            add(format!("edges, {angle} {along}"), Kind::EdgeEdge { parallel }, edges(angle, along));
        }
    }
    let mut random = random();
    for k in 0..60 {
        let corners = [0; 4].map(|_| p(random(), random(), random()));
        let parallel = mollifier::limit(corners) * if k % 3 == 0 { 3000.0 } else { 1.0 };
        let kind = if k % 2 == 0 { Kind::PointTriangle } else { Kind::EdgeEdge { parallel } };
        add(format!("random {k}"), kind, corners);
    }
    out
}

fn full(h: &Blocks<4>) -> Matrix {
    Matrix::from_fn(|r, c| {
        let (i, j) = (r / 3, c / 3);
        if i >= j { h[i][j].col(c % 3)[r % 3] } else { h[j][i].col(r % 3)[c % 3] }
    })
}

fn touch(pair: &Pair, corners: [DVec3; 4]) -> Touch<'_> {
    Touch::new(pair, corners, 2.0).expect("within reach")
}

fn moved(corners: &[DVec3; 4], k: usize, by: f64) -> [DVec3; 4] {
    let mut corners = *corners;
    corners[k / 3][k % 3] += by;
    corners
}

/// The nearest of all points on a grid is not nearer than what was found, and not farther by more than the grid is coarse.
#[test]
fn nothing_is_nearer() {
    const N: u32 = 200;
    for (name, pair, x) in cases() {
        let found = libm::sqrt(pair.nearest(x).squared());
        let mut least = f64::INFINITY;
        for i in 0..=N {
            for j in 0..=N {
                let (u, v) = (f64::from(i) / f64::from(N), f64::from(j) / f64::from(N));
                let between = match pair.kind {
                    Kind::PointTriangle if i + j > N => continue,
                    Kind::PointTriangle => x[0] - x[1] - u * (x[2] - x[1]) - v * (x[3] - x[1]),
                    Kind::EdgeEdge { .. } => x[0] + u * (x[1] - x[0]) - x[2] - v * (x[3] - x[2]),
                };
                least = least.min(between.length());
            }
        }
        // Half a cell of the grid along each of two edges of at most 2√3.
        let coarse = 2.0 * libm::sqrt(3.0) / f64::from(N);
        assert!(found <= least * (1.0 + 1e-12) && least <= found + coarse, "{name}: {found} {least}");
    }
}

/// Central differences are off by a sixth of the square of the step times the third derivative, and by rounding over the step:
/// below 1e-6 of the size of the next derivative.
#[test]
fn slopes_are_differences() {
    let mut mollified = 0;
    for (name, pair, x) in cases() {
        let at = touch(&pair, x);
        let (slopes, h) = (at.slopes(), full(&at.hessian(false)));
        let size = h.amax();
        // Where edges are nearly parallel everything changes within their distance from it.
        let parallel = matches!(pair.kind, Kind::EdgeEdge { .. })
            && (x[1] - x[0]).cross(x[3] - x[2]).length() < 0.1 * x[0].distance(x[1]) * x[2].distance(x[3]);
        mollified += usize::from(parallel);
        let step = if parallel || name.contains("sliver") { 1e-7 } else { 1e-5 };
        for k in 0..12 {
            let (up, down) = (touch(&pair, moved(&x, k, step)), touch(&pair, moved(&x, k, -step)));
            let slope = (up.energy() - down.energy()) / (2.0 * step);
            let found = slopes[k / 3][k % 3];
            assert!((found - slope).abs() < 1e-6 * size, "{name}: slope {k}: {found} {slope}");
            for l in 0..12 {
                let slope = (up.slopes()[l / 3][l % 3] - down.slopes()[l / 3][l % 3]) / (2.0 * step);
                assert!((h[(l, k)] - slope).abs() < 1e-6 * size, "{name}: H {l} {k}: {} {slope}", h[(l, k)]);
            }
        }
    }
    assert!(mollified > 5, "only {mollified} nearly parallel");
}

/// Projected, the matrix has no negative eigenvalue, and less the true one it has none either.
#[test]
fn projected_hessians_are_above() {
    let mut negative = 0;
    for (name, pair, x) in cases() {
        let at = touch(&pair, x);
        let (exact, projected) = (full(&at.hessian(false)), full(&at.hessian(true)));
        let least = |m: Matrix| m.symmetric_eigenvalues().min();
        let rounding = 1e-12 * projected.amax();
        assert!(least(projected) > -rounding, "{name}: {}", least(projected));
        assert!(least(projected - exact) > -rounding, "{name}: {} below", least(projected - exact));
        negative += usize::from(least(exact) < -rounding);
    }
    assert!(negative > 50, "only {negative} had a negative eigenvalue");
}

/// Moved and turned as one there is no force and no torque.
#[test]
fn pairs_push_against_themselves_alone() {
    for (name, pair, x) in cases() {
        let slopes = touch(&pair, x).slopes();
        let size = slopes.iter().map(|s| s.length()).fold(0.0, f64::max);
        let (force, torque) =
            (slopes.iter().sum::<DVec3>(), (0..4).map(|i| x[i].cross(slopes[i])).sum::<DVec3>());
        assert!(force.length() < 1e-12 * size && torque.length() < 1e-10 * size, "{name}: {force} {torque}");
    }
}

/// What has no length or no area has a distance all the same, and nothing of it is not a number.
#[test]
fn degenerate_parts_are_finite() {
    let p = |x, y, z| DVec3::new(x, y, z);
    let a = p(0.1, 0.2, 0.3);
    let line = [p(0.0, 1.0, 0.0), p(-1.0, 0.0, 0.0), p(0.0, 0.0, 0.0), p(1.0, 0.0, 0.0)];
    let point = [p(0.0, 1.0, 0.0), a, a, a];
    let parallel = [p(-1.0, 0.0, 0.0), p(1.0, 0.0, 0.0), p(-0.5, 1.0, 0.0), p(0.5, 1.0, 0.0)];
    let short = [a, a, p(-0.5, 1.0, 0.0), p(0.5, 1.0, 0.0)];
    let edges = Kind::EdgeEdge { parallel: 1e-3 };
    for (x, kind, d) in [
        (line, Kind::PointTriangle, 1.0),
        (point, Kind::PointTriangle, a.distance(point[0])),
        (parallel, edges, 1.0),
        (parallel, Kind::PointTriangle, 2.0 / libm::sqrt(3.25)),
        (short, edges, libm::sqrt(0.73)),
    ] {
        let pair = pair(kind);
        let at = touch(&pair, x);
        let h = [full(&at.hessian(false)), full(&at.hessian(true))];
        assert!(at.energy().is_finite() && at.slopes().iter().all(|s| s.is_finite()), "{x:?}");
        assert!(h.iter().all(|h| h.iter().all(|x| x.is_finite())), "{x:?}");
        let found = libm::sqrt(pair.nearest(x).squared());
        assert!((found - d).abs() < 1e-14, "{x:?}: {found} {d}");
    }
    assert!(Nearest::edge_edge([a; 4]).squared() == 0.0, "a point from itself");
}

/// A step is cut before what it meets, by little, and not where it passes by.
#[test]
fn steps_end_before_they_touch() {
    let mut random = random();
    let mut met = 0;
    for (name, mut pair, x) in cases() {
        pair.reach = 1e-3;
        for _ in 0..20 {
            let p = [0; 4].map(|_| 3.0 * DVec3::new(random(), random(), random()));
            let t = advance(&pair, x, p);
            let distance = |t: f64| {
                let at = [0, 1, 2, 3].map(|i| x[i] + t * p[i]);
                libm::sqrt(pair.nearest(at).squared())
            };
            // A fine walk over all of it: what moves by at most 6√3 comes nearer by no more in a stride.
            let walk = (0..=2000).map(|k| t * f64::from(k) / 2000.0);
            let least = walk.map(distance).fold(f64::INFINITY, f64::min);
            assert!(least > 0.0, "{name}: met at {t}");
            met += usize::from(t < 1.0);
            // What stopped it is near: within the gap and a stride.
            assert!(t >= 1.0 || distance(t) < 2e-3, "{name}: {t}, {}", distance(t));
        }
    }
    println!("met {met}");
    assert!(met > 20, "only {met} met");
}

/// Head on, at any speed, through the middle of a triangle and of an edge, and along an edge that is parallel.
#[test]
fn nothing_is_too_fast() {
    let p = |x, y, z| DVec3::new(x, y, z);
    let point = [p(0.2, 0.2, 1.0), p(0.0, 0.0, 0.0), p(1.0, 0.0, 0.0), p(0.0, 1.0, 0.0)];
    let edges = [p(-1.0, 0.0, 1.0), p(1.0, 0.0, 1.0), p(0.0, -1.0, 0.0), p(0.0, 1.0, 0.0)];
    let parallel = [p(-1.0, 0.0, 1.0), p(1.0, 0.0, 1.0), p(-1.0, 0.0, 0.0), p(1.0, 0.0, 0.0)];
    for (x, kind, first) in [
        (point, Kind::PointTriangle, 1),
        (edges, Kind::EdgeEdge { parallel: 1e-3 }, 2),
        (parallel, Kind::EdgeEdge { parallel: 1e-3 }, 2),
    ] {
        for speed in [0.5, 2.0, 1e3, 1e9] {
            let down = [0, 1, 2, 3].map(|i| if i < first { p(0.0, 0.0, -speed) } else { DVec3::ZERO });
            let pair = Pair { reach: 0.01, ..pair(kind) };
            let t = advance(&pair, x, down);
            // The gap is a twentieth of the reach; an advance of nine tenths leaves less than ten times that.
            let want = 1.0 / speed;
            assert!(if speed < 1.0 { t >= 1.0 } else { t < want && t > want * (1.0 - 0.01) }, "{speed}: {t}");
            let away = down.map(|p| -p);
            assert!(advance(&pair, x, away) >= 1.0, "{speed}: away");
        }
    }
}
