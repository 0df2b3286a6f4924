//! A sweep over bit patterns: every one, or every n-th with all special ones.

use core::sync::atomic::{AtomicU64, Ordering};
use std::collections::BTreeSet;
use std::thread;
use std::time::Instant;

use indicatif::ProgressBar;

use crate::functions::Function;

/// Bit patterns a thread takes at a time.
const BLOCK: u64 = 1 << 20;
/// All bit patterns.
const ALL: u64 = 1 << 32;
/// Inputs remembered whose rounding is wrong.
const REMEMBERED: usize = 1000;

/// What was found of one body.
#[derive(Clone, Debug, Default)]
pub(crate) struct Found {
    /// Largest error, ulp, and the bits of where.
    pub(crate) worst: (f64, u32),
    /// Sum of the errors, ulp.
    pub(crate) sum: f64,
    /// Inputs that are not correctly rounded.
    pub(crate) wrong: u64,
    /// The first of them with the right result: bits of `x` and of `f(x)`.
    pub(crate) examples: BTreeSet<(u32, u32)>,
}

impl Found {
    fn note(&mut self, x: u32, error: f64, nearest: u32, wrong: bool) {
        self.sum += error;
        if error > self.worst.0 {
            self.worst = (error, x);
        }
        if wrong {
            self.wrong += 1;
            if self.examples.len() < REMEMBERED {
                self.examples.insert((x, nearest));
            }
        }
    }

    fn merge(&mut self, other: Self) {
        // Among equals the smaller input, whatever thread was first.
        let order = other.worst.0.total_cmp(&self.worst.0).then(self.worst.1.cmp(&other.worst.1));
        if order.is_gt() {
            self.worst = other.worst;
        }
        self.sum += other.sum;
        self.wrong += other.wrong;
        self.examples.extend(other.examples);
    }
}

/// What was found of a function.
#[derive(Clone, Debug, Default)]
pub(crate) struct Swept {
    /// By `f64`, and by pairs of `f32`.
    pub(crate) bodies: [Found; 2],
    /// Inputs.
    pub(crate) inputs: u64,
    /// Inputs that the reference could not decide.
    pub(crate) undecided: u64,
    /// Seconds.
    pub(crate) seconds: f64,
}

impl Swept {
    /// Both bodies at one input.
    fn take(&mut self, function: &Function, bits: u32) {
        let x = f32::from_bits(bits);
        self.inputs += 1;
        let (value, bound) = (function.reference)(f64::from(x));
        let (mut nearest, mut truth) = (rounded(value * (1.0 - bound)), value);
        if !value.is_nan() && nearest.to_bits() != rounded(value * (1.0 + bound)).to_bits() {
            self.undecided += 1;
            (nearest, truth) = function.nearest(x);
        }
        for (body, found) in function.bodies.iter().zip(&mut self.bodies) {
            let y = body(x);
            let wrong = y.to_bits() != nearest.to_bits() && !(y.is_nan() && nearest.is_nan());
            let error = if y.is_nan() && nearest.is_nan() { 0.0 } else { ulps(y, truth) };
            found.note(bits, error, nearest.to_bits(), wrong);
        }
    }

    fn merge(&mut self, other: Self) {
        for (mine, theirs) in self.bodies.iter_mut().zip(other.bodies) {
            mine.merge(theirs);
        }
        self.inputs += other.inputs;
        self.undecided += other.undecided;
    }
}

#[allow(clippy::cast_possible_truncation, reason = "rounds to nearest")]
fn rounded(x: f64) -> f32 {
    x as f32
}

/// Distance from the truth in units of the grain of `f32` there; infinity counts as 2¹²⁸.
fn ulps(y: f32, truth: f64) -> f64 {
    if y.is_nan() || truth.is_nan() {
        return f64::INFINITY;
    }
    const BEYOND: f64 = 2.0 * (1_u128 << 127) as f64;
    let finite = |x: f64| x.clamp(-BEYOND, BEYOND);
    let exponent = ((truth.abs().to_bits() >> 52).cast_signed() - 1023).clamp(-126, 127);
    (finite(f64::from(y)) - finite(truth)).abs()
        * f64::from_bits(((1023 + 23 - exponent) << 52).cast_unsigned())
}

/// Sweeps over every `2^stride`-th bit pattern and, if that is not every, over the special ones.
pub(crate) fn sweep(function: &Function, stride: u32, progress: &ProgressBar) -> Swept {
    let start = Instant::now();
    let next = AtomicU64::new(0);
    let worker = || {
        let mut mine = Swept::default();
        loop {
            let block = next.fetch_add(BLOCK, Ordering::Relaxed);
            if block >= ALL {
                return mine;
            }
            for bits in (block..block + BLOCK).step_by(1 << stride) {
                #[allow(clippy::cast_possible_truncation, reason = "below 2^32")]
                mine.take(function, bits as u32);
            }
            progress.inc(BLOCK);
        }
    };
    let threads = thread::available_parallelism().map_or(1, usize::from);
    let mut all = Swept::default();
    thread::scope(|scope| {
        let workers: Vec<_> = (0..threads).map(|_| scope.spawn(worker)).collect();
        for worker in workers {
            all.merge(worker.join().expect("a worker does not panic"));
        }
    });
    if stride > 0 {
        for bits in special(function) {
            all.take(function, bits);
        }
    }
    all.seconds = start.elapsed().as_secs_f64();
    all
}

/// Least number of inputs that [`sweep`] must have tried.
pub(crate) fn promised(function: &Function, stride: u32) -> u64 {
    let special = if stride > 0 { special(function).len() as u64 } else { 0 };
    (ALL >> stride) + special
}

/// Special values, every power of two, every branch point and every listed input, each with its neighbors, of both
/// signs.
fn special(function: &Function) -> BTreeSet<u32> {
    /// Quiet and signaling NaN, with payloads.
    const NAN: [u32; 4] = [0x7fc0_0000, 0x7f80_0001, 0x7fff_ffff, 0x7fa5_a5a5];
    let powers = (0..=255_u32).map(|exponent| exponent << 23);
    let middles = (0..255_u32).map(|exponent| (exponent << 23) | 0x0040_0000);
    let branches = function.branches.iter().map(|x| x.to_bits() & 0x7fff_ffff);
    let hard = function.hard.iter().map(|(x, _)| x & 0x7fff_ffff);
    let magnitudes = powers
        .chain(middles)
        .chain(branches)
        .chain(hard)
        .flat_map(|m| (0..9).map(move |d| (m + d).saturating_sub(4)));
    magnitudes.chain(NAN).flat_map(|m| [m & 0x7fff_ffff, m | 0x8000_0000]).collect()
}
