//! What a person may wish: paint and rules.

use glam::DVec3;
use sinew_bake::recipe::{MANUAL, Recipe, flesh};

use super::{auto, character, extreme, places, refusal};

#[test]
fn paint_overrides_and_is_checked() {
    let Some(mut model) = character("quaternius/Alpaca.glb") else { return };
    let rest = model.rest_positions();
    let top = rest.iter().map(|p| p.y).fold(0.0, f64::max);
    let mut start = 0;
    for primitive in &mut model.primitives {
        let count = primitive.positions.len();
        #[expect(clippy::cast_possible_truncation, reason = "a shade from 0 to 1")]
        let shade = |p: &DVec3| (p.y / top).clamp(0.0, 1.0) as f32;
        primitive.painted = Some(rest[start..start + count].iter().map(shade).collect());
        start += count;
    }
    let flesh = auto(&model);
    for (p, soft) in rest.iter().zip(&flesh.softness) {
        assert!(
            (f64::from(*soft) - (p.y / top).clamp(0.0, 1.0)).abs() < 1e-4,
            "painted softness is used as it is"
        );
    }
    model.primitives[0].painted.as_mut().expect("painted")[3] = f32::NAN;
    let error = refusal(&model);
    assert!(error.contains("vertex 3, _SINEW"), "{error}");
}

#[test]
fn rules_override() {
    let Some(model) = character("khronos/Fox.glb") else { return };
    let text = "softness = 0.5\n[[rule]]\njoints = [\"B_TAIL*\"]\nregion = \"brush\"\nfrequency = 1.25\n\
                [[rule]]\njoints = [\"b_Head_05\"]\nsoftness = 0.0\n[[rule]]\njoints = [\"wing\"]\nsoftness = 1.0\n";
    let recipe = Recipe::from_toml("fox.toml", text).expect("a good recipe");
    let ruled = flesh(&model, &recipe).expect("usable");
    let plain = auto(&model);
    let places = places(&model, &ruled);
    assert!(extreme(&places, DVec3::Y) == 0.0, "ears are rigid by rule");
    assert!((extreme(&places, DVec3::NEG_Z) - 0.5).abs() < 0.06, "the tip of the tail is half as soft");
    let brush = ruled.regions.iter().position(|r| r.name == "brush").expect("the rule's region");
    assert_eq!(ruled.regions[brush].frequency.to_bits(), 1.25_f32.to_bits(), "frequency of the rule");
    let tail = plain.regions.iter().find(|r| r.name == "tail").expect("a tail");
    assert_eq!(ruled.regions[brush].damping.to_bits(), tail.damping.to_bits(), "what is not given stays");
    let used = ruled.region.iter().filter(|r| usize::from(**r) == brush).count();
    assert!(used > 100, "{used} vertices in the region");
    assert!(
        ruled.notes.iter().any(|n| n.contains("fox.toml: rule 3") && n.contains("wing")),
        "{:?}",
        ruled.notes
    );
}

#[test]
fn bad_recipes_are_refused_by_name() {
    let cases = [
        ("softness = -1", "softness"),
        ("gain = nan", "gain"),
        ("\nwobble = 1", "line 2"),
        ("[[rule]]\nsoftness = 0.5", "rule 1, joints"),
        ("[[rule]]\njoints = [\"a\"]\nfrequency = 99", "rule 1, frequency"),
        ("[[rule]]\njoints = 3", "line 2"),
        ("softness =", "line 1"),
    ];
    for (text, place) in cases {
        let error = Recipe::from_toml("r.toml", text).expect_err(text).to_string();
        assert!(error.starts_with("r.toml: ") && error.contains(place), "{text:?}: {error}");
    }
}

#[test]
fn the_manual_has_every_key() {
    let text =
        MANUAL.split("```toml").nth(1).and_then(|t| t.split("```").next()).expect("a recipe in the manual");
    let recipe = Recipe::from_toml("manual", text).expect("a good recipe");
    let defaults = Recipe { file: recipe.file.clone(), rules: recipe.rules.clone(), ..Recipe::default() };
    assert_eq!(recipe, defaults, "the manual's values are the defaults");
    let of_rules = serde_json::to_value(&recipe.rules[0]).expect("a rule is data");
    let given = of_rules.as_object().expect("keys").iter();
    let missing: Vec<&String> = given.filter(|(_, value)| value.is_null()).map(|(key, _)| key).collect();
    assert!(missing.is_empty(), "keys of a rule that the manual leaves out: {missing:?}");
    let all = serde_json::to_value(&recipe).expect("a recipe is data");
    for key in all.as_object().expect("keys").keys().filter(|k| *k != "rule") {
        assert!(text.contains(&format!("\n{key} = ")), "the manual leaves out {key}");
    }
}
