//! When is a prism sound everywhere inside, not at its quadrature points alone?
//!
//! With columns `dᵢ = bᵢ − aᵢ` and edges `e` of the inner, `f` of the outer triangle the Jacobian of the prism is
//!
//! ```text
//! J(l, s) = Σᵢ lᵢ dᵢ·A(s),   A(s) = (1−s)² e₁×e₂ + 2(1−s)s (e₁×f₂ + f₁×e₂)/2 + s² f₁×f₂
//! ```
//!
//! linear in the barycentric `l` and of degree 2 in `s`: nine Bernstein coefficients `cᵢₖ = dᵢ·Aₖ`. Where all are
//! above 0, so is `J` in the whole prism, and `J` is never below the smallest of them.

use glam::DVec3;

/// `cᵢₖ`, three a column from the inner triangle outwards; m³.
pub(super) fn coefficients([a0, a1, a2, b0, b1, b2]: &[DVec3; 6]) -> [[f64; 3]; 3] {
    let (e1, e2, f1, f2) = (*a1 - *a0, *a2 - *a0, *b1 - *b0, *b2 - *b0);
    let areas = [e1.cross(e2), 0.5 * (e1.cross(f2) + f1.cross(e2)), f1.cross(f2)];
    [*b0 - *a0, *b1 - *a1, *b2 - *a2].map(|column| areas.map(|a| column.dot(a)))
}

/// Whether all coefficients are above `share` of those that the column would have upright on the outer triangle.
pub(super) fn is_sound(nodes: &[DVec3; 6], share: f64) -> bool {
    let [.., b0, b1, b2] = nodes;
    let outer = (*b1 - *b0).cross(*b2 - *b0).length();
    coefficients(nodes).iter().enumerate().all(|(i, row)| {
        let floor = share * outer * nodes[i].distance(nodes[i + 3]);
        row.iter().all(|c| *c > floor)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fem::prism;

    const WARPED: [[f64; 3]; 6] = [
        [0.0, 0.0, 0.0],
        [1.0, 0.0, 0.0],
        [0.0, 1.0, 0.0],
        [0.1, 0.0, 1.0],
        [0.9, 0.1, 1.2],
        [0.0, 0.8, 0.9],
    ];

    /// `J` by its definition, at barycentric `l` and height `s`.
    fn jacobian(n: &[DVec3; 6], l: [f64; 3], s: f64) -> f64 {
        let t = |i: usize| n[i] * (1.0 - s) + n[i + 3] * s;
        let up: DVec3 = (0..3).map(|i| l[i] * (n[i + 3] - n[i])).sum();
        (t(1) - t(0)).cross(t(2) - t(0)).dot(up)
    }

    #[test]
    fn the_bernstein_form_is_the_jacobian() {
        let nodes = WARPED.map(DVec3::from_array);
        let c = coefficients(&nodes);
        for (l, s) in
            [([1.0, 0.0, 0.0], 0.0), ([0.2, 0.3, 0.5], 0.7), ([0.0, 0.6, 0.4], 1.0), ([0.3, 0.3, 0.4], 0.1)]
        {
            let basis = [(1.0 - s) * (1.0 - s), 2.0 * (1.0 - s) * s, s * s];
            let form: f64 = (0..3).map(|i| l[i] * (0..3).map(|k| basis[k] * c[i][k]).sum::<f64>()).sum();
            assert!((form - jacobian(&nodes, l, s)).abs() < 1e-15);
        }
        let least = c.as_flattened().iter().copied().fold(f64::INFINITY, f64::min);
        assert!(least > 0.0 && least <= prism::smallest_jacobian(&nodes));
    }

    /// A prism with a volume, and sound at all points of the quadrature, but not at a corner.
    #[test]
    fn what_the_quadrature_misses_is_seen() {
        let mut nodes = WARPED.map(DVec3::from_array);
        assert!(is_sound(&nodes, 0.1) && !is_sound(&nodes, 0.99));
        nodes[3].z = -0.05;
        assert!(prism::mean(nodes).1 > 0.0 && prism::smallest_jacobian(&nodes) > 0.0);
        assert!(!is_sound(&nodes, 0.0));
    }
}
