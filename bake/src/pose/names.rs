//! Which joint is which, by its name.
//!
//! Names are cut into words (`mixamorig:LeftUpLeg`, `upper_arm.l_Armature`, `lShldr`, `J_Bip_L_UpperArm`); sides and
//! words that say nothing are taken out, and what is left is looked up. Some words mean one joint in one convention
//! and the next in another: they take what plainer names have left over.

use std::collections::BTreeMap;

/// A joint of a body with two arms and two legs.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Role {
    /// What legs and spine hang on.
    Hips,
    /// Joints from the hips to the neck, the lowest first.
    Spine(u8),
    /// The lowest joint of the neck.
    Neck,
    /// The head.
    Head,
    /// Of one side.
    Of(Side, Limb),
}

/// A side of the body.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Side {
    /// The character's own left.
    Left,
    /// The character's own right.
    Right,
}

/// A joint of an arm or a leg.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Limb {
    /// Shoulder blade.
    Collar,
    /// Upper arm.
    Arm,
    /// Forearm.
    Forearm,
    /// Hand.
    Hand,
    /// Thigh.
    Thigh,
    /// Shin.
    Shin,
    /// Foot.
    Foot,
    /// Toes.
    Toes,
}

/// Words that say nothing.
const NOTHING: [&str; 8] = ["mixamorig", "armature", "j", "bip", "def", "org", "bone", "c"];
/// What a name without a side means.
const MIDDLE: [(&str, Role); 6] = [
    ("hips", Role::Hips),
    ("hip", Role::Hips),
    ("pelvis", Role::Hips),
    ("neck", Role::Neck),
    ("lowerneck", Role::Neck),
    ("head", Role::Head),
];
/// What a name with a side means.
const LIMBS: [(&str, Limb); 30] = [
    ("collar", Limb::Collar),
    ("clavicle", Limb::Collar),
    ("shldr", Limb::Arm),
    ("arm", Limb::Arm),
    ("upperarm", Limb::Arm),
    ("uparm", Limb::Arm),
    ("forearm", Limb::Forearm),
    ("lowerarm", Limb::Forearm),
    ("lowarm", Limb::Forearm),
    ("elbow", Limb::Forearm),
    ("hand", Limb::Hand),
    ("thigh", Limb::Thigh),
    ("upperleg", Limb::Thigh),
    ("upleg", Limb::Thigh),
    ("shin", Limb::Shin),
    ("calf", Limb::Shin),
    ("lowerleg", Limb::Shin),
    ("knee", Limb::Shin),
    ("foot", Limb::Foot),
    ("toes", Limb::Toes),
    ("toe", Limb::Toes),
    ("toebase", Limb::Toes),
    ("ball", Limb::Toes),
    // Of two meanings: these come last, and take the first that is free.
    ("shoulder", Limb::Collar),
    ("shoulder", Limb::Arm),
    ("leg", Limb::Shin),
    ("leg", Limb::Thigh),
    ("hip", Limb::Thigh),
    ("wrist", Limb::Hand),
    ("ankle", Limb::Foot),
];
/// The first entry of [`LIMBS`] whose word has more than one meaning.
const AMBIGUOUS: usize = 23;

/// Joints by role, of a skeleton of names and parents; parents come first or not.
#[must_use]
pub fn roles(names: &[&str], parents: &[Option<usize>]) -> BTreeMap<Role, usize> {
    let words: Vec<(Option<Side>, String)> = names.iter().map(|n| meaning(n)).collect();
    let mut order: Vec<usize> = (0..names.len()).collect();
    order.sort_by_key(|i| (ancestors(*i, parents).len(), *i));
    let mut out = BTreeMap::new();
    for (word, role) in MIDDLE {
        let found = order.iter().find(|i| words[**i] == (None, word.to_owned()));
        found.map(|i| *out.entry(role).or_insert(*i));
    }
    for (number, (word, limb)) in LIMBS.into_iter().enumerate() {
        for side in [Side::Left, Side::Right] {
            let role = Role::Of(side, limb);
            let taken = |i: &usize| number >= AMBIGUOUS && out.values().any(|j| j == i);
            let found =
                order.iter().find(|i| words[**i] == (Some(side), word.to_owned()) && !taken(i)).copied();
            if let Some(i) = found {
                out.entry(role).or_insert(i);
            }
        }
    }
    spine(&mut out, parents);
    out
}

/// Adds what is between the hips and the neck.
fn spine(out: &mut BTreeMap<Role, usize>, parents: &[Option<usize>]) {
    let (Some(&hips), Some(&top)) =
        (out.get(&Role::Hips), out.get(&Role::Neck).or_else(|| out.get(&Role::Head)))
    else {
        return;
    };
    let mut path: Vec<usize> = ancestors(top, parents).into_iter().take_while(|i| *i != hips).collect();
    path.reverse();
    for (k, i) in (0_u8..).zip(path) {
        out.insert(Role::Spine(k), i);
    }
}

