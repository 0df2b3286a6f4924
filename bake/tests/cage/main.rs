//! Cages of all characters of the shared data, of closed surfaces, and of toys.

#![cfg(feature = "simulate")]
#![expect(clippy::unwrap_used, clippy::print_stdout, reason = "tests")]

mod characters;
mod fitted;
mod shapes;
mod skin;
mod solids;

use glam::DVec3;
use std::path::{Path, PathBuf};

/// A shared file; `None`, with a message, where the data is not at hand, which is a failure on the build machine.
fn shared(file: &str) -> Option<PathBuf> {
    let path = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../shared/data")).join(file);
    if path.exists() {
        return Some(path);
    }
    assert!(std::env::var("CI").as_deref() != Ok("true"), "{} is missing", path.display());
    println!("skipped: {} is not there", path.display());
    None
}

/// Numbers in `0..1`, always the same.
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        f64::from(u32::try_from(self.0 >> 32).unwrap()) / 4_294_967_296.0
    }

    fn point(&mut self, low: DVec3, high: DVec3) -> DVec3 {
        low + (high - low) * DVec3::new(self.next(), self.next(), self.next())
    }
}
