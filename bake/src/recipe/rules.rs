//! The recipe file: knobs over the automatic choice, in TOML.
//!
//! ```toml
//! softness = 1.0        # factor of all softness, 0..=1 (default 1)
//! frequency = 1.0       # factor of all frequencies (default 1)
//! damping = 0.22        # damping ratio (default: chosen)
//! gain = 1.0            # factor of all offsets (default 1)
//!
//! [[rule]]
//! joints = ["tail*", "Ear?"]   # names of joints; * any text, ? one character, case does not matter
//! softness = 1.0               # softness of what they move, 0..=1
//! frequency = 1.8              # Hz, of regions named after them
//! ```

use super::region::Region;
use super::surface::Surface;
use crate::{Error, Model};
use serde::Deserialize;

/// A recipe; [`Recipe::default`] is fully automatic.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields, default)]
pub struct Recipe {
    /// Factor of all softness, `0..=1`.
    pub softness: f32,
    /// Factor of all frequencies, above 0.
    pub frequency: f32,
    /// Damping ratio, where it is not to be chosen.
    pub damping: Option<f32>,
    /// Factor of all offsets, not negative.
    pub gain: f32,
    /// Rules by joint name, later ones override earlier ones.
    #[serde(rename = "rule")]
    pub rules: Vec<Rule>,
}

impl Default for Recipe {
    fn default() -> Self {
        Self { softness: 1.0, frequency: 1.0, damping: None, gain: 1.0, rules: Vec::new() }
    }
}

/// A rule for joints by name.
#[derive(Clone, Debug, Default, Deserialize, PartialEq)]
#[serde(deny_unknown_fields, default)]
pub struct Rule {
    /// Patterns of joint names.
    pub joints: Vec<String>,
    /// Softness of what the joints move, `0..=1`.
    pub softness: Option<f32>,
    /// Frequency, Hz.
    pub frequency: Option<f32>,
    /// Damping ratio.
    pub damping: Option<f32>,
    /// Factor of the offset.
    pub gain: Option<f32>,
}

impl Recipe {
    /// Reads a recipe file called `name`.
    ///
    /// # Errors
    ///
    /// [`Error::Unusable`] for text that is no recipe, or numbers out of range.
    pub fn from_toml(name: &str, text: &str) -> Result<Self, Error> {
        let recipe: Self = toml::from_str(text).map_err(|e| {
            let line = e.span().map_or(1, |s| text.get(..s.start).unwrap_or("").lines().count().max(1));
            Error::unusable(
                name,
                format!("line {line}"),
                e.message().to_owned(),
                "see the knobs in the manual",
            )
        })?;
        let refuse = |place: String, range: &str| {
            Err(Error::unusable(name, place, "the value is out of range", format!("give {range}")))
        };
        let in_unit = |x: f32| (0.0..=1.0).contains(&x);
        if !in_unit(recipe.softness) {
            return refuse("softness".into(), "0 to 1");
        }
        if !(recipe.frequency > 0.0 && recipe.frequency <= 20.0) {
            return refuse("frequency".into(), "a factor above 0, at most 20");
        }
        for (i, rule) in recipe.rules.iter().enumerate() {
            if rule.joints.is_empty() {
                return refuse(format!("rule {i}, joints"), "at least one joint name");
            }
            if !rule.softness.is_none_or(in_unit) {
                return refuse(format!("rule {i}, softness"), "0 to 1");
            }
            if !rule.frequency.is_none_or(|f| (0.0..=60.0).contains(&f)) {
                return refuse(format!("rule {i}, frequency"), "0 to 60 Hz");
            }
        }
        let factors =
            recipe.rules.iter().flat_map(|r| [r.damping, r.gain]).chain([recipe.damping, Some(recipe.gain)]);
        if !factors.flatten().all(|x| (0.0..=100.0).contains(&x)) {
            return refuse("damping and gain".into(), "0 to 100");
        }
        Ok(recipe)
    }

    /// Applies the parameters to a region.
    pub(super) fn tune(&self, region: &mut Region) {
        region.frequency *= self.frequency;
        region.damping = self.damping.unwrap_or(region.damping);
        region.gain *= self.gain;
        for rule in self.rules.iter().filter(|r| r.matches(&region.name)) {
            region.frequency = rule.frequency.unwrap_or(region.frequency);
            region.damping = rule.damping.unwrap_or(region.damping);
            region.gain = rule.gain.unwrap_or(region.gain);
        }
    }
}

impl Rule {
    fn matches(&self, name: &str) -> bool {
        self.joints.iter().any(|pattern| glob(&pattern.to_lowercase(), &name.to_lowercase()))
    }
}

/// Whether `name` fits `pattern` with `*` and `?`.
fn glob(pattern: &str, name: &str) -> bool {
    let mut rest = pattern.chars();
    match rest.next() {
        None => name.is_empty(),
        Some('*') => {
            name.char_indices().map(|(i, _)| i).chain([name.len()]).any(|i| glob(rest.as_str(), &name[i..]))
        }
        Some(c) => {
            let mut chars = name.chars();
            chars.next().is_some_and(|n| c == '?' || c == n) && glob(rest.as_str(), chars.as_str())
        }
    }
}

/// Mixes the softness of each point with what the rules say of its joints, by their weights.
pub(super) fn apply(model: &Model, surface: &Surface, recipe: &Recipe, softness: &mut [f64]) {
    let rule_of = |joint: usize| {
        let name = &model.nodes[model.joints[joint].node].name;
        recipe.rules.iter().rev().filter(|r| r.matches(name)).find_map(|r| r.softness)
    };
    let of_joint: Vec<Option<f32>> = (0..model.joints.len()).map(rule_of).collect();
    for (s, weights) in softness.iter_mut().zip(&surface.weights) {
        let chosen = *s;
        *s = weights.iter().map(|(j, w)| w * of_joint[*j].map_or(chosen, f64::from)).sum();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn patterns_fit_names() {
        for (pattern, name, fits) in
            [("tail*", "tail_03", true), ("*ear?", "leftearl", true), ("ear", "ears", false), ("*", "", true)]
        {
            assert_eq!(glob(pattern, name), fits, "{pattern} {name}");
        }
    }

    #[test]
    fn bad_recipes_name_the_place() {
        for (text, place) in [
            ("softness = 2.0", "softness"),
            ("sofness = 1.0", "line 1"),
            ("\n[[rule]]\nsoftness = 0.5", "rule 0, joints"),
            ("[[rule]]\njoints = [\"a\"]\nfrequency = -1.0", "rule 0, frequency"),
        ] {
            let error = Recipe::from_toml("r.toml", text).unwrap_err().to_string();
            assert!(error.contains("r.toml") && error.contains(place), "{error}");
        }
        assert!(
            Recipe::from_toml("r.toml", "damping = 0.3\n[[rule]]\njoints = ['tail*']\nsoftness = 1").is_ok()
        );
    }
}
