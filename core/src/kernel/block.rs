//! What matrices and vectors of linear systems are made of: numbers, or blocks of 3×3 on vectors of 3.
//!
//! ```text
//! A ∈ ℝ, x ∈ ℝ    or    A ∈ ℝ³ˣ³, x ∈ ℝ³,    A x,   A⁻¹ by cofactors,   x·y
//! ```

use core::fmt::Debug;
use core::ops::{Add, Div, Mul, Sub};

/// A number: `f32` or `f64`.
pub trait Real:
    Copy
    + Debug
    + Default
    + PartialOrd
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
{
    /// 0.
    const ZERO: Self;
    /// 1.
    const ONE: Self;
}

impl Real for f32 {
    const ZERO: Self = 0.0;
    const ONE: Self = 1.0;
}

impl Real for f64 {
    const ZERO: Self = 0.0;
    const ONE: Self = 1.0;
}

/// An entry of a vector.
pub trait Unknown: Copy + Debug {
    /// What it is made of.
    type Real: Real;
    /// 0.
    const ZERO: Self;
    /// `x + y`.
    #[must_use]
    fn plus(self, y: Self) -> Self;
    /// `x − y`.
    #[must_use]
    fn minus(self, y: Self) -> Self;
    /// `s x`.
    #[must_use]
    fn scaled(self, s: Self::Real) -> Self;
    /// `x·y`.
    #[must_use]
    fn dot(self, y: Self) -> Self::Real;
}

/// What entries of vectors are multiplied by.
pub trait Times<V>: Copy + Debug {
    /// `A x`.
    #[must_use]
    fn times(self, x: V) -> V;
}

/// An entry of a square matrix.
pub trait Block: Times<Self::Unknown> + Times<Self> + Unknown {
    /// What it multiplies.
    type Unknown: Unknown<Real = <Self as Unknown>::Real>;
    /// `Aᵀ`.
    #[must_use]
    fn transposed(self) -> Self;
    /// `A⁻¹`; none unless the entry is positive definite, as those on the diagonal of a matrix must be.
    #[must_use]
    fn inverse(self) -> Option<Self>;
}

impl<R: Real> Unknown for R {
    type Real = R;
    const ZERO: R = Real::ZERO;

    fn plus(self, y: R) -> R {
        self + y
    }

    fn minus(self, y: R) -> R {
        self - y
    }

    fn scaled(self, s: R) -> R {
        self * s
    }

    fn dot(self, y: R) -> R {
        self * y
    }
}

/// Vectors of 3, and matrices of 3×3 as 3 rows: `x·y` is the sum of the products of their entries.
impl<U: Unknown> Unknown for [U; 3] {
    type Real = U::Real;
    const ZERO: Self = [U::ZERO; 3];

    fn plus(self, y: Self) -> Self {
        core::array::from_fn(|i| self[i].plus(y[i]))
    }

    fn minus(self, y: Self) -> Self {
        core::array::from_fn(|i| self[i].minus(y[i]))
    }

    fn scaled(self, s: U::Real) -> Self {
        self.map(|x| x.scaled(s))
    }

    fn dot(self, y: Self) -> U::Real {
        (self[0].dot(y[0]) + self[1].dot(y[1])) + self[2].dot(y[2])
    }
}

impl<R: Real> Times<R> for R {
    fn times(self, x: R) -> R {
        self * x
    }
}

/// A number times a vector: every entry.
impl<R: Real> Times<[R; 3]> for R {
    fn times(self, x: [R; 3]) -> [R; 3] {
        x.map(|x| self * x)
    }
}

/// A number times a block: every entry.
impl<R: Real> Times<[[R; 3]; 3]> for R {
    fn times(self, x: [[R; 3]; 3]) -> [[R; 3]; 3] {
        x.map(|row| row.map(|x| self * x))
    }
}

impl<R: Real> Times<[R; 3]> for [[R; 3]; 3] {
    fn times(self, x: [R; 3]) -> [R; 3] {
        self.map(|row| row.dot(x))
    }
}

/// The product of two blocks.
impl<R: Real> Times<Self> for [[R; 3]; 3] {
    fn times(self, x: Self) -> Self {
        let x = x.transposed();
        self.map(|row| x.map(|column| row.dot(column)))
    }
}

impl<R: Real> Block for R {
    type Unknown = R;

    fn transposed(self) -> R {
        self
    }

    fn inverse(self) -> Option<R> {
        (self > Real::ZERO).then(|| R::ONE / self)
    }
}

impl<R: Real> Block for [[R; 3]; 3] {
    type Unknown = [R; 3];

    fn transposed(self) -> Self {
        core::array::from_fn(|i| core::array::from_fn(|j| self[j][i]))
    }

    fn inverse(self) -> Option<Self> {
        let minor = |i: usize, j: usize| {
            let ([a, b], [c, d]) = (next(i), next(j));
            self[a][c] * self[b][d] - self[a][d] * self[b][c]
        };
        let cofactors: Self = core::array::from_fn(|i| core::array::from_fn(|j| minor(i, j)));
        let determinant = self[0].dot(cofactors[0]);
        // Sylvester: all leading minors.
        let zero: R = Real::ZERO;
        let definite = self[0][0] > zero && cofactors[2][2] > zero && determinant > zero;
        definite.then(|| cofactors.transposed().scaled(R::ONE / determinant))
    }
}

/// The two indices after `i`, in a circle of 3.
const fn next(i: usize) -> [usize; 2] {
    [(i + 1) % 3, (i + 2) % 3]
}

#[cfg(test)]
mod tests {
    use super::*;

    const A: [[f64; 3]; 3] = [[4.0, 1.0, -0.5], [1.0, 3.0, 0.25], [-0.5, 0.25, 2.0]];

    #[test]
    fn the_inverse_takes_a_product_back() {
        let inverse = A.inverse().expect("positive definite");
        let one: [[f64; 3]; 3] = inverse.times(A);
        for (i, row) in one.iter().enumerate() {
            for (j, x) in row.iter().enumerate() {
                assert!((x - f64::from(u8::from(i == j))).abs() < 1e-15, "{i} {j}: {x}");
            }
        }
        let x: [f64; 3] = A.times([1.0, 2.0, 3.0]);
        assert_eq!(x, [4.5, 7.75, 6.0]);
    }

    #[test]
    fn an_indefinite_block_has_none() {
        for (i, by) in [(0, 5.0), (1, 4.0), (2, 3.0), (0, f64::NAN)] {
            let mut a = A;
            a[i][i] -= by;
            assert_eq!(a.inverse(), None, "{i} {by}");
        }
        assert_eq!(0.0_f32.inverse(), None);
        assert_eq!((-1.0_f64).inverse(), None);
    }
}
