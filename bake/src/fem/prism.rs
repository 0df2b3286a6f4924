//! The prism between two triangles.
//!
//! ```text
//! x(l, s) = Σᵢ lᵢ((1 − s)aᵢ + s bᵢ),   e = edges of a from a₀, f = of b from b₀, d = mean of bᵢ − aᵢ
//! V = d·[e₁×e₂ + f₁×f₂ + (e₁×f₂ + f₁×e₂)/2]/6
//!
//! mean: gᵢ = (1/V) ∂V/∂xᵢ                    the mean over the volume of the gradient of the i-th shape function
//! fit:  gᵢ = M⁻¹ ∫(x − c)Nᵢ,  M = ∫(x − c)(x − c)ᵀ    the affine map nearest to the motion of the inside
//! ```
//!
//! Both are exact for affine maps. The mean needs no quadrature, and `dV = V tr(dF)` holds exactly (Flanagan, Belytschko
//! 1981); the fit is what neural deformation gradients were trained on (Nolte et al. 2026, section 3.2).

use super::element::outer;
use glam::{DMat3, DVec3};

/// `gᵢ` of the mean, and the signed volume.
#[must_use]
pub fn mean([a0, a1, a2, b0, b1, b2]: [DVec3; 6]) -> ([DVec3; 6], f64) {
    let (e1, e2, f1, f2) = (a1 - a0, a2 - a0, b1 - b0, b2 - b0);
    let d = (b0 + b1 + b2 - a0 - a1 - a2) / 3.0;
    let area = e1.cross(e2) + f1.cross(f2) + 0.5 * (e1.cross(f2) + f1.cross(e2));
    let volume = d.dot(area) / 6.0;
    // By e₁, e₂, f₁, f₂.
    let by_e1 = (e2 + 0.5 * f2).cross(d) / 6.0;
    let by_e2 = d.cross(e1 + 0.5 * f1) / 6.0;
    let by_f1 = (f2 + 0.5 * e2).cross(d) / 6.0;
    let by_f2 = d.cross(f1 + 0.5 * e1) / 6.0;
    let by_d = area / 18.0;
    let slopes = [
        -by_e1 - by_e2 - by_d,
        by_e1 - by_d,
        by_e2 - by_d,
        -by_f1 - by_f2 + by_d,
        by_f1 + by_d,
        by_f2 + by_d,
    ];
    (slopes.map(|slope| slope / volume), volume)
}

/// Barycentric coordinates and weights of six points of a triangle, exact to degree 4 (Strang, Fix 1973).
const TRIANGLE: [(f64, f64); 2] =
    [(0.445_948_490_915_965, 0.223_381_589_678_011), (0.091_576_213_509_771, 0.109_951_743_655_322)];
/// Places and weights of three points of [0, 1], exact to degree 5 (Gauss).
const LINE: [(f64, f64); 3] =
    [(0.112_701_665_379_258_31, 5.0 / 18.0), (0.5, 8.0 / 18.0), (0.887_298_334_620_741_7, 5.0 / 18.0)];

/// `gᵢ` of the fit, and the signed volume.
#[must_use]
pub fn fit(nodes: [DVec3; 6]) -> ([DVec3; 6], f64) {
    // A point: weight, shape functions, place.
    let points: Vec<(f64, [f64; 6], DVec3)> = quadrature()
        .map(|(w, n)| {
            let place = n.iter().zip(nodes).map(|(n, x)| *n * x).sum();
            (w * jacobian(&nodes, &n), n, place)
        })
        .collect();
    let volume: f64 = points.iter().map(|(w, ..)| w).sum();
    let c = points.iter().map(|(w, _, x)| *w * *x).sum::<DVec3>() / volume;
    let (mut m, mut b) = (DMat3::ZERO, [DVec3::ZERO; 6]);
    for (w, n, x) in &points {
        let x = *x - c;
        m += outer(*w * x, x);
        for (b, n) in b.iter_mut().zip(n) {
            *b += *w * *n * x;
        }
    }
    let inverse = m.inverse();
    (b.map(|b| inverse * b), volume)
}

/// `∫NᵢNⱼ` over the prism, m³: its mass matrix for a density of 1.
#[must_use]
pub fn mass(nodes: [DVec3; 6]) -> [[f64; 6]; 6] {
    let mut out = [[0.0; 6]; 6];
    for (w, n) in quadrature() {
        let w = w * jacobian(&nodes, &n);
        for (row, i) in out.iter_mut().zip(n) {
            row.iter_mut().zip(n).for_each(|(m, j)| *m += w * i * j);
        }
    }
    out
}

