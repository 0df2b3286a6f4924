//! glTF 2.0 and VRM files to [`Model`].
//!
//! The crate `gltf` gives the structure of the JSON; bytes are read by `accessor`, which checks every range
//! before it reads, since nothing in a file can be trusted. What a file may not need is left alone: cameras,
//! lights, morph targets, points and lines.
//!
//! ```text
//! bytes ─▶ container (GLB, JSON, buffers) ─▶ Source ─▶ node, skin, mesh, material, animation, vrm ─▶ Model
//! ```

mod accessor;
mod animation;
mod container;
mod influences;
mod material;
mod mesh;
mod node;
mod normal;
mod skin;
mod source;
mod vrm;

use std::path::Path;

use crate::{Error, Model};
use source::Source;

/// Reads a character from a `.glb`, `.gltf` or `.vrm` file; buffers and textures outside the file are looked
/// for beside it.
///
/// # Errors
///
/// [`Error::Read`] if the file or one of its buffers cannot be read; [`Error::Unusable`] if the content is not a
/// glTF 2.0 file, is damaged, needs an extension that is not known here, or if no mesh has a skin.
pub fn import(path: &Path) -> Result<Model, Error> {
    let read =
        |path: &Path| std::fs::read(path).map_err(|source| Error::Read { path: path.to_path_buf(), source });
    let bytes = read(path)?;
    let folder = path.parent().unwrap_or(Path::new(""));
    import_bytes(&path.display().to_string(), &bytes, &mut |uri| read(&folder.join(uri)))
}

/// Reads a character from the bytes of a `.glb`, `.gltf` or `.vrm` file; touches no file system.
///
/// `name` is the file's name, for errors and for [`Model::name`] (its stem). `resolve` returns the bytes of a
/// buffer or texture outside the file; it is handed the relative path, percent-decoded.
///
/// # Errors
///
/// As [`import`]; what `resolve` returns for a buffer is passed on. A texture that it cannot find is left out.
pub fn import_bytes(
    name: &str,
    bytes: &[u8],
    resolve: &mut dyn FnMut(&str) -> Result<Vec<u8>, Error>,
) -> Result<Model, Error> {
    let source = Source::open(name, bytes, resolve)?;
    let nodes = node::read(&source)?;
    let shown = node::shown(&source, &nodes)?;
    let skins = skin::read(&source)?;
    let (primitives, rigid) = mesh::read(&source, &shown, &skins.rows)?;
    if primitives.is_empty() {
        return Err(Error::unusable(
            name,
            "meshes",
            "no mesh has a skin",
            "export the character with its armature (joints and weights)",
        ));
    }
    Ok(Model {
        name: stem(name),
        vrm: vrm::read(&source, &nodes),
        clips: animation::read(&source)?,
        materials: material::read(&source, resolve)?,
        joints: skins.joints,
        nodes,
        primitives,
        rigid,
    })
}

/// File name without folders and extension.
fn stem(name: &str) -> String {
    Path::new(name).file_stem().map_or_else(|| name.to_owned(), |s| s.to_string_lossy().into_owned())
}
