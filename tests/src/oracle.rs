//! References that one can check by eye.

/// A square matrix of size `N` in `f64`.
pub type Matrix<const N: usize> = [[f64; N]; N];

/// Matrix product.
#[must_use]
pub fn mul<const N: usize>(a: &Matrix<N>, b: &Matrix<N>) -> Matrix<N> {
    core::array::from_fn(|i| core::array::from_fn(|j| (0..N).map(|k| a[i][k] * b[k][j]).sum()))
}

/// Matrix exponential by Taylor series after scaling, squared back.
#[must_use]
pub fn expm<const N: usize>(a: &Matrix<N>) -> Matrix<N> {
    let norm = a.iter().map(|row| row.iter().map(|x| x.abs()).sum::<f64>()).fold(0.0, f64::max);
    let mut squarings = 0;
    let mut scale = 1.0;
    while norm * scale > 0.25 {
        scale *= 0.5;
        squarings += 1;
    }
    let identity: Matrix<N> = core::array::from_fn(|i| core::array::from_fn(|j| f64::from(u8::from(i == j))));
    let scaled = a.map(|row| row.map(|x| x * scale));
    let (mut sum, mut term) = (identity, identity);
    for k in 1..=24_u32 {
        term = mul(&term, &scaled).map(|row| row.map(|x| x / f64::from(k)));
        sum = core::array::from_fn(|i| core::array::from_fn(|j| sum[i][j] + term[i][j]));
    }
    for _ in 0..squarings {
        sum = mul(&sum, &sum);
    }
    sum
}

/// Offset and relative velocity of `y″ + kd·y′ + ks·y = α₀ + (α₁ − α₀)·t/h` after `h` seconds, by the 4×4 exponential
/// of the augmented system `(y, u, α, α′)`.
#[must_use]
pub fn spring(ks: f64, kd: f64, h: f64, [y, u]: [f64; 2], [a0, a1]: [f64; 2]) -> [f64; 2] {
    let system: Matrix<4> = [[0.0, h, 0.0, 0.0], [-ks * h, -kd * h, h, 0.0], [0.0, 0.0, 0.0, h], [0.0; 4]];
    let e = expm(&system);
    let start = [y, u, a0, (a1 - a0) / h];
    [0, 1].map(|i| (0..4).map(|k| e[i][k] * start[k]).sum())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_rotation_comes_out_of_a_skew_matrix() {
        let e = expm(&[[0.0, -1.0], [1.0, 0.0]]);
        assert!(
            (e[0][0] - libm::cos(1.0)).abs() < 1e-14 && (e[1][0] - libm::sin(1.0)).abs() < 1e-14,
            "{e:?}"
        );
    }
}
