//! Cofactors of a linear map: `cof(M) = det(M)·M⁻ᵀ`, columns `b×c, c×a, a×b` of the columns `a, b, c` of `M`.

use crate::math::float::max;
use crate::math::vec3::{cross, dot};

/// Columns of a linear map.
pub type Linear = [[f32; 3]; 3];

/// What takes normals along, and vectors back.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cofactors {
    /// Columns of `cof(M)`.
    pub columns: Linear,
    /// `det(M)`.
    pub determinant: f32,
}

impl Cofactors {
    /// Of the map with the columns `m`.
    #[inline(always)]
    #[must_use]
    pub fn new([a, b, c]: &Linear) -> Self {
        let columns = [cross(*b, *c), cross(*c, *a), cross(*a, *b)];
        Self { columns, determinant: dot(*a, columns[0]) }
    }

    /// Whether `m`, the map whose cofactors these are, has an inverse: `|det|` is finite and above 1e-6 of the longest
    /// column's cube.
    #[inline(always)]
    #[must_use]
    pub fn regular(&self, [a, b, c]: &Linear) -> bool {
        let longest = max(max(dot(*a, *a), dot(*b, *b)), dot(*c, *c));
        1e-12 * longest * longest * longest < self.determinant * self.determinant
    }

    /// `cof(M)·n`.
    #[inline(always)]
    #[must_use]
    pub fn turn(&self, n: [f32; 3]) -> [f32; 3] {
        let [a, b, c] = &self.columns;
        [
            (a[0] * n[0] + b[0] * n[1]) + c[0] * n[2],
            (a[1] * n[0] + b[1] * n[1]) + c[1] * n[2],
            (a[2] * n[0] + b[2] * n[1]) + c[2] * n[2],
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cofactors_of_a_stretch_and_of_a_plane() {
        let m = [[2.0, 0.0, 0.0], [0.0, 3.0, 0.0], [0.0, 0.0, -5.0]];
        let cofactors = Cofactors::new(&m);
        assert_eq!(cofactors.columns, [[-15.0, 0.0, 0.0], [0.0, -10.0, 0.0], [0.0, 0.0, 6.0]]);
        assert_eq!((cofactors.determinant, cofactors.regular(&m)), (-30.0, true));
        assert_eq!(cofactors.turn([1.0, 1.0, 1.0]), [-15.0, -10.0, 6.0]);
        let flat = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 1.0, 0.0]];
        assert!(!Cofactors::new(&flat).regular(&flat));
    }
}
