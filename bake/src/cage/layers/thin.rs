//! Which parts have no room for layers: hands, feet, head, and whatever else is thin; skinning moves them.

use super::Settings;
use super::skin::Skin;
use crate::Model;
use wildmatch::WildMatch;

/// Parts of less than this share of the triangles go too.
const ISLAND: f64 = 0.01;

/// Whether each triangle of the skin gets prisms.
pub(super) fn kept(model: &Model, skin: &Skin, radii: &[f64], settings: &Settings) -> Vec<bool> {
    let thin_node = thin_nodes(model, &settings.skinned);
    let thin = |i: usize| {
        let held: f64 = skin.weights[i].iter().filter(|(node, _)| thin_node[*node]).map(|(_, w)| w).sum();
        held > 0.5 || radii[i] < settings.thinnest * skin.size
    };
    let thin: Vec<bool> = (0..skin.points.len()).map(thin).collect();
    let mut kept: Vec<bool> = skin.triangles.iter().map(|t| t.iter().all(|i| !thin[*i as usize])).collect();
    drop_islands(skin, &mut kept);
    kept
}

/// Nodes that a pattern names, and all below them.
fn thin_nodes(model: &Model, patterns: &[String]) -> Vec<bool> {
    let patterns: Vec<WildMatch> = patterns.iter().map(|p| WildMatch::new_case_insensitive(p)).collect();
    let named = |node: usize| patterns.iter().any(|p| p.matches(&model.nodes[node].name));
    let below = |node: usize| {
        let mut at = Some(node);
        // Not more steps than nodes: a file's nodes may form a ring.
        for _ in 0..=model.nodes.len() {
            match at {
                Some(n) if named(n) => return true,
                Some(n) => at = model.nodes[n].parent,
                None => return false,
            }
        }
        false
    };
    (0..model.nodes.len()).map(below).collect()
}

/// Takes away small parts that are joined to others by no edge.
fn drop_islands(skin: &Skin, kept: &mut [bool]) {
    #[expect(clippy::cast_precision_loss, reason = "a count")]
    let least = ISLAND * skin.triangles.len() as f64;
    let mut seen = vec![false; kept.len()];
    for start in 0..kept.len() {
        if seen[start] || !kept[start] {
            continue;
        }
        seen[start] = true;
        let (mut part, mut at) = (vec![start], 0);
        while at < part.len() {
            for t in neighbors(skin, part[at]) {
                if kept[t] && !seen[t] {
                    seen[t] = true;
                    part.push(t);
                }
            }
            at += 1;
        }
        #[expect(clippy::cast_precision_loss, reason = "a count")]
        if (part.len() as f64) < least {
            part.into_iter().for_each(|t| kept[t] = false);
        }
    }
}

/// Triangles that share an edge with one.
fn neighbors(skin: &Skin, triangle: usize) -> impl Iterator<Item = usize> {
    let [a, b, c] = skin.triangles[triangle];
    [(a, b), (b, c), (c, a)].into_iter().flat_map(move |(i, j)| {
        let has = move |t: &u32| skin.triangles[*t as usize].contains(&j);
        skin.around[i as usize]
            .iter()
            .copied()
            .filter(has)
            .map(|t| t as usize)
            .filter(move |t| *t != triangle)
    })
}
