//! Hinges between the triangles of a skin.
//!
//! ```text
//! ψ = ½ (l̄²/Ā) (θ − θ̄)²,   Ā = (A₁ + A₂)/3,   sin θ = ê·(n̂₁ × n̂₂)
//!
//! dθ = −Σₜ n̂·q/h,   q = dw − (a/l) de
//! d²θ = 2 Σₜ [(n̂·q)(b·q)/h² + (n̂·de)(ê·q/(l h) + b·de/(2l²))]
//! ```
//!
//! Discrete shells (Grinspun, Hirani, Desbrun, Schröder 2003), weighed as the skin of neural deformation gradients is (Nolte
//! et al. 2026). Each triangle `t` has the edge `e` of length `l` in common with the other, from there to its apex `w = a ê + h b`,
//! and the normal `n̂ = ê × b`. `n̂·q/h` is how far it turns about the edge against a frame that goes with the edge and does not spin; its change as all
//! points move evenly is the second line (the same as Tamstorf, Grinspun 2013, in fewer terms).
//!
//! The Hessian is a sum of one square, `∇θ∇θᵀ`, and four products of orthogonal vectors; each product's eigen-system is
//! known ([blocks](crate::fem::blocks)). Projected, the negative half of each is left out: positive semi-definite and
//! nowhere below the true one.

use crate::fem::blocks::{Blocks, product, square};
use core::f64::consts::PI;
use glam::{DMat3, DVec3};

/// Below this squared sine of the angle at its edge a triangle has no normal.
const FLAT: f64 = 1e-24;

/// A hinge: an edge between two triangles. Its points are the edge's ends, then the apex to its left seen from outside, whose
/// triangle goes around `0, 1, 2`, then that of the other, `1, 0, 3`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bending {
    /// `θ̄`.
    pub rest: f64,
    /// `l̄²/Ā`.
    pub weight: f64,
}

/// Half of a hinge: what turns one triangle about the edge.
struct Leaf {
    /// `n̂·q/h`, by the points.
    turn: [DVec3; 4],
    /// The pairs of vectors whose products sum up to `d²θ`.
    products: [[[DVec3; 4]; 2]; 2],
}

impl Bending {
    /// Of a hinge at rest; none where a triangle has no area.
    #[must_use]
    pub fn new(x: [DVec3; 4]) -> Option<Self> {
        let area = |[i, j, k]: [usize; 3]| 0.5 * (x[j] - x[i]).cross(x[k] - x[i]).length();
        let areas = [area([0, 1, 2]), area([1, 0, 3])];
        let weight = 3.0 * x[0].distance_squared(x[1]) / (areas[0] + areas[1]);
        let sound = areas.iter().all(|a| *a > 0.0) && weight.is_finite();
        sound.then(|| Self { rest: angle(x), weight })
    }

    /// `θ − θ̄`, the shorter way round.
    fn bent(&self, x: [DVec3; 4]) -> f64 {
        let bent = angle(x) - self.rest;
        if bent > PI {
            bent - 2.0 * PI
        } else if bent < -PI {
            bent + 2.0 * PI
        } else {
            bent
        }
    }

    /// `ψ`; it jumps where the hinge is bent by half a turn from its rest, and nowhere else.
    #[must_use]
    pub fn density(&self, x: [DVec3; 4]) -> f64 {
        let bent = self.bent(x);
        0.5 * self.weight * bent * bent
    }

    /// `∂ψ/∂x`, 1/m. Zero where a triangle has no normal.
    #[must_use]
    pub fn slopes(&self, x: [DVec3; 4]) -> [DVec3; 4] {
        let Some(leaves) = leaves(x) else { return [DVec3::ZERO; 4] };
        let w = self.weight * self.bent(x);
        slope(&leaves).map(|slope| w * slope)
    }

    /// `∂²ψ/∂x²`, 1/m²; or a positive semi-definite matrix above it. Zero where a triangle has no normal.
    #[must_use]
    pub fn hessian(&self, x: [DVec3; 4], projected: bool) -> Blocks<4> {
        let mut h = [[DMat3::ZERO; 4]; 4];
        let Some(leaves) = leaves(x) else { return h };
        square(&mut h, self.weight, &slope(&leaves));
        let w = self.weight * self.bent(x);
        for [u, v] in leaves.iter().flat_map(|leaf| &leaf.products) {
            product(&mut h, w, u, v, projected);
        }
        h
    }
}

