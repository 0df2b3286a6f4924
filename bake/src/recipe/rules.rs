//! Recipes: what a person may say about a character's flesh, as TOML.

use serde::{Deserialize, Serialize};
use wildmatch::WildMatch;

use crate::Error;

/// Most rules of a recipe that give parameters of their own: with the automatic regions they make 16.
const MOST_RULES: usize = 10;

/// Wishes of a person; the default has none.
///
/// ```
/// let recipe = sinew_bake::recipe::Recipe::from_toml("fox.toml", r#"
///     softness = 0.8            # all flesh moves a fifth less
///     [[rule]]
///     joints = ["tail*"]        # shell patterns, upper and lower case alike
///     region = "tail"
///     frequency = 1.5           # Hz
///     [[rule]]
///     joints = ["*hand*", "*finger*"]
///     softness = 0.0            # follows the skeleton exactly
/// "#)?;
/// assert_eq!(recipe.rules.len(), 2);
/// # Ok::<(), sinew_bake::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Recipe {
    /// File name, for errors and notes.
    #[serde(skip)]
    pub file: String,
    /// Multiplies every softness that is not painted; 0..=10, default 1.
    pub softness: f32,
    /// Multiplies the frequency of every automatic region; 0.1..=10, default 1.
    pub frequency: f32,
    /// Multiplies the damping ratio of every automatic region; 0..=10, default 1.
    pub damping: f32,
    /// Multiplies the gain of every automatic region; 0..=10, default 1.
    pub gain: f32,
    /// Multiplies the largest offset of every automatic region; 0..=10, default 1.
    pub max_offset: f32,
    /// Rules for joints, in order; a later rule overrides an earlier one.
    #[serde(rename = "rule")]
    pub rules: Vec<Rule>,
}

/// A wish for the skin that some joints move. What is not given stays automatic.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Rule {
    /// Names of joints: `*` any letters, `?` one letter, upper and lower case alike.
    pub joints: Vec<String>,
    /// Softness of what these joints alone move, 0..=1; what they share with others is blended.
    pub softness: Option<f32>,
    /// Multiplies the automatic softness, 0..=10.
    pub multiply: Option<f32>,
    /// Name of the region; rules with the same name share one.
    pub region: Option<String>,
    /// Frequency, Hz, 0.1..=30.
    pub frequency: Option<f32>,
    /// Damping ratio, 0..=2.
    pub damping: Option<f32>,
    /// Gain, 0..=10.
    pub gain: Option<f32>,
    /// Largest offset, body sizes, 0..=1.
    pub max_offset: Option<f32>,
}

impl Default for Recipe {
    fn default() -> Self {
        let file = String::new();
        Self {
            file,
            softness: 1.0,
            frequency: 1.0,
            damping: 1.0,
            gain: 1.0,
            max_offset: 1.0,
            rules: Vec::new(),
        }
    }
}

impl Recipe {
    /// Reads a recipe; `file` is its name, for errors.
    ///
    /// # Errors
    ///
    /// [`Error::Unusable`] naming the file, the line or the key, and what to write instead.
    pub fn from_toml(file: &str, text: &str) -> Result<Self, Error> {
        let mut recipe: Self = toml::from_str(text).map_err(|error| {
            let place = error.span().map_or(String::from("content"), |span| {
                let before = text.get(..span.start).unwrap_or(text);
                format!("line {}", before.matches('\n').count() + 1)
            });
            let problem = error.message().replace('\n', " ");
            Error::unusable(file, place, problem, "see the keys in the documentation of recipes")
        })?;
        file.clone_into(&mut recipe.file);
        recipe.check()?;
        Ok(recipe)
    }

    /// Checks that all values are in their ranges.
    ///
    /// # Errors
    ///
    /// [`Error::Unusable`] naming the first key that is out of its range.
    pub fn check(&self) -> Result<(), Error> {
        let keys = [
            ("softness", self.softness, 0.0),
            ("frequency", self.frequency, 0.1),
            ("damping", self.damping, 0.0),
            ("gain", self.gain, 0.0),
            ("max_offset", self.max_offset, 0.0),
        ];
        for (key, value, least) in keys {
            self.in_range(key, value, least, 10.0)?;
        }
        for (n, rule) in self.rules.iter().enumerate() {
            let place = |key: &str| format!("rule {}, {key}", n + 1);
            if rule.joints.is_empty() {
                let remedy = "name at least one joint: joints = [\"tail*\"]";
                return Err(Error::unusable(&self.file, place("joints"), "no joint is named", remedy));
            }
            let keys = [
                ("softness", rule.softness, 0.0, 1.0),
                ("multiply", rule.multiply, 0.0, 10.0),
                ("frequency", rule.frequency, 0.1, 30.0),
                ("damping", rule.damping, 0.0, 2.0),
                ("gain", rule.gain, 0.0, 10.0),
                ("max_offset", rule.max_offset, 0.0, 1.0),
            ];
            for (key, value, least, most) in keys {
                value.map_or(Ok(()), |value| self.in_range(&place(key), value, least, most))?;
            }
        }
        if self.rules.iter().filter(|r| r.tunes()).count() > MOST_RULES {
            let problem = format!("more than {MOST_RULES} rules have parameters of their own");
            return Err(Error::unusable(&self.file, "rule", problem, "give several joints one rule"));
        }
        Ok(())
    }

    fn in_range(&self, place: &str, value: f32, least: f32, most: f32) -> Result<(), Error> {
        if (least..=most).contains(&value) {
            return Ok(());
        }
        let remedy = format!("write a number from {least} to {most}");
        Err(Error::unusable(&self.file, place, format!("{value} is out of range"), remedy))
    }
}

impl Rule {
    /// Whether it gives a region of its own.
    pub(super) fn tunes(&self) -> bool {
        let given = [self.frequency, self.damping, self.gain, self.max_offset];
        self.region.is_some() || given.iter().any(Option::is_some)
    }

    /// Whether it names a joint.
    pub(super) fn names(&self, joint: &str) -> bool {
        let joint = joint.to_lowercase();
        self.joints.iter().any(|pattern| WildMatch::new(&pattern.to_lowercase()).matches(&joint))
    }
}
