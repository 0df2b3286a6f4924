//! Characters and assets from files.

use sinew::{Asset, Tunables};
use sinew_bake::recipe::{Recipe, flesh};
use sinew_bake::tunables::TunablesFile;
use sinew_bake::{Error, Model, builtin, import, pack};
use std::fs;
use std::path::{Path, PathBuf};

/// Name that stands for the built-in character.
const BUILTIN: &str = "builtin";

/// The character of a path; `builtin` is the project's own.
pub(super) fn character(path: &Path) -> Result<Model, Error> {
    if path == Path::new(BUILTIN) { Ok(builtin::character()) } else { import::import(path) }
}

/// The bytes of a file.
pub(super) fn read(path: &Path) -> Result<Vec<u8>, Error> {
    fs::read(path).map_err(|source| Error::Read { path: path.to_owned(), source })
}

/// Digest of the file that a character came from.
pub(super) fn source(path: &Path) -> u64 {
    fs::read(path).map_or(0, |bytes| sinew::math::digest::of_bytes(&bytes))
}

/// Aligned bytes of an asset file, or of the auto recipe's asset where there is none.
pub(super) fn asset(model: &Model, path: Option<&Path>) -> Result<Vec<u32>, Error> {
    match path {
        Some(path) => Ok(pack::align(&read(path)?)),
        None => Ok(pack::align(&pack::pack(model, &flesh(model, &Recipe::default())?, 0)?)),
    }
}

/// The asset in aligned bytes; `name` is for the error.
pub(super) fn parse<'a>(name: &Path, aligned: &'a [u32]) -> Result<Asset<'a>, Error> {
    Asset::parse(bytemuck::cast_slice(aligned)).map_err(|error| {
        Error::unusable(name.display().to_string(), "asset", error.to_string(), "bake the character again")
            .coded(error.code())
    })
}

/// Where the tunables of an asset are kept: `fox.sinew.json` beside `fox.sinew`.
pub(super) fn tunables_path(asset: &Path) -> PathBuf {
    let mut name = asset.as_os_str().to_owned();
    name.push(".json");
    name.into()
}

/// The tunables beside an asset, where there are any.
pub(super) fn tunables(path: Option<&Path>, asset: &Asset<'_>) -> Result<Option<Tunables>, Error> {
    let Some(path) = path.map(tunables_path).filter(|p| p.exists()) else { return Ok(None) };
    let text = fs::read_to_string(&path).map_err(|source| Error::Read { path: path.clone(), source })?;
    TunablesFile::read(&path.display().to_string(), &text, asset).map(Some)
}
