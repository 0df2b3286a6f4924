//! What the tests of sinew share: small characters, oracles, comparisons.

pub mod asset_bytes;
pub mod session;
