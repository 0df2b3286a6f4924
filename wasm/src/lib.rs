//! wasm-bindgen face of `sinew`. To be written.

use wasm_bindgen::prelude::wasm_bindgen;

/// Version of this build, as in `package.json`.
#[must_use]
#[wasm_bindgen]
pub fn version() -> String {
    env!("CARGO_PKG_VERSION").to_owned()
}