/// Smallest determinant of `∂x/∂(l₁, l₂, s)` at the points of the quadrature, six times a volume, m³: an element
/// is sound where it is above 0, of which the mean's volume says nothing.
#[must_use]
pub fn smallest_jacobian(nodes: &[DVec3; 6]) -> f64 {
    quadrature().map(|(_, n)| jacobian(nodes, &n)).fold(f64::INFINITY, f64::min)
}

/// Weights and shape functions of all points.
fn quadrature() -> impl Iterator<Item = (f64, [f64; 6])> {
    LINE.into_iter().flat_map(|(s, line)| {
        TRIANGLE.into_iter().flat_map(move |(l, triangle)| {
            (0..3).map(move |corner| {
                let mut n = [0.0; 6];
                for i in 0..3 {
                    let l = if i == corner { 1.0 - 2.0 * l } else { l };
                    (n[i], n[i + 3]) = ((1.0 - s) * l, s * l);
                }
                (0.5 * line * triangle, n)
            })
        })
    })
}

/// Determinant of `∂x/∂(l₁, l₂, s)` where the shape functions are `n`.
fn jacobian(nodes: &[DVec3; 6], n: &[f64; 6]) -> f64 {
    let s = n[3] + n[4] + n[5];
    let between = |i: usize| nodes[i] * (1.0 - s) + nodes[i + 3] * s;
    let up: DVec3 = (0..3).map(|i| (n[i] + n[i + 3]) * (nodes[i + 3] - nodes[i])).sum();
    (between(1) - between(0)).cross(between(2) - between(0)).dot(up)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn nodes() -> [DVec3; 6] {
        [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.1, 0.0, 1.0], [0.9, 0.1, 1.2], [0.0, 0.8, 0.9]]
            .map(DVec3::from)
    }

    /// Rows of both operators, 12 digits, from an independent derivation.
    #[test]
    fn published_prism_holds() {
        let (g, volume) = mean(nodes());
        assert!((volume - 0.421_333_333_333).abs() < 1e-12);
        let want = [
            [
                -0.514240506329,
                0.607199367089,
                0.013844936709,
                -0.522151898734,
                0.494462025316,
                -0.079113924051,
            ],
            [
                -0.607199367089,
                0.005933544304,
                0.557753164557,
                -0.557753164557,
                0.055379746835,
                0.545886075949,
            ],
            [
                -0.342167721519,
                -0.322389240506,
                -0.304588607595,
                0.304588607595,
                0.324367088608,
                0.340189873418,
            ],
        ];
        for (r, row) in want.iter().enumerate() {
            assert!(g.iter().zip(row).all(|(g, want)| (g[r] - want).abs() < 1e-12), "{r}: {g:?}");
        }
        let (g, volume) = fit(nodes());
        assert!((volume - 0.421_333_333_333).abs() < 1e-12, "{volume}");
        let want =
            [-0.54231957361, 0.62870525236, 0.014725955411, -0.491466677037, 0.46715712816, -0.076802085284];
        assert!(g.iter().zip(want).all(|(g, want)| (g.x - want).abs() < 1e-10), "{g:?}");
    }

    /// Of a straight prism `V/72·(1 + δ)` on one side's corners times `(1 + δ)` of the sides; of any one that sums up to `V`.
    #[test]
    fn mass_is_that_of_the_volume() {
        let m = mass([DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z, DVec3::X + DVec3::Z, DVec3::Y + DVec3::Z]);
        for (i, row) in m.iter().enumerate() {
            for (j, m) in row.iter().enumerate() {
                let corner = if i % 3 == j % 3 { 2.0 } else { 1.0 };
                let side = if i / 3 == j / 3 { 2.0 } else { 1.0 };
                assert!((m - 0.5 * corner * side / 72.0).abs() < 1e-14, "{i} {j}: {m}");
            }
        }
        let all: f64 = mass(nodes()).iter().flatten().sum();
        assert!((all - 0.421_333_333_333).abs() < 1e-12, "{all}");
    }

    /// The slopes of the volume are finite differences of it, and sum up to 0.
    #[test]
    fn the_mean_is_the_slope_of_the_volume() {
        let (g, volume) = mean(nodes());
        for i in 0..6 {
            for axis in 0..3 {
                let moved = |by: f64| {
                    let mut x = nodes();
                    x[i][axis] += by;
                    mean(x).1
                };
                let slope = (moved(1e-6) - moved(-1e-6)) / 2e-6;
                assert!((g[i][axis] * volume - slope).abs() < 1e-9, "{i}, {axis}: {slope}");
            }
        }
        assert!(g.iter().sum::<DVec3>().length() < 1e-15);
    }
}
