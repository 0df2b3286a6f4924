//! A dense layer: `y = σ(N((w·s)·W·q + b))`, `q = round(x/s)`.
//!
//! In this order: `z` to `f32`, rounded to nearest; times `w·s`, a product rounded before; plus `b`; the norm; the
//! activation. Two sizes of one thing: [`Dense`] knows its shape at compile time, [`Layer`] reads it from a file.

use super::dot::{self, MAX_INPUTS};
use super::norm::Norm;
use super::quantize::{quantize, scale_of};
use crate::math::activation::{gelu, tanh};
use core::fmt;

/// What a neuron does to its sum.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Activation {
    /// Nothing.
    #[default]
    Identity,
    /// `max(y, 0)`; 0 for NaN.
    Relu,
    /// Correctly rounded.
    Tanh,
    /// `y·Φ(y)`, correctly rounded.
    Gelu,
}

impl Activation {
    /// Applies it in place.
    #[inline(always)]
    pub fn apply(self, y: &mut [f32]) {
        match self {
            Self::Identity => {}
            Self::Relu => y.iter_mut().for_each(|y| *y = if *y > 0.0 { *y } else { 0.0 }),
            Self::Tanh => y.iter_mut().for_each(|y| *y = tanh(*y)),
            Self::Gelu => y.iter_mut().for_each(|y| *y = gelu(*y)),
        }
    }
}

/// A layer of `IN` inputs and `OUT` outputs.
///
/// # Examples
///
/// ```
/// use sinew::kernel::mlp::{Activation, Dense};
/// // y₀ = 2·x₀ − x₁, y₁ = x₀ for inputs up to 1.27.
/// let layer = Dense {
///     weights: [[100, -50], [50, 0]],
///     row_scale: [0.02, 0.02],
///     bias: [0.0, 0.0],
///     input_scale: 0.01,
///     activation: Activation::Relu,
/// };
/// let y = layer.forward(&[0.5, 0.25]);
/// assert!((y[0] - 0.75).abs() < 1e-6 && (y[1] - 0.5).abs() < 1e-6);
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Dense<const IN: usize, const OUT: usize> {
    /// `W`.
    pub weights: [[i8; IN]; OUT],
    /// `w`: value of a unit of each row's weights.
    pub row_scale: [f32; OUT],
    /// `b`.
    pub bias: [f32; OUT],
    /// `s`: value of a unit of the quantised inputs; inputs beyond 127 of them saturate.
    pub input_scale: f32,
    /// `σ`.
    pub activation: Activation,
}

impl<const IN: usize, const OUT: usize> Dense<IN, OUT> {
    /// `y` of `x`. A layer too wide for int32 sums does not compile.
    #[must_use]
    pub fn forward(&self, x: &[f32; IN]) -> [f32; OUT] {
        const { assert!(IN <= MAX_INPUTS, "sums of so many products overflow") };
        let mut q = [0; IN];
        quantize(x, 1.0 / self.input_scale, &mut q);
        let mut y = [0.0; OUT];
        sums(self.weights.as_flattened(), &q, &mut y);
        scale(&mut y, &self.row_scale, &self.bias, self.input_scale);
        self.activation.apply(&mut y);
        y
    }
}

/// Sums of the rows as floats: up to 2²⁴ exact, beyond to nearest.
#[inline(always)]
fn sums(weights: &[i8], q: &[i8], y: &mut [f32]) {
    #[allow(clippy::cast_precision_loss, reason = "said above")]
    dot::rows(weights, q, |row, z| {
        if let Some(y) = y.get_mut(row) {
            *y = z as f32;
        }
    });
}

/// `(w·s)·z + b`.
#[inline(always)]
fn scale(y: &mut [f32], row_scale: &[f32], bias: &[f32], input_scale: f32) {
    for ((y, w), b) in y.iter_mut().zip(row_scale).zip(bias) {
        *y = (w * input_scale) * *y + b;
    }
}

