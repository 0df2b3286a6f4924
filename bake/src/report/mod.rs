//! The report of a bake: one page with pictures and figures.

use crate::export::write_bytes;
use crate::recipe::Flesh;
use crate::render::{Camera, Drawn, Look, Scene, png};
use crate::{Error, Model, pack};
use base64::Engine;
use core::fmt::Write;
use glam::DVec3;
use sinew::Asset;
use std::fs;
use std::path::Path;

/// Pixels of a picture.
const SIZE: (usize, usize) = (360, 440);
/// Views: name and azimuth, radians.
const VIEWS: [(&str, f64); 3] = [("front", 0.0), ("side", 1.5), ("back", core::f64::consts::PI)];

/// Writes `index.html` into `folder`: where the flesh is from three sides, regions, sizes.
///
/// # Errors
///
/// [`Error::Write`] when the folder cannot be written, [`Error::Unusable`] for an asset of another version.
pub fn character(model: &Model, flesh: &Flesh, asset: &[u32], folder: &Path) -> Result<(), Error> {
    let asset = Asset::parse(bytemuck::cast_slice(asset)).map_err(|e| {
        Error::unusable(model.name.as_str(), "report", e.to_string(), "bake the character again")
    })?;
    fs::create_dir_all(folder).map_err(|source| Error::Write { path: folder.to_owned(), source })?;
    let html = page(model, flesh, &asset)?;
    write_bytes(&folder.join("index.html"), html.as_bytes())
}

/// One picture as an `<img>`.
fn picture(model: &Model, look: Look<'_>, azimuth: f64, alt: &str) -> Result<String, Error> {
    let wide = model.rest_positions();
    let positions: Vec<[f32; 3]> = wide.iter().map(|p| p.to_array().map(pack::narrow)).collect();
    let mut normals = Vec::new();
    for p in &model.primitives {
        for (n, m) in p.normals.iter().zip(model.rest_blend(p)) {
            let turned = m.transform_vector3(DVec3::from_array(n.map(f64::from))).normalize_or(DVec3::Y);
            normals.push(turned.to_array().map(pack::narrow));
        }
    }
    let nodes = model.rest_transforms();
    let rigid: Vec<_> = model.rigid.iter().map(|r| nodes[r.node]).collect();
    let ground = wide.iter().map(|p| p.y).fold(f64::INFINITY, f64::min);
    #[allow(clippy::cast_precision_loss, reason = "pixels")]
    let camera = Camera::framing(&wide, SIZE.0 as f64 / SIZE.1 as f64, azimuth, 0.12);
    let mut canvas = Scene::canvas(SIZE.0, SIZE.1);
    let drawn = Drawn { positions: &positions, normals: &normals, rigid: &rigid };
    Scene::new(model, ground).draw(&mut canvas, &camera, drawn, look);
    let bytes = png(&canvas.to_rgb(), SIZE.0, SIZE.1)?;
    let data = base64::engine::general_purpose::STANDARD.encode(bytes);
    Ok(format!("<img alt=\"{alt}\" width=\"{}\" src=\"data:image/png;base64,{data}\">", SIZE.0))
}

/// Text that is safe inside HTML.
fn escape(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

fn page(model: &Model, flesh: &Flesh, asset: &Asset<'_>) -> Result<String, Error> {
    let mut heat = String::new();
    let mut plain = String::new();
    for (name, azimuth) in VIEWS {
        heat += &picture(model, Look::Heat(&flesh.softness), azimuth, &format!("softness, {name}"))?;
        plain += &picture(model, Look::Materials, azimuth, name)?;
    }
    let mut regions = String::new();
    for r in &flesh.regions {
        let (name, percent) = (escape(&r.name), 100.0 * r.max_offset);
        let cells = format!("<td>{:.1}<td>{:.2}<td>{:.2}<td>{percent:.0}", r.frequency, r.damping, r.gain);
        // Writing to a string cannot fail.
        let _ = write!(regions, "<tr><td>{name}{cells}");
    }
    let m = &asset.meta;
    let rows = [
        ("render vertices", m.vertices.to_string()),
        ("distinct points", m.points.to_string()),
        ("points with flesh", m.active.to_string()),
        ("joints", m.joints.to_string()),
        ("influences a point", m.stride.to_string()),
        ("clips", m.clips.to_string()),
        ("mirror symmetric", if flesh.mirror.is_some() { "yes" } else { "no" }.to_owned()),
        ("memory of a character", format!("{} kB", 4 * sinew::Character::required_len(asset) / 1000)),
        ("content hash", format!("{:016x}", asset.hash)),
    ];
    let facts: String = rows.iter().map(|(k, v)| format!("<tr><td>{k}<td>{v}")).collect();
    let notes: String = flesh.notes.iter().map(|n| format!("<li>{}", escape(n))).collect();
    Ok(format!(
        "<!doctype html><html lang=\"en\"><meta charset=\"utf-8\">\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"><title>{name}</title>\
         <style>{STYLE}</style><main><h1>{name}</h1><p>Where the flesh is: blue follows the bones, red is softest.</p>\
         <div class=\"row\">{heat}</div><div class=\"row\">{plain}</div><h2>Regions</h2><table><tr><th>region\
         <th>frequency, Hz<th>damping ratio<th>gain<th>largest offset, % of the body{regions}</table>\
         <h2>Asset</h2><table>{facts}</table><ul>{notes}</ul></main></html>\n",
        name = escape(&model.name)
    ))
}

const STYLE: &str = "body{margin:0;background:#f6f7f9;color:#262a34;font:16px/1.5 system-ui,sans-serif}\
main{max-width:1140px;margin:auto;padding:24px}h1{font-size:28px;margin:8px 0}h2{font-size:20px;margin:28px 0 8px}\
.row{display:flex;flex-wrap:wrap;gap:12px;margin:12px 0}img{border-radius:10px;max-width:100%}\
table{border-collapse:collapse;background:#fff;border-radius:8px;overflow:hidden}td,th{padding:6px 14px;text-align:left;\
border-bottom:1px solid #e6e8ee;font-variant-numeric:tabular-nums}@media(prefers-color-scheme:dark){body{background:#15171c;\
color:#e4e6ec}table{background:#1e2128}td,th{border-color:#2c303a}}";
