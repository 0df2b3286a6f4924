//! The command `sinew` as people and scripts meet it: files, exit codes, lines, JSON.

#![cfg(not(target_family = "wasm"))]

mod commands;
mod disk;
mod pictures;
mod refused;
mod report;
mod support;
