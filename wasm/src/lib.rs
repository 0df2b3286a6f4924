//! The face of `sinew` to JavaScript: no logic, only crossings.
//!
//! What a person uses is `js/index.js`, written by hand over the classes here. Arrays do not cross:
//! addresses do, and JavaScript makes views of the module's memory, anew whenever it has grown. So a
//! frame allocates nothing on either side, and no `unsafe` is needed.

pub mod asset;
#[cfg(feature = "bench")]
pub mod bench;
pub mod character;
mod error;
mod memory;
pub mod replay;

use wasm_bindgen::prelude::wasm_bindgen;

/// Small, as everything here; nothing is allocated per frame.
#[cfg(target_arch = "wasm32")]
#[global_allocator]
static ALLOCATOR: rlsf::SmallGlobalTlsf = rlsf::SmallGlobalTlsf::new();

/// Version of this build, as in `package.json`.
#[must_use]
#[wasm_bindgen]
pub fn version() -> String {
    env!("CARGO_PKG_VERSION").to_owned()
}

/// Zero where floats behave as IEEE 754 begins; otherwise one bit a surprise (`sinew::math::canary`).
#[must_use]
#[wasm_bindgen(js_name = floatEnvironment)]
pub fn float_environment() -> u32 {
    sinew::math::canary::float_environment()
}
