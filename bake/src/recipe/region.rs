//! Regions: parts of the flesh that swing with the same frequency, damping and gain.

use serde::{Deserialize, Serialize};

use super::field::{Field, Label};
use super::mirror::Symmetry;
use super::rules::Recipe;
use super::skeleton::Skeleton;
use super::smooth::Piece;
use super::surface::{Surface, shells};
use crate::Model;

/// Parameters of a part of the flesh.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Region {
    /// `flesh`, `limb`, `tail`, `ear`, `crest`, or a rule's.
    pub name: String,
    /// Frequency of the free swing, Hz.
    pub frequency: f32,
    /// Damping ratio: 0 swings for ever, 1 returns without swinging.
    pub damping: f32,
    /// Multiplies the offset.
    pub gain: f32,
    /// Largest offset, body sizes.
    pub max_offset: f32,
}

/// Regions, and the one of each point.
#[derive(Debug, Default)]
pub(super) struct Regions {
    pub(super) list: Vec<Region>,
    pub(super) of: Vec<u8>,
}

impl Regions {
    /// Flesh of the body, and one region for each kind of appendage.
    pub(super) fn new(skeleton: &Skeleton, field: &Field, symmetry: &Symmetry, pieces: &[Piece]) -> Self {
        let mut lengths: Vec<(&str, Vec<f64>)> = Vec::new();
        let mut number = |name, length| {
            let known = lengths.iter().position(|(n, _)| *n == name);
            let at = known.unwrap_or_else(|| {
                lengths.push((name, Vec::new()));
                lengths.len() - 1
            });
            lengths[at].1.push(length);
            at + 1
        };
        let chains: Vec<usize> =
            skeleton.chains.iter().map(|c| number(if c.ear { "ear" } else { "tail" }, c.length)).collect();
        let protrusions: Vec<usize> = (0..field.protrusions.len())
            .map(|k| {
                number(if field.protrusions[k].paired { "ear" } else { "crest" }, field.protrusions[k].length)
            })
            .collect();
        let of = field.label.iter().map(|label| match label {
            Label::Body => 0,
            Label::Chain(k) => chains[*k],
            Label::Protrusion(k) => protrusions[*k],
        });
        #[expect(clippy::cast_possible_truncation, reason = "at most four kinds of region")]
        let mut of: Vec<u8> = of.map(|n| n as u8).collect();
        for (i, j) in symmetry.partner.iter().enumerate() {
            of[i] = of[i].max(of[*j]);
        }
        for piece in pieces {
            let region = piece.decided_by.first().map_or(0, |i| of[*i]);
            piece.points.iter().for_each(|i| of[*i] = region);
        }
        let mut list = vec![flesh(field.depth)];
        #[expect(clippy::cast_precision_loss, reason = "a mean over a count")]
        list.extend(lengths.iter().map(|(n, l)| appendage(n, l.iter().sum::<f64>() / l.len() as f64)));
        Self { list, of }
    }

    /// Applies the parameters of a recipe; points that a rule's joints move by more than half are its region.
    pub(super) fn apply(&mut self, recipe: &Recipe, shares: &[Vec<f64>]) {
        for region in &mut self.list {
            region.frequency *= recipe.frequency;
            region.damping *= recipe.damping;
            region.gain *= recipe.gain;
            region.max_offset *= recipe.max_offset;
        }
        for (n, (rule, share)) in recipe.rules.iter().zip(shares).enumerate().filter(|(_, (r, _))| r.tunes())
        {
            let Some(first) = share.iter().position(|s| *s > 0.5) else { continue };
            let name = rule.region.clone().unwrap_or_else(|| format!("rule {}", n + 1));
            let automatic = self.list[usize::from(self.of[first])].clone();
            let known = (0..self.list.len()).find(|r| self.list[*r].name == name);
            let at = known.unwrap_or_else(|| {
                self.list.push(Region { name, ..automatic });
                self.list.len() - 1
            });
            let region = &mut self.list[at];
            region.frequency = rule.frequency.unwrap_or(region.frequency);
            region.damping = rule.damping.unwrap_or(region.damping);
            region.gain = rule.gain.unwrap_or(region.gain);
            region.max_offset = rule.max_offset.unwrap_or(region.max_offset);
            #[expect(clippy::cast_possible_truncation, reason = "at most 16 regions")]
            let at = at as u8;
            self.of.iter_mut().zip(share).filter(|(_, s)| **s > 0.5).for_each(|(r, _)| *r = at);
        }
    }

