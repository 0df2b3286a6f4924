//! The command line `sinew`.
fn main() {}
