//! The JSON beside an asset, in which a person turns the knobs: `fox.sinew` has `fox.sinew.json`.
//!
//! It names the asset by its content hash; regions are told by their names. A field that is left out has
//! the asset's value.

use crate::Error;
use serde::{Deserialize, Serialize};
use sinew::{Asset, Character, Region, Tunables};

/// The file.
#[derive(Clone, Debug, Deserialize, PartialEq, Serialize)]
#[serde(deny_unknown_fields)]
pub struct TunablesFile {
    /// Content hash of the asset, 16 hexadecimal digits.
    pub asset: String,
    /// The knobs.
    #[serde(default)]
    pub tunables: Knobs,
}

/// All knobs; see [`sinew::Tunables`] for units and ranges.
#[derive(Clone, Debug, Default, Deserialize, PartialEq, Serialize)]
#[serde(deny_unknown_fields, default)]
pub struct Knobs {
    /// Gravity, body sizes per s².
    #[serde(skip_serializing_if = "Option::is_none")]
    pub gravity: Option<[f32; 3]>,
    /// Wind, body sizes per s².
    #[serde(skip_serializing_if = "Option::is_none")]
    pub wind: Option<[f32; 3]>,
    /// Share of the wind in gusts.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub gust: Option<f32>,
    /// Gusts a second.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub gust_rate: Option<f32>,
    /// Share of the root's motion that is felt.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub inertia: Option<f32>,
    /// Factor of all offsets.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub gain: Option<f32>,
    /// Factor of all frequencies.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub frequency: Option<f32>,
    /// Factor of all damping ratios.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub damping: Option<f32>,
    /// Teleport distance, body sizes.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub teleport: Option<f32>,
    /// Longest step, s.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub settle_after: Option<f32>,
    /// Regions by name.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub regions: Vec<RegionKnobs>,
}

/// Knobs of a region.
#[derive(Clone, Debug, Deserialize, PartialEq, Serialize)]
#[serde(deny_unknown_fields)]
pub struct RegionKnobs {
    /// Name of the region in the asset.
    pub name: String,
    /// Frequency, Hz.
    pub frequency: f32,
    /// Damping ratio.
    pub damping: f32,
    /// Factor of the offset.
    pub gain: f32,
    /// Largest offset, body sizes.
    pub max_offset: f32,
}

impl TunablesFile {
    /// The asset's own values.
    #[must_use]
    pub fn of(asset: &Asset<'_>) -> Self {
        let t = Character::default_tunables(asset);
        let named = |(i, r): (usize, &Region)| RegionKnobs {
            name: asset.region_name(i).to_owned(),
            frequency: r.frequency,
            damping: r.damping,
            gain: r.gain,
            max_offset: r.max_offset,
        };
        let knobs = Knobs {
            gravity: Some(t.gravity),
            wind: Some(t.wind),
            gust: Some(t.gust),
            gust_rate: Some(t.gust_rate),
            inertia: Some(t.inertia),
            gain: Some(t.gain),
            frequency: Some(t.frequency),
            damping: Some(t.damping),
            teleport: Some(t.teleport),
            settle_after: Some(t.settle_after),
            regions: t.regions.iter().take(asset.regions.len()).enumerate().map(named).collect(),
        };
        Self { asset: format!("{:016x}", asset.hash), tunables: knobs }
    }

    /// Reads the file `name` for `asset`.
    ///
    /// # Errors
    ///
    /// [`Error::Unusable`] for text that is not such a file, is for another asset, names a region that
    /// the asset has not, or holds a value out of its range.
    pub fn read(name: &str, text: &str, asset: &Asset<'_>) -> Result<Tunables, Error> {
        let file: Self = serde_json::from_str(text).map_err(|e| {
            let place = format!("line {}, column {}", e.line(), e.column());
            Error::unusable(name, place, e.to_string(), "correct it, or delete the file for the baked values")
        })?;
        let hash = format!("{:016x}", asset.hash);
        if file.asset != hash {
            let problem = format!("the tunables are for asset {}, this is {hash}", file.asset);
            return Err(Error::unusable(name, "asset", problem, "bake again, or change the hash by hand"));
        }
        file.tunables.apply(name, asset)
    }
}

impl Knobs {
    fn apply(&self, name: &str, asset: &Asset<'_>) -> Result<Tunables, Error> {
        let mut t = Character::default_tunables(asset);
        t.gravity = self.gravity.unwrap_or(t.gravity);
        t.wind = self.wind.unwrap_or(t.wind);
        t.gust = self.gust.unwrap_or(t.gust);
        t.gust_rate = self.gust_rate.unwrap_or(t.gust_rate);
        t.inertia = self.inertia.unwrap_or(t.inertia);
        t.gain = self.gain.unwrap_or(t.gain);
        t.frequency = self.frequency.unwrap_or(t.frequency);
        t.damping = self.damping.unwrap_or(t.damping);
        t.teleport = self.teleport.unwrap_or(t.teleport);
        t.settle_after = self.settle_after.unwrap_or(t.settle_after);
        for r in &self.regions {
            let i = (0..asset.regions.len()).find(|i| asset.region_name(*i) == r.name).ok_or_else(|| {
                let names: Vec<_> = (0..asset.regions.len()).map(|i| asset.region_name(i)).collect();
                let remedy = format!("the asset has {}", names.join(", "));
                Error::unusable(name, "regions", format!("there is no region `{}`", r.name), remedy)
            })?;
            t.regions[i] =
                Region { frequency: r.frequency, damping: r.damping, gain: r.gain, max_offset: r.max_offset };
        }
        t.validate().map_err(|e| {
            Error::unusable(
                name,
                "tunables",
                e.to_string(),
                "see the ranges in the documentation of Tunables",
            )
            .coded(e.code())
        })?;
        Ok(t)
    }
}
