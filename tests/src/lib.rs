//! What the tests of sinew share: small characters, handmade bytes, oracles, comparisons.

pub mod asset_bytes;
pub mod fuzz;
pub mod golden;
pub mod oracle;
pub mod probe;
pub mod random;
pub mod recording;
pub mod run;
pub mod special;
pub mod tube;
