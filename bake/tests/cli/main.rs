//! The command `sinew` as people and scripts meet it: files, exit codes, lines, JSON.

#![cfg(not(target_family = "wasm"))]

mod cage;
mod commands;
mod disk;
mod pictures;
mod refused;
mod report;
mod simulate;
mod support;
