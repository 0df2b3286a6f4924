//! The character of the golden frames.

use sinew_bake::recipe::{Recipe, flesh};
use sinew_bake::{builtin, pack};

/// The built-in character's asset.
///
/// # Panics
///
/// If he cannot be baked.
#[must_use]
pub fn asset() -> Vec<u8> {
    let model = builtin::character();
    let flesh = flesh(&model, &Recipe::default()).expect("flesh");
    pack::pack(&model, &flesh, 0).expect("an asset")
}
