//! From bytes to JSON structure and buffers: GLB chunks, data URIs, files beside the file.

use base64::Engine;
use base64::alphabet::STANDARD;
use base64::engine::{DecodePaddingMode, GeneralPurpose, GeneralPurposeConfig};
use gltf::binary::Glb;
use gltf::json::{Root, Value};
use percent_encoding::percent_decode_str;

use super::source::EXPORT_AGAIN;
use crate::Error;

/// Decoder of data URIs; some exporters leave the padding out.
const BASE64: GeneralPurpose = GeneralPurpose::new(
    &STANDARD,
    GeneralPurposeConfig::new().with_decode_padding_mode(DecodePaddingMode::Indifferent),
);

/// Extensions that a file may require, by prefix: they change how a surface looks, or this importer reads them.
const KNOWN_EXTENSIONS: [&str; 13] = [
    "KHR_mesh_quantization",
    "KHR_materials_",
    "KHR_texture_",
    "EXT_texture_",
    "MSFT_texture_",
    "KHR_lights_",
    "EXT_lights_",
    "KHR_animation_pointer",
    "KHR_node_",
    "KHR_xmp",
    "VRM",
    "ADOBE_materials_",
    "MSFT_lod",
];

/// Structure and binary chunk of a file.
pub(super) fn open<'a>(file: &str, bytes: &'a [u8]) -> Result<(Root, Option<&'a [u8]>), Error> {
    let not_gltf =
        |problem: &str| Error::unusable(file, "start", problem, "hand in a .glb, .gltf or .vrm file");
    if bytes.is_empty() {
        return Err(not_gltf("the file is empty"));
    }
    let (json, binary) = if bytes.starts_with(b"glTF") {
        chunks(file, bytes)?
    } else {
        (bytes.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(bytes), None)
    };
    if !json.trim_ascii_start().starts_with(b"{") {
        return Err(not_gltf("not a glTF file"));
    }
    Ok((parse(file, json)?, binary))
}

/// JSON and binary chunk of a GLB container.
fn chunks<'a>(file: &str, bytes: &'a [u8]) -> Result<(&'a [u8], Option<&'a [u8]>), Error> {
    let broken = |problem: String| {
        Error::unusable(file, "GLB container", problem, "the file may be cut off: copy it again")
    };
    // The crate subtracts the header's size without a check.
    let total = bytes.get(8..12).and_then(|b| b.first_chunk()).map_or(0, |b| u32::from_le_bytes(*b));
    if total < 20 {
        return Err(broken(format!("{} bytes, of which the header claims {total}", bytes.len())));
    }
    let Glb { json, bin, .. } = Glb::from_slice(bytes).map_err(|e| broken(e.to_string()))?;
    let borrowed = |chunk| match chunk {
        std::borrow::Cow::Borrowed(slice) => Some(slice),
        std::borrow::Cow::Owned(_) => None,
    };
    let json: &[u8] = borrowed(json).unwrap_or_default();
    // Some exporters pad with NUL where the format asks for spaces.
    let end = json.iter().rposition(|b| *b != 0).map_or(0, |last| last + 1);
    Ok((&json[..end], bin.and_then(borrowed)))
}

/// Structure of the JSON; refuses other versions and extensions that hide the geometry.
fn parse(file: &str, json: &[u8]) -> Result<Root, Error> {
    let broken = |e: serde_json::Error| Error::unusable(file, "JSON", e.to_string(), EXPORT_AGAIN);
    let mut value: Value = serde_json::from_slice(json).map_err(broken)?;
    let version = value["asset"]["version"].as_str().unwrap_or("missing");
    if !version.starts_with("2.") {
        let problem = format!("the glTF version is {version}, not 2.0");
        return Err(Error::unusable(file, "asset.version", problem, "export as glTF 2.0"));
    }
    for name in value["extensionsRequired"].as_array().into_iter().flatten().filter_map(Value::as_str) {
        if !KNOWN_EXTENSIONS.iter().any(|prefix| name.starts_with(prefix)) {
            let compressed = name.contains("draco") || name.contains("meshopt");
            let remedy =
                if compressed { "export without mesh compression" } else { "export without this extension" };
            let problem = format!("the file requires {name}, which is not supported");
            return Err(Error::unusable(file, "extensionsRequired", problem, remedy));
        }
    }
    drop_channels_without_node(&mut value);
    serde_json::from_value(value).map_err(broken)
}

/// A channel without a node has its target in an extension (materials, lights); the crate's types want a node.
fn drop_channels_without_node(value: &mut Value) {
    let animations = value.get_mut("animations").and_then(Value::as_array_mut);
    for animation in animations.into_iter().flatten() {
        if let Some(channels) = animation.get_mut("channels").and_then(Value::as_array_mut) {
            channels.retain(|channel| !channel["target"]["node"].is_null());
        }
    }
}

/// Bytes of all buffers, each as long as the file says.
pub(super) fn load_buffers(
    file: &str,
    root: &Root,
    binary: Option<&[u8]>,
    resolve: &mut dyn FnMut(&str) -> Result<Vec<u8>, Error>,
) -> Result<Vec<Option<Vec<u8>>>, Error> {
    let mut buffers = Vec::with_capacity(root.buffers.len());
    for (index, buffer) in root.buffers.iter().enumerate() {
        let place = format!("buffer {index}");
        let bytes = match &buffer.uri {
            Some(uri) => Some(load(file, &place, uri, resolve)?),
            None if index == 0 => binary.map(<[u8]>::to_vec),
            // A place for decompressed data; an error where something refers to it.
            None => None,
        };
        if let Some(bytes) = &bytes
            && (bytes.len() as u64) < buffer.byte_length.0
        {
            let problem = format!("{} bytes where the file promises {}", bytes.len(), buffer.byte_length.0);
            return Err(Error::unusable(file, place, problem, "the file may be cut off: copy it again"));
        }
        buffers.push(bytes);
    }
    Ok(buffers)
}

/// Bytes that a URI stands for.
pub(super) fn load(
    file: &str,
    place: &str,
    uri: &str,
    resolve: &mut dyn FnMut(&str) -> Result<Vec<u8>, Error>,
) -> Result<Vec<u8>, Error> {
    let bad = |problem: &str, remedy: &str| Error::unusable(file, place, problem, remedy);
    if let Some(data) = uri.strip_prefix("data:") {
        let (kind, payload) =
            data.split_once(',').ok_or_else(|| bad("its data URI has no comma", EXPORT_AGAIN))?;
        if kind.ends_with(";base64") {
            return BASE64.decode(payload).map_err(|e| bad(&format!("its data URI: {e}"), EXPORT_AGAIN));
        }
        return Ok(percent_decode_str(payload).collect());
    }
    if uri.contains("://") {
        return Err(bad("it lies on the network", "download it and refer to it by a relative path"));
    }
    let path =
        percent_decode_str(uri).decode_utf8().map_err(|_| bad("its URI is not UTF-8", EXPORT_AGAIN))?;
    resolve(&path)
}