/// A layer over borrowed weights, checked once.
#[derive(Clone, Copy, Debug)]
pub struct Layer<'a> {
    inputs: usize,
    weights: &'a [i8],
    row_scale: &'a [f32],
    bias: &'a [f32],
    /// `s`, or 0.
    input_scale: f32,
    /// `N`, if any, of as many neurons.
    norm: Option<Norm<'a>>,
    /// `σ`.
    activation: Activation,
}

/// What does not fit in a layer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum ShapeError {
    /// No inputs, or so many that a sum could overflow.
    Inputs(usize),
    /// Weights, scales, biases, a norm's gain or bias: found and expected numbers.
    Numbers([usize; 2]),
}

impl ShapeError {
    /// Name that does not change.
    #[must_use]
    pub const fn code(&self) -> &'static str {
        match self {
            Self::Inputs(_) => "LAYER_INPUTS",
            Self::Numbers(_) => "LAYER_NUMBERS",
        }
    }
}

impl fmt::Display for ShapeError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Inputs(n) => write!(f, "a layer has 1 to {MAX_INPUTS} inputs, not {n}"),
            Self::Numbers([found, expected]) => write!(f, "{found} numbers where the layer has {expected}"),
        }
    }
}

impl core::error::Error for ShapeError {}

impl<'a> Layer<'a> {
    /// A layer of `inputs` inputs and `bias.len()` outputs, without norm or activation.
    ///
    /// `weights`: row by row; `row_scale`, `bias`: one a row; `input_scale`: `s`, where 0 measures it of each input,
    /// `s = max |x|/127`.
    ///
    /// # Errors
    ///
    /// [`ShapeError`] if the lengths do not fit, or a sum of `inputs` products could overflow.
    pub fn new(
        inputs: usize,
        weights: &'a [i8],
        row_scale: &'a [f32],
        bias: &'a [f32],
        input_scale: f32,
    ) -> Result<Self, ShapeError> {
        if inputs == 0 || inputs > MAX_INPUTS {
            return Err(ShapeError::Inputs(inputs));
        }
        let expected = inputs.saturating_mul(bias.len());
        expect(weights.len(), expected)?;
        expect(row_scale.len(), bias.len())?;
        let activation = Activation::Identity;
        Ok(Self { inputs, weights, row_scale, bias, input_scale, norm: None, activation })
    }

    /// The layer with a norm before its activation.
    ///
    /// # Errors
    ///
    /// [`ShapeError`] unless `norm` has a gain and a bias an output.
    pub fn with_norm(self, norm: Norm<'a>) -> Result<Self, ShapeError> {
        expect(norm.gain.len(), self.bias.len())?;
        expect(norm.bias.len(), self.bias.len())?;
        Ok(Self { norm: Some(norm), ..self })
    }

    /// The layer with this activation.
    #[must_use]
    pub fn with_activation(self, activation: Activation) -> Self {
        Self { activation, ..self }
    }

    /// Inputs and outputs.
    #[must_use]
    pub fn shape(&self) -> [usize; 2] {
        [self.inputs, self.bias.len()]
    }

    /// `y` of `x`, by way of the quantised inputs `q`.
    ///
    /// # Errors
    ///
    /// [`ShapeError`] if a length is not that of [`Self::shape`]: `x` and `q` inputs, `y` outputs.
    pub fn forward(&self, x: &[f32], q: &mut [i8], y: &mut [f32]) -> Result<(), ShapeError> {
        let [inputs, outputs] = self.shape();
        expect(x.len(), inputs)?;
        expect(q.len(), inputs)?;
        expect(y.len(), outputs)?;
        let input_scale = if self.input_scale > 0.0 { self.input_scale } else { scale_of(x) };
        quantize(x, 1.0 / input_scale, q);
        sums(self.weights, q, y);
        scale(y, self.row_scale, self.bias, input_scale);
        if let Some(norm) = self.norm {
            norm.apply(y);
        }
        self.activation.apply(y);
        Ok(())
    }
}

fn expect(found: usize, expected: usize) -> Result<(), ShapeError> {
    if found == expected { Ok(()) } else { Err(ShapeError::Numbers([found, expected])) }
}
