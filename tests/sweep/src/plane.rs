//! `Ψ`, `Θ` and the step of a spring over the plane of damping `a` and stiffness `b`.

#![allow(clippy::disallowed_methods, reason = "std in f64 is the reference, MPFR decides")]

use core::cmp::Ordering;
use std::collections::BTreeSet;
use std::thread;
use std::time::Instant;

use anyhow::{Result, bail};
use indicatif::ProgressBar;
use rug::Float;
use sinew::kernel::spring::{Response, Spring};
use sinew::math::psi::psi;
use sinew::math::theta::{psi_theta_wide, theta};

/// Bits of MPFR's numbers: upward recurrence from a subnormal `b` takes 600 of them.
const PRECISION: u32 = 800;
/// One point in so many is compared with MPFR, and all that look bad.
const EXACT: u64 = 61;
/// Error, in ulp of the largest entry, from which MPFR is asked.
const SUSPECT: f64 = 0.6;

/// Names of the two rows of the table.
pub(crate) const NAMES: [&str; 2] = ["psi", "theta"];
/// Where accuracy is promised.
pub(crate) const DOMAIN: &str = "a <= 10^4, b <= (2 pi)^2";

/// What was found over the plane.
#[derive(Clone, Debug, Default)]
pub(crate) struct Swept {
    /// Largest error of `Ψ` and of `Θ` in ulp of the largest entry, within the domain, and where.
    pub(crate) worst: [(f64, [f32; 2]); 2],
    /// Sum of the errors.
    pub(crate) sum: [f64; 2],
    /// Largest excess of a step's eigenvalue over 1, anywhere, and where.
    pub(crate) active: (f64, [f32; 2]),
    /// Largest disagreement of the reference with MPFR, in ulp of `f32`.
    pub(crate) reference: f64,
    /// Points in all, within the domain, and compared with MPFR.
    pub(crate) points: [u64; 3],
    /// The first results that are not finite or out of bounds.
    pub(crate) broken: Vec<String>,
    /// Seconds.
    pub(crate) seconds: f64,
}

impl Swept {
    fn take(&mut self, a: f32, b: f32) {
        self.points[0] += 1;
        let (p, t) = (psi(a, b), theta(a, b));
        self.check_step(a, b, p, t);
        if a > 1e4 || b > 39.478_417 {
            return;
        }
        self.points[1] += 1;
        let (rp, rt) = psi_theta_wide(f64::from(a), f64::from(b));
        let mut errors = [ulps(&p, &rp), ulps(&t, &rt)];
        if self.points[1].is_multiple_of(EXACT) || errors[0] > SUSPECT || errors[1] > SUSPECT {
            self.points[2] += 1;
            let (ep, et) = exact(a, b);
            errors = [ulps(&p, &ep), ulps(&t, &et)];
            self.reference = self.reference.max(distance(&rp, &ep)).max(distance(&rt, &et));
        }
        for (k, error) in errors.into_iter().enumerate() {
            self.sum[k] += error;
            if error > self.worst[k].0 {
                self.worst[k] = (error, [a, b]);
            }
        }
    }

    /// Finite, bounded, and a step that adds no energy: both eigenvalues within the unit circle.
    fn check_step(&mut self, a: f32, b: f32, p: [f32; 5], t: [f32; 5]) {
        const BOUND: [f32; 5] = [1.0, 1.0, 1.0, 0.5, 1.0 / 6.0];
        let bounded =
            p.iter().zip(BOUND).all(|(p, bound)| p.abs() <= bound) && t.iter().all(|t| t.abs() <= 1.0);
        let step = Response::new(Spring { ks: b, kd: a }, 1.0);
        let [m00, m01] = [step.y[0], step.y[1]].map(f64::from);
        let [m10, m11] = [step.u[0], step.u[1]].map(f64::from);
        let (trace, determinant) = (m00 + m11, m00 * m11 - m01 * m10);
        let largest = if trace * trace < 4.0 * determinant {
            determinant.sqrt()
        } else {
            trace.abs() / 2.0 + (trace * trace / 4.0 - determinant).sqrt()
        };
        if largest - 1.0 > self.active.0 {
            self.active = (largest - 1.0, [a, b]);
        }
        if !(bounded && largest.is_finite()) && self.broken.len() < 10 {
            self.broken.push(format!("a {a:e} b {b:e}: psi {p:?}, theta {t:?}, eigenvalue {largest}"));
        }
    }

