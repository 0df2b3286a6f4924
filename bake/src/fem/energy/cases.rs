//! Energies and deformations for the tests, and what derivatives are checked against.

use super::arap::Arap;
use super::corotated::Corotated;
use super::neo_hookean::NeoHookean;
use super::stvk::StVenantKirchhoff;
use super::{Energy, Hessian};
use crate::fem::material::Lame;
use crate::fem::svd::Svd;
use glam::{DMat3, DVec3};
use nalgebra::SVector;
use num_dual::{Dual2SVec64, DualNum, hessian};

/// A deformation gradient and what it is like.
pub(crate) fn deformations() -> Vec<(&'static str, DMat3)> {
    let diagonal = |a, b, c| DMat3::from_diagonal(DVec3::new(a, b, c));
    let turn = DMat3::from_axis_angle(DVec3::new(0.6, 0.0, 0.8), 2.1);
    let other = DMat3::from_axis_angle(DVec3::new(0.0, 0.8, -0.6), 0.4);
    let mut cases = vec![
        ("rest", DMat3::IDENTITY),
        ("turned", turn),
        ("half a turn", diagonal(-1.0, -1.0, 1.0)),
        ("bulk", diagonal(1.7, 1.7, 1.7)),
        ("stretch", turn * diagonal(2.0, 0.7, 0.6) * other),
        ("two alike", other * diagonal(1.3, 1.3, 0.5) * turn),
        ("flat", turn * diagonal(1.2, 0.8, 0.0) * other),
        ("line", turn * diagonal(1.2, 0.0, 0.0) * other),
        ("point", DMat3::ZERO),
        ("mirrored", turn * diagonal(1.0, 1.0, -1.0)),
        ("inverted", turn * diagonal(1.5, 0.4, -0.3) * other),
        ("all inverted", diagonal(-1.0, -1.0, -1.0)),
        ("huge", turn * diagonal(1e4, 3e3, 2e3) * other),
        ("tiny", turn * diagonal(1e-6, 4e-7, 1e-7) * other),
    ];
    // Entries of a linear congruential generator, around ±1.
    let mut state = 1_u32;
    let mut random = || {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        f64::from(state >> 8) / f64::from(1 << 23) - 1.0
    };
    for _ in 0..40 {
        cases.push(("random", DMat3::from_cols_array(&[0.0; 9].map(|_| 1.5 * random()))));
    }
    cases
}

/// Flesh of the Deep Emulator's kind.
pub(crate) fn flesh() -> Lame {
    Lame::new(3.0, 0.45).expect("a material")
}

/// All energies, with `ψ` by invariants where it has them.
fn energies() -> Vec<(&'static str, Box<dyn Energy>, Option<Invariant>)> {
    vec![
        ("Neo-Hookean", Box::new(NeoHookean::new(flesh())), Some(neo_hookean)),
        ("StVK", Box::new(StVenantKirchhoff::new(flesh(), 0.0)), Some(|f| stvk(f, 0.0))),
        ("StVK, pressed", Box::new(StVenantKirchhoff::new(flesh(), 7.0)), Some(|f| stvk(f, 7.0))),
        ("co-rotated", Box::new(Corotated::new(flesh())), None),
        ("ARAP", Box::new(Arap::new(2.5)), None),
    ]
}

type Number = Dual2SVec64<9>;
type Matrix = [[Number; 3]; 3];
type Invariant = fn(&Matrix) -> Number;

fn determinant([a, b, c]: &Matrix) -> Number {
    a[0] * (b[1] * c[2] - b[2] * c[1]) - b[0] * (a[1] * c[2] - a[2] * c[1])
        + c[0] * (a[1] * b[2] - a[2] * b[1])
}

