//! The barrier between two parts of a surface.
//!
//! ```text
//! b(D) = κ A d̂ β(D/d̂²),   β(s) = −(1 − s)² ln s   for s < 1, else 0
//! ```
//!
//! That of Li et al. 2020, equation 6, without units: its energy is that of a layer of stiffness `κ`, Pa, over an area
//! `A` and of a thickness `d̂`, so that neither a finer mesh nor another scale changes what it feels like. Twice
//! continuously differentiable, convex in the distance, infinite at 0.

/// `b`, J, and its derivatives by the squared distance `D`, from `D`, m², `d̂`, m, and `κA`, N.
#[must_use]
pub fn barrier(squared: f64, reach: f64, stiffness: f64) -> [f64; 3] {
    let s = squared / (reach * reach);
    if s >= 1.0 {
        return [0.0; 3];
    }
    let (log, left) = (libm::log(s), 1.0 - s);
    let value = -left * left * log;
    let first = 2.0 * left * log - left * left / s;
    let second = -2.0 * log + 4.0 * left / s + left * left / (s * s);
    [stiffness * reach * value, stiffness / reach * first, stiffness / (reach * reach * reach) * second]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Slopes by central differences; their error is a sixth of `h²` by the third derivative, which changes over the distance
    /// from either end.
    #[test]
    fn slopes_are_differences() {
        let (reach, stiffness) = (0.02_f64, 15.0);
        for s in [1e-6, 1e-3, 0.1, 0.5, 0.9, 0.999] {
            let d = s * reach * reach;
            let h = 1e-4 * d.min(reach * reach - d);
            let [_, first, second] = barrier(d, reach, stiffness);
            let (up, down) = (barrier(d + h, reach, stiffness), barrier(d - h, reach, stiffness));
            for (found, k) in [(first, 0), (second, 1)] {
                let want = (up[k] - down[k]) / (2.0 * h);
                let size = barrier(d, reach, stiffness)[2] * if k == 0 { d } else { 1.0 };
                assert!((found - want).abs() < 1e-6 * size, "{s}: {found} {want}");
            }
            assert!(4.0 * second * d + 2.0 * first > 0.0, "not convex in the distance at {s}");
        }
    }

    #[test]
    fn it_ends_smoothly_and_begins_without_limit() {
        let at = |s: f64| barrier(s, 1.0, 1.0);
        assert_eq!(at(1.0).map(f64::to_bits), [0; 3]);
        let near = at(1.0 - 1e-6);
        assert!(near[0] < 1e-17 && near[1].abs() < 1e-11 && near[2] < 1e-5, "{near:?}");
        assert!(at(0.0)[0].is_infinite());
    }
}
