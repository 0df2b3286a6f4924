//! Skinning, frames and crowds of the built-in character.

use super::best;
use crate::cli::load;
use serde_json::{Value, json};
use sinew::{Character, Pose, Root, step_batch};
use sinew_bake::Error;
use std::path::Path;

/// Sizes of the batches.
const CROWDS: [usize; 3] = [1, 16, 128];

/// CPU skinning with normals, and a whole frame, of the built-in character.
pub(super) fn character(wanted: &impl Fn(&str) -> bool) -> Result<Vec<Value>, Error> {
    let path = Path::new("builtin");
    let model = load::character(path)?;
    let aligned = load::asset(&model, None)?;
    let asset = load::parse(path, &aligned)?;
    let mut memory = vec![0.0; Character::required_len(&asset)];
    let refuse = |e: String| Error::unusable("bench", "character", e, "please report this");
    let mut character = Character::new(asset, &mut memory).map_err(|e| refuse(e.to_string()))?;
    let mut out = Vec::new();
    let mut frame = 0.0_f32;
    let mut failed = None;
    let whole = best(1, || {
        frame += 1.0;
        let stepped = character.step_clip(0, frame / 60.0 % 1.0, Root::default(), 1.0 / 60.0);
        failed = stepped.err().or(failed);
    });
    if let Some(error) = failed {
        return Err(refuse(error.to_string()));
    }
    let vertices = asset.meta.vertices as usize;
    let (mut positions, mut normals) = (vec![[0.0; 3]; vertices], vec![[0.0; 3]; vertices]);
    if wanted("skin") {
        let mut skinned = Ok(());
        let value = best(vertices, || skinned = character.skin_surface(true, &mut positions, &mut normals));
        skinned.map_err(|e| refuse(e.to_string()))?;
        out.push(json!({"name": "skin", "case": "builtin", "value": value, "unit": "ns/vertex",
            "peers": [], "limit": 4.0}));
    }
    if wanted("character-frame") {
        out.push(json!({"name": "character-frame", "case": "builtin", "value": 1e-6 * whole, "unit": "ms",
            "peers": [], "limit": 0.25}));
    }
    Ok(out)
}

/// Batches of the built-in character: what a vertex costs must not depend on how many there are.
pub(super) fn batches() -> Result<Vec<Value>, Error> {
    let path = Path::new("builtin");
    let model = load::character(path)?;
    let aligned = load::asset(&model, None)?;
    CROWDS.iter().map(|count| batch(path, &aligned, *count)).collect()
}

fn batch(path: &Path, aligned: &[u32], count: usize) -> Result<Value, Error> {
    let refuse = |e: String| Error::unusable("bench", "batch", e, "please report this");
    let asset = load::parse(path, aligned)?;
    let vertices = count * asset.meta.vertices as usize;
    let mut memories = vec![vec![0.0; Character::required_len(&asset)]; count];
    let crowd = memories
        .iter_mut()
        .map(|m| Character::new(load::parse(path, aligned)?, m).map_err(|e| refuse(e.to_string())));
    let mut crowd = crowd.collect::<Result<Vec<_>, Error>>()?;
    let mut bones = vec![sinew::math::affine::IDENTITY; asset.joint_from_bind.len()];
    let mut failed = None;
    let value = best(vertices, || {
        bones.iter_mut().for_each(|b| b[3][0] = 0.01 - b[3][0]);
        let poses = vec![Pose { root: Root::default(), root_from_joint: &bones }; count];
        let stepped = step_batch(&mut crowd, &poses, 1.0 / 60.0);
        failed = stepped.map_or_else(|e| Some(e.to_string()), |b| b.refusal.map(|(_, e)| e.to_string()));
    });
    if let Some(error) = failed {
        return Err(refuse(error));
    }
    Ok(json!({"name": "batch", "case": format!("{count} characters"), "value": value, "unit": "ns/vertex",
        "peers": []}))
}