    fn merge(&mut self, other: Self) {
        for k in 0..2 {
            if other.worst[k].0 > self.worst[k].0 {
                self.worst[k] = other.worst[k];
            }
            self.sum[k] += other.sum[k];
        }
        if other.active.0 > self.active.0 {
            self.active = other.active;
        }
        self.reference = self.reference.max(other.reference);
        for k in 0..3 {
            self.points[k] += other.points[k];
        }
        self.broken.extend(other.broken);
    }
}

/// The grain of `f32` at the largest entry.
fn grain(want: &[f64; 5]) -> f64 {
    let largest = want.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
    let exponent = (largest.to_bits() >> 52).cast_signed() - 1023;
    f64::from_bits(((exponent - 23 + 1023).max(1) << 52).cast_unsigned())
}

fn ulps(got: &[f32; 5], want: &[f64; 5]) -> f64 {
    distance(&got.map(f64::from), want)
}

fn distance(got: &[f64; 5], want: &[f64; 5]) -> f64 {
    let error = got.iter().zip(want).map(|(g, w)| (g - w).abs()).fold(0.0, f64::max);
    error / grain(want)
}

/// `Ψ` and `Θ` by their closed forms and upward recurrence, with digits to spare.
fn exact(a: f32, b: f32) -> ([f64; 5], [f64; 5]) {
    const FACTORIAL: [f64; 5] = [1.0, 1.0, 2.0, 6.0, 24.0];
    if a == 0.0 && b == 0.0 {
        return (FACTORIAL.map(|f| 1.0 / f), [1.0, 1.0 / 2.0, 1.0 / 6.0, 1.0 / 24.0, 1.0 / 120.0]);
    }
    let number = |x: f64| Float::with_val(PRECISION, x);
    let (a, b) = (number(a.into()), number(b.into()));
    let ([p0, p1], [t0, t1]) = first_two(&a, &b);
    let (mut p, mut t) = (vec![p0, p1], vec![t0, t1]);
    for k in 0..3 {
        p.push(if b.is_zero() {
            (number(FACTORIAL[k + 1]).recip() - &p[k + 1]) / &a
        } else {
            (number(FACTORIAL[k]).recip() - &p[k] - number(1.0) * &a * &p[k + 1]) / &b
        });
    }
    for k in 2..4 {
        t.push(if b.is_zero() {
            (number(1.0) * &p[k + 1] - &t[k - 1]) / &a
        } else {
            (number(1.0) * &p[k] - &t[k - 2] - number(1.0) * &a * &t[k - 1]) / &b
        });
    }
    let before = number(1.0) * &p[1] - number(1.0) * &a * &t[0] - number(1.0) * &b * &t[1];
    let [t0, t1, t2, t3] = [0, 1, 2, 3].map(|k: usize| t[k].to_f64());
    ([0, 1, 2, 3, 4].map(|k: usize| p[k].to_f64()), [before.to_f64(), t0, t1, t2, t3])
}

/// `Ψ₀, Ψ₁` and `Θ₀, Θ₁`.
fn first_two(a: &Float, b: &Float) -> ([Float; 2], [Float; 2]) {
    let number = |x: f64| Float::with_val(PRECISION, x);
    let half = number(0.5) * a;
    let u = number(1.0) * &half * &half - b;
    let e = (-number(1.0) * &half).exp();
    let w = number(1.0) * u.clone().abs().sqrt();
    let (c, s) = match u.cmp0() {
        Some(Ordering::Greater) => (w.clone().cosh(), w.clone().sinh() / &w),
        Some(Ordering::Less) => (w.clone().cos(), w.clone().sin() / &w),
        _ => (number(1.0), number(1.0)),
    };
    let slope = if u.is_zero() { number(6.0).recip() } else { (number(0.5) * &c - number(0.5) * &s) / &u };
    let p0 = (c - number(1.0) * &half * &s) * &e;
    let t0 = (number(0.5) * &s - half * &slope) * &e;
    ([p0, s * &e], [t0, slope * e])
}