/// `θ`, from −π to π: above 0 where the outside is convex.
fn angle(x: [DVec3; 4]) -> f64 {
    let e = x[1] - x[0];
    let (m, n) = (e.cross(x[2] - x[0]), (x[3] - x[1]).cross(e));
    let length = e.length();
    if length == 0.0 {
        return 0.0;
    }
    libm::atan2(e.dot(m.cross(n)) / length, m.dot(n))
}

/// `∂θ/∂x`.
fn slope([one, other]: &[Leaf; 2]) -> [DVec3; 4] {
    [0, 1, 2, 3].map(|i| -(one.turn[i] + other.turn[i]))
}

/// Both triangles; none where one has no normal.
fn leaves(x: [DVec3; 4]) -> Option<[Leaf; 2]> {
    Some([leaf(x, [0, 1, 2])?, leaf(x, [1, 0, 3])?])
}

fn leaf(x: [DVec3; 4], [i, j, k]: [usize; 3]) -> Option<Leaf> {
    let (e, w) = (x[j] - x[i], x[k] - x[i]);
    let (area, l) = (e.cross(w), e.length());
    let square = area.length_squared();
    if square <= FLAT * e.length_squared() * w.length_squared() || square.is_nan() {
        return None;
    }
    let (along, n) = (e / l, area.normalize());
    let b = n.cross(along);
    let (h, share) = (w.dot(b), w.dot(along) / l);
    // What is multiplied with q, and with de, as a vector by the points.
    let by_q = |v: DVec3| {
        let mut out = [DVec3::ZERO; 4];
        (out[i], out[j], out[k]) = ((share - 1.0) * v, -share * v, v);
        out
    };
    let by_e = |v: DVec3| {
        let mut out = [DVec3::ZERO; 4];
        (out[i], out[j]) = (-v, v);
        out
    };
    let (p, q) = (by_q(along / (l * h)), by_e(b / (2.0 * l * l)));
    let second = [0, 1, 2, 3].map(|i| p[i] + q[i]);
    Some(Leaf { turn: by_q(n / h), products: [[by_q(n), by_q(b / (h * h))], [by_e(n), second]] })
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{SMatrix, SVector};
    use num_dual::{Dual2SVec64, DualNum, hessian};

    type Matrix = SMatrix<f64, 12, 12>;
    type Number = Dual2SVec64<12>;

    /// Ridges by their angle, random ones, slivers, large and small; with what rest.
    fn cases() -> Vec<(String, Bending, [DVec3; 4])> {
        let p = |x, y, z| DVec3::new(x, y, z);
        let ridge = |angle: f64| {
            let (a, b) = (0.5 * angle, 0.5 * angle);
            [
                p(0.0, 0.0, 0.0),
                p(1.0, 0.0, 0.0),
                p(0.3, libm::cos(a), -libm::sin(a)),
                p(0.6, -0.8 * libm::cos(b), -0.8 * libm::sin(b)),
            ]
        };
        let hinge = |rest: f64| Bending { rest, ..Bending::new(ridge(0.0)).expect("a hinge") };
        let mut out = Vec::new();
        for angle in [0.0, 1e-9, 0.1, -0.4, 1.5, -2.5, 3.0, -3.1, 3.13] {
            for rest in [0.0, 0.4, -3.0] {
                out.push((format!("ridge {angle} {rest}"), hinge(rest), ridge(angle)));
            }
        }
        let mut state = 1_u32;
        let mut random = || {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            f64::from(state >> 8) / f64::from(1 << 23) - 1.0
        };
        for (name, size) in [("random", 1.0), ("huge", 1e4), ("tiny", 1e-4)] {
            for k in 0..15 {
                let x = [0; 4].map(|_| size * p(random(), random(), random()));
                out.push((format!("{name} {k}"), hinge(0.3), x));
            }
        }
        let mut sliver = ridge(0.7);
        sliver[2] = p(0.4, 1e-3, 1e-4);
        out.push(("sliver".into(), hinge(0.0), sliver));
        out
    }

    fn full(h: &Blocks<4>) -> Matrix {
        Matrix::from_fn(|r, c| {
            let (i, j) = (r / 3, c / 3);
            if i >= j { h[i][j].col(c % 3)[r % 3] } else { h[j][i].col(r % 3)[c % 3] }
        })
    }

    fn cross(a: &[Number; 3], b: &[Number; 3]) -> [Number; 3] {
        [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
    }

    fn dot(a: &[Number; 3], b: &[Number; 3]) -> Number {
        a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
    }

    /// `ψ` by its definition.
    fn defined(hinge: &Bending, x: &SVector<Number, 12>) -> Number {
        let from = |i: usize, j: usize| [0, 1, 2].map(|c| x[3 * j + c] - x[3 * i + c]);
        let e = from(0, 1);
        let (m, n) = (cross(&e, &from(0, 2)), cross(&from(1, 3), &e));
        let angle = (dot(&e, &cross(&m, &n)) / dot(&e, &e).sqrt()).atan2(dot(&m, &n));
        let turns = ((angle.re - hinge.rest) / (2.0 * PI)).round();
        let bent = angle - hinge.rest - 2.0 * PI * turns;
        bent * bent * (0.5 * hinge.weight)
    }

    /// The dual numbers divide by the squares of areas, which costs them digits where a triangle is flat: relative to its height.
    #[test]
    fn derivatives_are_those_of_automatic_differentiation() {
        for (name, hinge, x) in cases() {
            let flat: Vec<f64> = x.iter().flat_map(|x| x.to_array()).collect();
            let (value, slopes, second) =
                hessian(|x: SVector<Number, 12>| defined(&hinge, &x), &SVector::from_row_slice(&flat));
            assert!((hinge.density(x) - value).abs() < 1e-12 * hinge.weight, "{name}: {value}");
            let (found, h) = (hinge.slopes(x), full(&hinge.hessian(x, false)));
            let rounding = if name == "sliver" { 1e-10 } else { 1e-12 };
            let off = (0..12).map(|i| (found[i / 3][i % 3] - slopes[i]).abs()).fold(0.0, f64::max);
            let steepest = slope(&leaves(x).expect("normals")).iter().map(|s| s.length()).fold(0.0, f64::max);
            assert!(off < rounding * hinge.weight * steepest, "{name}: slopes are off by {off}");
            assert!((h - second).amax() < rounding * second.amax(), "{name}: H {}", (h - second).amax());
        }
    }

    #[test]
    fn projected_hessians_are_above() {
        let mut negative = 0;
        for (name, hinge, x) in cases() {
            let (exact, projected) = (full(&hinge.hessian(x, false)), full(&hinge.hessian(x, true)));
            let least = |m: Matrix| m.symmetric_eigenvalues().min();
            let rounding = 1e-13 * projected.amax();
            assert!(least(projected) > -rounding, "{name}: {}", least(projected));
            assert!(least(projected - exact) > -rounding, "{name}: {} below", least(projected - exact));
            negative += usize::from(least(exact) < -rounding);
        }
        assert!(negative > 40, "only {negative} had a negative eigenvalue");
    }

    /// Folded either way an angle keeps its sign and size; a hinge turned as a whole does not bend.
    #[test]
    fn angles_are_those_of_the_ridge() {
        let turn = DMat3::from_axis_angle(DVec3::new(0.6, 0.0, 0.8), 2.1);
        for (name, hinge, x) in cases() {
            let x0 = x[1];
            let turned = x.map(|x| turn * x + 2.0 * x0);
            assert!((angle(turned) - angle(x)).abs() < 1e-11, "{name}: {} {}", angle(turned), angle(x));
            if let Some(want) =
                name.strip_prefix("ridge ").and_then(|n| n.split(' ').next()?.parse::<f64>().ok())
            {
                assert!((angle(x) - want).abs() < 1e-14, "{name}: {}", angle(x));
                // Past a whole fold it goes on the other side.
                let bent = want - hinge.rest;
                let want = bent - 2.0 * PI * libm::round(bent / (2.0 * PI));
                assert!(
                    (hinge.density(x) - 0.5 * hinge.weight * want * want).abs() < 1e-13 * hinge.weight,
                    "{name}"
                );
            }
        }
    }

    #[test]
    fn degenerate_triangles_are_finite() {
        let p = |x, y, z| DVec3::new(x, y, z);
        let sound = [p(0.0, 0.0, 0.0), p(1.0, 0.0, 0.0), p(0.3, 1.0, 0.0), p(0.6, -1.0, 0.2)];
        let hinge = Bending::new(sound).expect("a hinge");
        let line = [sound[0], sound[1], p(0.5, 0.0, 0.0), sound[3]];
        for x in [
            line,
            [sound[0], sound[0], sound[2], sound[3]],
            [sound[0]; 4],
            [sound[0], sound[1], sound[0], sound[3]],
        ] {
            let h = [hinge.hessian(x, false), hinge.hessian(x, true)];
            assert!(hinge.density(x).is_finite() && hinge.slopes(x).iter().all(|s| s.is_finite()), "{x:?}");
            assert!(h.iter().all(|h| full(h).iter().all(|x| x.is_finite())), "{x:?}");
            assert!(Bending::new(x).is_none(), "{x:?} has no hinge");
        }
    }
}
