//! What the tests of sinew share: small characters, oracles, comparisons.

pub mod oracle;
pub mod run;
pub mod tube;
