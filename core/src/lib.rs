//! draft
#![no_std]
pub mod kernel;
mod lanes;
pub mod math;