/// Sweeps over all sets; `manifold` is the step between values of `a` on the critical manifold.
///
/// # Errors
///
/// If a worker is lost or fewer points were tried than there are.
pub(crate) fn sweep(manifold: usize, progress: &ProgressBar) -> Result<Swept> {
    let start = Instant::now();
    let lattice: Vec<f32> = lattice().into_iter().map(f32::from_bits).collect();
    let threads = thread::available_parallelism().map_or(1, usize::from);
    let mut all = Swept::default();
    thread::scope(|scope| {
        let workers: Vec<_> = (0..threads)
            .map(|part| {
                let lattice = &lattice;
                scope.spawn(move || {
                    let mut mine = Swept::default();
                    progress.inc(lattice_part(&mut mine, lattice, part, threads));
                    progress.inc(exponents_part(&mut mine, part, threads));
                    manifold_part(&mut mine, manifold, part, threads);
                    mine
                })
            })
            .collect();
        for worker in workers {
            all.merge(worker.join().expect("a worker does not panic"));
        }
    });
    all.seconds = start.elapsed().as_secs_f64();
    let promised = lattice.len().pow(2) as u64 + 255 * 255 * 64;
    if all.points[0] < promised {
        bail!("plane: {} points were tried, {promised} were promised", all.points[0]);
    }
    Ok(all)
}

/// Every `threads`-th row of the lattice, from `part` on; returns progress.
fn lattice_part(found: &mut Swept, lattice: &[f32], part: usize, threads: usize) -> u64 {
    for a in lattice.iter().skip(part).step_by(threads) {
        for b in lattice {
            found.take(*a, *b);
        }
    }
    (1 << 30) / threads as u64
}

/// All pairs of exponents, with even, odd, extreme and random digits.
fn exponents_part(found: &mut Swept, part: usize, threads: usize) -> u64 {
    let mut random = part as u64;
    let mut next = || {
        random = random.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        u32::try_from(random >> 41).expect("23 bits")
    };
    let mut digits = || [0, 1, 0x0040_0000, 0x007f_ffff, next(), next(), next(), next()];
    for ea in (0..255_u32).skip(part).step_by(threads) {
        for eb in 0..255_u32 {
            for ma in digits() {
                for mb in digits() {
                    found.take(f32::from_bits((ea << 23) | ma), f32::from_bits((eb << 23) | mb));
                }
            }
        }
    }
    (1 << 31) / threads as u64
}

/// The critical manifold `b = a²/4` and the seams `b = a²/4 − 1/16` and `b = 1/4`, with neighbors.
fn manifold_part(found: &mut Swept, step: usize, part: usize, threads: usize) {
    let (first, last) = (2_f32.powi(-20).to_bits(), 1e4_f32.to_bits());
    for a in (first..last).step_by(step).skip(part).step_by(threads) {
        let a = f32::from_bits(a);
        let critical = 0.25 * a * a;
        for (b, reach) in [(critical, 64), (critical - 0.0625, 2), (0.25, 2)] {
            for distance in [0, 1, 2, 3, 4, 8, 16, 32, 64].into_iter().filter(|d| *d <= reach && b > 0.0) {
                for bits in [b.to_bits() + distance, b.to_bits().saturating_sub(distance)] {
                    found.take(a, f32::from_bits(bits));
                }
            }
        }
    }
}

/// 0, subnormals, powers of two with neighbors, branch points with neighbors, the largest.
fn lattice() -> BTreeSet<u32> {
    let powers = (0..255_u32).step_by(2).map(|e| e << 23);
    let points = [0.25_f32, 0.0625, 0.5, 1.0, 2.0, 1.118, 300.0, 1e4, 262_144.0, 39.478_417, 1e12, 1e30]
        .map(f32::to_bits);
    let some = [0, 1, 2, 3, 0x0000_ffff, 0x007f_fffe, 0x7f7f_fffe, 0x7f7f_ffff];
    let near = powers.chain(points).flat_map(|m: u32| [m.saturating_sub(1), m, m + 1]);
    near.chain(some).collect()
}
