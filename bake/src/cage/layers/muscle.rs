//! The muscle wrap: a share of the way from bone to skin on every column.
//!
//! ```text
//! m = b + f (s − b)
//! ```
//!
//! With one `f` for all columns both prisms of a triangle are slices of the prism between bone and skin, sound
//! because that one is (a Bernstein form cut in two has convex combinations of the coefficients it had). Where `f`
//! differs from column to column it is taken back towards ½, column by column, until both slices are sound.

use super::skin::Skin;
use super::sound::is_sound;
use glam::DVec3;

/// Share where nothing else is known, and the one all others fall back to.
pub(super) const HALF: f64 = 0.5;
/// Rounds of smoothing of the shares.
const SMOOTHING: usize = 20;
/// Halvings of the distance to ½ before a column is at ½.
const HALVINGS: u32 = 6;
/// Least share of an upright prism that a slice keeps.
const SOUND: f64 = 0.005;

/// Places of the muscle wrap; `shares` are wishes, one a point, inside 0 to 1.
pub(super) fn wrap(skin: &Skin, bone: &[DVec3], shares: &[f64]) -> Vec<DVec3> {
    settled(skin, bone, smoothed(skin, shares))
}

/// The wrap at the given shares, or where prisms would not be sound nearer to ½.
fn settled(skin: &Skin, bone: &[DVec3], mut shares: Vec<f64>) -> Vec<DVec3> {
    let mut halvings = vec![0; shares.len()];
    loop {
        let muscle: Vec<DVec3> =
            bone.iter().zip(&skin.points).zip(&shares).map(|((b, s), f)| *b + *f * (*s - *b)).collect();
        let mut moving: Vec<usize> = Vec::new();
        for t in skin.triangles.iter().map(|t| t.map(|i| i as usize)) {
            let fallen_back = t.iter().all(|i| halvings[*i] > HALVINGS);
            if !fallen_back && !are_sound(t, bone, &muscle, &skin.points) {
                moving.extend(t);
            }
        }
        if moving.is_empty() {
            return muscle;
        }
        moving.sort_unstable();
        moving.dedup();
        for i in moving {
            halvings[i] += 1;
            shares[i] = if halvings[i] > HALVINGS { HALF } else { 0.5 * (shares[i] + HALF) };
        }
    }
}

/// Whether both prisms of a triangle are.
fn are_sound(t: [usize; 3], bone: &[DVec3], muscle: &[DVec3], skin: &[DVec3]) -> bool {
    let slice = |inner: &[DVec3], outer: &[DVec3]| {
        let [a, b, c] = t;
        is_sound(&[inner[a], inner[b], inner[c], outer[a], outer[b], outer[c]], SOUND)
    };
    slice(bone, muscle) && slice(muscle, skin)
}

fn smoothed(skin: &Skin, shares: &[f64]) -> Vec<f64> {
    let mut out = shares.to_vec();
    for _ in 0..SMOOTHING {
        let mean = |i: usize| {
            let (sum, n) = skin.edges[i].iter().fold((out[i], 1.0), |(s, n), (j, _)| (s + out[*j], n + 1.0));
            sum / n
        };
        out = (0..out.len()).map(mean).collect();
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cage::layers::march::March;
    use crate::cage::layers::skin::sphere;
    use crate::cage::layers::unfold::unfold;

    /// A bone wrap as crooked as the march allows, thin muscle beside thick: the wishes hold where they can.
    #[test]
    fn shares_give_way_where_a_slice_would_turn_over() {
        let mut skin = sphere(10);
        let (normals, seen) = unfold(&mut skin);
        let mut march = March::new(&skin, &normals, &seen).expect("a shell");
        let n = skin.points.len();
        let targets: Vec<DVec3> = (0..n).map(|i| 0.5 * skin.points[i * 77 % n]).collect();
        march.to(&targets);
        let wishes: Vec<f64> = skin.points.iter().map(|p| if p.x > 0.0 { 0.95 } else { 0.05 }).collect();
        let muscle = settled(&skin, &march.bone, wishes.clone());
        let mut kept = 0;
        for t in skin.triangles.iter().map(|t| t.map(|i| i as usize)) {
            let slice = |inner: &[DVec3], outer: &[DVec3]| {
                is_sound(&[inner[t[0]], inner[t[1]], inner[t[2]], outer[t[0]], outer[t[1]], outer[t[2]]], 0.0)
            };
            assert!(slice(&march.bone, &muscle) && slice(&muscle, &skin.points), "{t:?}");
        }
        for i in 0..n {
            let share = muscle[i].distance(march.bone[i]) / skin.points[i].distance(march.bone[i]);
            assert!((0.04..0.96).contains(&share), "{i}: {share}");
            kept += usize::from((share - wishes[i]).abs() < 0.01);
        }
        assert!(kept > n / 3, "{kept} of {n}");
    }
}
