//! Layered cages: of bodies whose layers are known, of people, and of what cannot have any.

#![expect(clippy::unwrap_used, clippy::print_stdout, reason = "helpers of tests are tests")]

mod analytic;
mod bodies;
mod body;
mod refused;
