//! The finite elements against what mechanics says.

#![expect(
    clippy::expect_used,
    clippy::print_stdout,
    clippy::cast_precision_loss,
    reason = "helpers of tests are tests"
)]

mod beam;
mod contact;
mod laws;
mod linear;
mod modes;
mod newton;
mod shapes;
mod shell;
mod solver;
mod sphere;
mod time;
