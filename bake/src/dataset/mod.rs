//! Samples of ground truth on the disk: a header, then one chunk a sample, only ever appended to.
//!
//! ```text
//! simulate --shard 0/n ─▶ Writer ─▶ file ─┐
//! simulate --shard 1/n ─▶ Writer ─▶ file ─┼─▶ Reader (one dataset) ─▶ training, or merged into one file
//!                  …                      ┘
//! ```
//!
//! A sample is written whole or not at all: what a killed process or a full disk leaves behind is found by its length
//! and checksum, cut off, and made again by the next run. The bytes are laid out in `docs/dataset.md`.

mod chunk;
mod header;
mod reader;
mod shard;
mod store;
mod writer;

pub use header::{ArrayInfo, Header, VERSION};
pub use reader::{Reader, Sample, merge};
pub use shard::{Shard, ShardError};
pub use store::Store;
pub use writer::{Array, Resumed, Writer};

#[cfg(test)]
mod tests;