/// Those above a joint, the nearest first; a cycle is cut.
fn ancestors(i: usize, parents: &[Option<usize>]) -> Vec<usize> {
    core::iter::successors(parents[i], |p| parents[*p]).take(parents.len()).collect()
}

/// Side and word of a name.
fn meaning(name: &str) -> (Option<Side>, String) {
    let mut side = None;
    let mut rest = String::new();
    for word in words(name) {
        match word.as_str() {
            "l" | "left" => side = Some(Side::Left),
            "r" | "right" => side = Some(Side::Right),
            word if NOTHING.contains(&word) => {}
            word => rest.push_str(word),
        }
    }
    // `rhand`: a side that nothing sets apart.
    let glued = |letter: char| rest.strip_prefix(letter).filter(|r| LIMBS.iter().any(|(w, _)| w == r));
    if side.is_none()
        && let Some((of, word)) =
            glued('l').map(|w| (Side::Left, w)).or_else(|| glued('r').map(|w| (Side::Right, w)))
    {
        return (Some(of), word.to_owned());
    }
    (side, rest)
}

/// Words of a name in lower case; numbers are left out.
fn words(name: &str) -> Vec<String> {
    let letters: Vec<char> = name.chars().collect();
    let (mut out, mut word) = (Vec::new(), String::new());
    for (k, c) in letters.iter().enumerate() {
        let before = k.checked_sub(1).map(|k| letters[k]);
        let after = letters.get(k + 1);
        let begins = c.is_uppercase()
            && (before.is_some_and(char::is_lowercase)
                || (before.is_some_and(char::is_uppercase) && after.is_some_and(|c| c.is_lowercase())));
        if (begins || !c.is_alphabetic()) && !word.is_empty() {
            out.push(core::mem::take(&mut word));
        }
        if c.is_alphabetic() {
            word.extend(c.to_lowercase());
        }
    }
    out.extend((!word.is_empty()).then_some(word));
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_many_conventions_are_understood() {
        let left = |w: &str| (Some(Side::Left), w.to_owned());
        let right = |w: &str| (Some(Side::Right), w.to_owned());
        for (name, expected) in [
            ("mixamorig:LeftUpLeg", left("upleg")),
            ("upper_arm.l_Armature", left("upperarm")),
            ("lShldr", left("shldr")),
            ("J_Bip_R_UpperArm", right("upperarm")),
            ("rhand", right("hand")),
            ("LHipJoint", left("hipjoint")),
            ("LeftHip", left("hip")),
            ("neck_01", (None, "neck".to_owned())),
            ("pelvis", (None, "pelvis".to_owned())),
            ("leg", (None, "leg".to_owned())),
            ("LowerLeg.R", right("lowerleg")),
        ] {
            assert_eq!(meaning(name), expected, "{name}");
        }
    }

    /// Roles of a chain of names, each the child of that before.
    fn chain(names: &[&str]) -> Vec<(Role, usize)> {
        let parents: Vec<Option<usize>> = (0..names.len()).map(|i| i.checked_sub(1)).collect();
        roles(names, &parents).into_iter().collect()
    }

    #[test]
    fn words_of_two_meanings_take_what_is_left() {
        use Limb::{Arm, Collar, Forearm, Hand, Shin, Thigh};
        let left = |limb| Role::Of(Side::Left, limb);
        let arm = chain(&["LeftShoulder", "LeftArm", "LeftForeArm", "LeftHand"]);
        assert_eq!(arm, [(left(Collar), 0), (left(Arm), 1), (left(Forearm), 2), (left(Hand), 3)]);
        let arm = chain(&["LeftCollar", "LeftShoulder", "LeftElbow", "LeftWrist"]);
        assert_eq!(arm, [(left(Collar), 0), (left(Arm), 1), (left(Forearm), 2), (left(Hand), 3)]);
        assert_eq!(chain(&["LeftUpLeg", "LeftLeg"]), [(left(Thigh), 0), (left(Shin), 1)]);
        assert_eq!(chain(&["LHipJoint", "LeftHip", "LeftKnee"]), [(left(Thigh), 1), (left(Shin), 2)]);
        assert_eq!(chain(&["LeftLeg", "LeftKnee"]), [(left(Thigh), 0), (left(Shin), 1)]);
    }

    #[test]
    fn the_spine_is_what_is_between_hips_and_neck() {
        let found = chain(&["root", "hips", "tummy", "thorax", "neck", "neck1", "head"]);
        let expected =
            [(Role::Hips, 1), (Role::Spine(0), 2), (Role::Spine(1), 3), (Role::Neck, 4), (Role::Head, 6)];
        assert_eq!(found, expected);
    }
}
