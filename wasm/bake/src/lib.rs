//! The auto recipe in a browser: characters in, assets out, without a server.
//!
//! A second module, so that a page that has its assets need not load it. What a person uses is
//! `js/bake.js`, written by hand over the functions here.

use js_sys::{Function, Uint8Array};
use sinew_bake::recipe::{Flesh, Recipe, flesh};
use sinew_bake::{Error, Model, builtin, export, import, pack};
use wasm_bindgen::prelude::{JsCast, JsError, JsValue, wasm_bindgen};

/// What came of baking.
#[wasm_bindgen]
#[derive(Debug)]
pub struct RawBaked {
    asset: Vec<u8>,
    glb: Vec<u8>,
    flesh: Flesh,
}

#[wasm_bindgen]
impl RawBaked {
    /// The asset, once: it is handed over.
    pub fn asset(&mut self) -> Vec<u8> {
        core::mem::take(&mut self.asset)
    }

    /// The character as a file, once, where it did not come from one.
    pub fn glb(&mut self) -> Vec<u8> {
        core::mem::take(&mut self.glb)
    }

    /// What a person should know.
    #[must_use]
    pub fn notes(&self) -> Vec<String> {
        self.flesh.notes.clone()
    }

    /// Names of the regions.
    #[must_use]
    pub fn regions(&self) -> Vec<String> {
        self.flesh.regions.iter().map(|region| region.name.clone()).collect()
    }
}

fn baked(model: &Model, recipe: &Recipe, source: u64) -> Result<RawBaked, Error> {
    let flesh = flesh(model, recipe)?;
    Ok(RawBaked { asset: pack::pack(model, &flesh, source)?, glb: Vec::new(), flesh })
}

/// Bakes the bytes of a `.glb`, `.gltf` or `.vrm`.
///
/// `resolve` returns the bytes of a file beside it, or nothing; `recipe` is TOML.
///
/// # Errors
///
/// One line that names the file, the place, the problem and the remedy.
#[wasm_bindgen]
pub fn bake(
    bytes: &[u8],
    name: &str,
    resolve: &Function,
    recipe: Option<String>,
) -> Result<RawBaked, JsError> {
    let recipe = recipe.map_or_else(|| Ok(Recipe::default()), |text| Recipe::from_toml("recipe", &text))?;
    let model = import::import_bytes(name, bytes, &mut |uri| find(name, uri, resolve))?;
    Ok(baked(&model, &recipe, sinew::math::digest::of_bytes(bytes))?)
}

/// Asks JavaScript for a file.
fn find(name: &str, uri: &str, resolve: &Function) -> Result<Vec<u8>, Error> {
    let found = resolve.call1(&JsValue::NULL, &JsValue::from_str(uri)).ok();
    let bytes = found.and_then(|value| value.dyn_into::<Uint8Array>().ok());
    bytes.map(|bytes| bytes.to_vec()).ok_or_else(|| {
        let remedy = "hand it in by `resolve`, or export the character as one .glb";
        Error::unusable(name, uri, "the file beside it is missing", remedy)
    })
}

/// The character that comes with sinew, as a file and baked.
///
/// # Errors
///
/// None is expected.
#[wasm_bindgen(js_name = builtin)]
pub fn builtin_character() -> Result<RawBaked, JsError> {
    let model = builtin::character();
    let glb = export::glb::to_glb(&model)?;
    Ok(RawBaked { glb, ..baked(&model, &Recipe::default(), 0)? })
}
