//! The built-in character.
use crate::Model;
/// The character.
#[must_use]
pub fn character() -> Model {
    Model::default()
}