    /// Makes islands of flesh on limbs, cut off from the trunk by what is rigid, a region: tight flesh is quicker.
    pub(super) fn split_limbs(&mut self, surface: &Surface, field: &Field, recipe: &Recipe, soft: &[f64]) {
        let inside = |i: usize| soft[i] > 0.0 && self.of[i] == 0;
        let link = |i: usize| {
            let row = surface.links[i].iter().copied();
            if inside(i) { row.filter(|(j, _)| inside(*j)).collect() } else { Vec::new() }
        };
        let links: Vec<Vec<(usize, f64)>> = (0..soft.len()).map(link).collect();
        let (island, count) = shells(&links);
        let mut limb = vec![0.0; count];
        let mut all = vec![0.0; count];
        for (i, n) in island.iter().enumerate() {
            limb[*n] += field.limb[i] * surface.area[i] * soft[i];
            all[*n] += surface.area[i] * soft[i];
        }
        let on_limb: Vec<usize> =
            (0..soft.len()).filter(|i| inside(*i) && limb[island[*i]] > 0.95 * all[island[*i]]).collect();
        if on_limb.is_empty() || self.list.len() > 15 {
            return;
        }
        let body = &self.list[0];
        let limb = Region {
            name: String::from("limb"),
            frequency: 3.4 * recipe.frequency,
            damping: 0.4 * recipe.damping,
            max_offset: body.max_offset * 0.5,
            ..body.clone()
        };
        #[expect(clippy::cast_possible_truncation, reason = "at most 16 regions")]
        let at = self.list.len() as u8;
        self.list.push(limb);
        on_limb.into_iter().for_each(|i| self.of[i] = at);
    }
}

impl Regions {
    /// Drops regions without points; the body's stays.
    pub(super) fn drop_unused(&mut self) {
        let mut number = vec![0; self.list.len()];
        let mut kept = Vec::new();
        for (at, region) in self.list.drain(..).enumerate() {
            number[at] = kept.len();
            if at == 0 || self.of.iter().any(|r| usize::from(*r) == at) {
                kept.push(region);
            }
        }
        self.list = kept;
        #[expect(clippy::cast_possible_truncation, reason = "at most 16 regions")]
        self.of.iter_mut().for_each(|r| *r = number[usize::from(*r)] as u8);
    }
}

/// Points that a recipe's rules are about, rule by rule: share of each point.
pub(super) fn shares(model: &Model, surface: &Surface, recipe: &Recipe) -> Vec<Vec<f64>> {
    let of_rule = |rule: &super::rules::Rule| {
        let named: Vec<bool> = model.nodes.iter().map(|n| rule.names(&n.name)).collect();
        let held = |row: &Vec<(usize, f64)>| row.iter().filter(|(n, _)| named[*n]).map(|(_, w)| *w).sum();
        surface.weights.iter().map(held).collect()
    };
    recipe.rules.iter().map(of_rule).collect()
}

/// The trunk's flesh: the deeper the slower; lean bodies swing less.
fn flesh(depth: f64) -> Region {
    #[expect(clippy::cast_possible_truncation, reason = "parameters are f32")]
    let gain = (depth / 0.11).clamp(0.4, 1.0) as f32;
    Region { gain, ..region("flesh", (3.0 - 6.0 * depth).clamp(1.8, 2.8), 0.28, 0.3 * depth) }
}

/// Something that sticks out: the longer the slower.
fn appendage(name: &str, length: f64) -> Region {
    match name {
        "tail" => region(name, (2.6 - 2.5 * length).clamp(1.5, 2.4), 0.2, 0.3 * length),
        _ => region(name, (3.6 - 6.0 * length).clamp(1.8, 3.4), 0.22, 0.35 * length),
    }
}

#[expect(clippy::cast_possible_truncation, reason = "parameters are f32")]
fn region(name: &str, frequency: f64, damping: f64, max_offset: f64) -> Region {
    let (frequency, damping, max_offset) = (frequency as f32, damping as f32, max_offset as f32);
    Region { name: name.to_owned(), frequency, damping, gain: 1.0, max_offset }
}
