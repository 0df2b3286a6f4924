//! The slowest mode of a body.

use faer::Par;
use glam::DVec3;
use sinew_bake::fem::assembly::{Assembly, Free};
use sinew_bake::fem::cholesky::Cholesky;
use sinew_bake::fem::mass::Mass;
use sinew_bake::fem::potential::Potential;

/// `φ` with `φᵀMφ = 1`, and `ω²`, of `Kφ = ω²Mφ`.
pub(crate) fn slowest(rest: &[DVec3], free: &Free, body: &dyn Potential, mass: &Mass) -> (Vec<DVec3>, f64) {
    let mut matrix = free.stiffness(&[body]);
    body.hessian(rest, false, &mut Assembly::new(free, &mut matrix));
    let mut factor = Cholesky::new(&matrix, Par::Seq).expect("memory");
    factor.factorize(&matrix).expect("positive definite");
    let dot = |a: &[DVec3], b: &[DVec3]| a.iter().zip(b).map(|(a, b)| a.dot(*b)).sum::<f64>();
    let mut mode: Vec<DVec3> = rest.iter().map(|x| DVec3::new(0.03, x.x, 0.1 * x.x)).collect();
    let mut square = 0.0;
    for _ in 0..400 {
        let weighed = mass.times(&mode);
        let mut next: Vec<DVec3> = free.node.iter().map(|i| weighed[*i as usize]).collect();
        factor.solve(&mut next);
        let mut full = vec![DVec3::ZERO; rest.len()];
        free.node.iter().zip(&next).for_each(|(i, x)| full[*i as usize] = *x);
        let size = dot(&full, &mass.times(&full)).sqrt();
        square = dot(&full, &weighed) / (size * size);
        mode = full.into_iter().map(|x| x / size).collect();
    }
    (mode, square)
}
