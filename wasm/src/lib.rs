//! wasm-bindgen face of `sinew`. To be written.

use wasm_bindgen::prelude::wasm_bindgen;

/// Version of this build, as in `package.json`.
#[must_use]
#[wasm_bindgen]
pub fn version() -> String {
    env!("CARGO_PKG_VERSION").to_owned()
}

/// Sum of `words`, wrapping: the least that is compiled to vector instructions where there are any.
#[must_use]
#[wasm_bindgen]
pub fn sum(words: &[u32]) -> u32 {
    words.iter().fold(0, |sum, word| sum.wrapping_add(*word))
}