fn dot(a: &[Number; 3], b: &[Number; 3]) -> Number {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn neo_hookean(f: &Matrix) -> Number {
    let Lame { mu, lambda } = flesh();
    let lambda = lambda + mu;
    let square: Number = f.iter().map(|c| dot(c, c)).sum();
    (square - 3.0) * (0.5 * mu) + (determinant(f) - (1.0 + mu / lambda)).powi(2) * (0.5 * lambda)
        - 0.5 * mu * mu / lambda
}

fn stvk(f: &Matrix, compression: f64) -> Number {
    let Lame { mu, lambda } = flesh();
    let (mut square, mut trace) = (Number::from(0.0), Number::from(0.0));
    for i in 0..3 {
        for j in 0..3 {
            let g = (dot(&f[i], &f[j]) - if i == j { 1.0 } else { 0.0 }) * 0.5;
            square += g * g;
            if i == j {
                trace += g;
            }
        }
    }
    let less = -determinant(f) + 1.0;
    let pressed = if less.re > 0.0 { less.powi(3) * compression } else { Number::from(0.0) };
    square * mu + trace * trace * (0.5 * lambda) + pressed
}

fn largest(h: &Hessian) -> f64 {
    h.as_flattened().iter().fold(0.0, |most: f64, x| most.max(x.abs()))
}

#[test]
fn derivatives_are_those_of_automatic_differentiation() {
    for (energy, e, invariant) in energies() {
        let Some(invariant) = invariant else { continue };
        for (name, f) in deformations() {
            let at = SVector::from(f.to_cols_array());
            let by_columns =
                |x: SVector<Number, 9>| invariant(&[0, 1, 2].map(|c| [0, 1, 2].map(|r| x[3 * c + r])));
            let (density, gradient, second) = hessian(by_columns, &at);
            let svd = Svd::new(&f);
            let h = e.hessian(&svd, false);
            let size = largest(&h).max(1.0);
            let reach = f.to_cols_array().into_iter().fold(1.0, |most: f64, x| most.max(x.abs()));
            assert!((e.density(svd.s) - density).abs() < 1e-13 * size * reach * reach, "{energy}, {name}");
            let p = e.stress(&svd).to_cols_array();
            for i in 0..9 {
                assert!((p[i] - gradient[i]).abs() < 1e-13 * size * reach, "{energy}, {name}: P {i}");
                for j in 0..9 {
                    assert!((h[j][i] - second[(i, j)]).abs() < 1e-13 * size, "{energy}, {name}: H {i} {j}");
                }
            }
        }
    }
}

/// The stretches of a case stay apart by more than a difference takes, or the nearest rotation may jump.
fn is_smooth(s: [f64; 3]) -> bool {
    s[1] + s[2] > 1e-2
}

#[test]
fn derivatives_are_finite_differences() {
    const H: f64 = 1e-5;
    for (energy, e, invariant) in energies() {
        for (name, f) in deformations() {
            let svd = Svd::new(&f);
            if invariant.is_none() && !is_smooth(svd.s) || svd.s[0] > 10.0 {
                continue;
            }
            let (p, h) = (e.stress(&svd).to_cols_array(), e.hessian(&svd, false));
            let size = largest(&h).max(1.0);
            for i in 0..9 {
                let moved = |by: f64| {
                    let mut f = f.to_cols_array();
                    f[i] += by;
                    Svd::new(&DMat3::from_cols_array(&f))
                };
                let (up, down) = (moved(H), moved(-H));
                let slope = (e.density(up.s) - e.density(down.s)) / (2.0 * H);
                assert!((p[i] - slope).abs() < 1e-7 * size, "{energy}, {name}: P {i}: {} {slope}", p[i]);
                let slope = (e.stress(&up) - e.stress(&down)).to_cols_array().map(|x| x / (2.0 * H));
                for j in 0..9 {
                    assert!((h[i][j] - slope[j]).abs() < 1e-5 * size, "{energy}, {name}: H {i} {j}");
                }
            }
        }
    }
}

/// Projected, the least eigenvalue is not below rounding, and what was not negative is as before.
#[test]
fn projected_hessians_have_no_negative_eigenvalue() {
    for (energy, e, _) in energies() {
        let mut changed = 0;
        for (name, f) in deformations() {
            let svd = Svd::new(&f);
            let full = nalgebra::SMatrix::<f64, 9, 9>::from(e.hessian(&svd, false));
            let found = nalgebra::SMatrix::<f64, 9, 9>::from(e.hessian(&svd, true));
            let eigen = full.symmetric_eigen();
            let clamped = eigen.eigenvalues.map(|x| x.max(0.0));
            let want = eigen.eigenvectors
                * nalgebra::SMatrix::from_diagonal(&clamped)
                * eigen.eigenvectors.transpose();
            let size = full.amax().max(1.0);
            assert!((found - want).amax() < 1e-12 * size, "{energy}, {name}: {}", (found - want).amax());
            changed += usize::from((full - want).amax() > 1e-9 * size);
        }
        assert!(changed > 3, "{energy}: no case has a negative eigenvalue");
    }
}

#[test]
fn rest_is_free_of_stress_and_rotations_do_not_matter() {
    for (energy, e, _) in energies() {
        let rest = e.stress(&Svd::new(&DMat3::IDENTITY));
        assert!(rest.to_cols_array().iter().all(|x| x.abs() < 1e-14), "{energy}: {rest}");
        let turn = DMat3::from_axis_angle(DVec3::new(0.0, 0.6, 0.8), 1.3);
        for (name, f) in deformations() {
            let (at, turned) = (Svd::new(&f), Svd::new(&(turn * f)));
            let size = largest(&e.hessian(&at, false)).max(1.0) * at.s[0].max(1.0);
            if e.density(at.s) < 1e9 && (is_smooth(at.s) || energy.starts_with(['N', 'S'])) {
                let off = turn * e.stress(&at) - e.stress(&turned);
                assert!(
                    off.to_cols_array().iter().all(|x| x.abs() < 1e-12 * size),
                    "{energy}, {name}: {off}"
                );
            }
        }
    }
}

/// At rest a material has the moduli that were asked for: `ψᵢᵢ = λ + 2μ`, `ψᵢⱼ = λ`.
#[test]
fn materials_are_what_was_asked_for() {
    let Lame { mu, lambda } = flesh();
    for (energy, e, _) in energies().into_iter().filter(|(name, ..)| *name != "ARAP") {
        for (i, row) in e.second([1.0; 3]).iter().enumerate() {
            for (j, found) in row.iter().enumerate() {
                let want = if i == j { lambda + 2.0 * mu } else { lambda };
                assert!((found - want).abs() < 1e-14 * want, "{energy}: {found} {want}");
            }
        }
    }
    assert!((flesh().young() - 3.0).abs() < 1e-14);
}
