//! The bone wrap marches inwards from a thin shell, and never through a state with an unsound prism.
//!
//! ```text
//! b ← b + tᵢ [α (target − b) + β (mean of the neighbors' columns − column)],   tᵢ = 1, ½, ¼, … 0
//! ```
//!
//! All columns move at once; where that makes a prism unsound its three columns halve their steps, and again, until
//! every prism is sound. With all steps at 0 that is the state before, so it ends; and since it starts sound it
//! stays sound. What the targets would do to folds of the skin, to armpits and between fingers is so repaired
//! before it happens; columns end where they can go no further. The result does not depend on an order of columns:
//! not on the number of threads, and a mirrored body gives mirrored layers.

use super::crossing::crossings;
use super::shrink::mean;
use super::skin::Skin;
use super::sound::is_sound;
use glam::DVec3;
use rayon::prelude::*;

/// Share of the way to the target in a step.
const PULL: f64 = 0.12;
/// Share of the smoothing in a step.
const SMOOTH: f64 = 0.25;
/// Steps.
const STEPS: usize = 60;
/// Halvings before a column stands still for a step.
const HALVINGS: u32 = 5;
/// Thickness of the first shell, as a share of the shortest edge around; halved until sound.
const THIN: f64 = 0.05;
/// Least share of an upright prism (see [`is_sound`]) that columns keep.
const SOUND: f64 = 0.02;

/// Rounds of drawing back.
const ROUNDS: usize = 30;
/// Share of the depth that a round takes back.
const BACK: f64 = 0.2;

/// The bone wrap as it stands.
#[derive(Clone, Debug)]
pub(super) struct March<'a> {
    skin: &'a Skin,
    /// Least share of an upright prism, one a triangle: [`SOUND`] unless the skin is folded more sharply.
    floors: Vec<f64>,
    /// Places of the bone wrap.
    pub(super) bone: Vec<DVec3>,
}

impl<'a> March<'a> {
    /// The first shell, along `normals` whose smallest cosines are `seen`; or the points that have no sound column.
    pub(super) fn new(skin: &'a Skin, normals: &[DVec3], seen: &[f64]) -> Result<Self, Vec<u32>> {
        let floor =
            |t: &[u32; 3]| SOUND.min(0.5 * t.iter().map(|i| seen[*i as usize]).fold(f64::INFINITY, f64::min));
        let shortest = |row: &Vec<(usize, f64)>| row.iter().map(|(_, l)| *l).fold(f64::INFINITY, f64::min);
        let thin = skin.edges.iter().map(|row| THIN * shortest(row));
        let mut shell = Self {
            skin,
            floors: skin.triangles.iter().map(floor).collect(),
            bone: skin.points.iter().zip(normals).zip(thin).map(|((p, n), h)| *p - h * *n).collect(),
        };
        for _ in 0..30 {
            let unsound = shell.unsound(&shell.bone);
            if unsound.is_empty() {
                return Ok(shell);
            }
            for i in touched(&unsound, skin) {
                shell.bone[i] = 0.5 * (shell.bone[i] + skin.points[i]);
            }
        }
        let unsound = shell.unsound(&shell.bone);
        Err(touched(&unsound, skin).into_iter().map(|i| u32::try_from(i).unwrap_or(u32::MAX)).collect())
    }

    /// Marches towards `targets`.
    pub(super) fn to(&mut self, targets: &[DVec3]) {
        for step in 0..STEPS {
            // Towards the end the targets alone count: a round wrap is not drawn together.
            let smooth = if 2 * step < STEPS { SMOOTH } else { 0.0 };
            let columns: Vec<DVec3> = self.bone.iter().zip(&self.skin.points).map(|(b, s)| *b - *s).collect();
            let step = |i: usize| {
                let flat = mean(self.skin, i, |j| columns[j]) - columns[i];
                PULL * (targets[i] - self.bone[i] + smooth * flat)
            };
            let steps: Vec<DVec3> = (0..columns.len()).into_par_iter().map(step).collect();
            self.advance(&steps);
        }
    }

    /// Marches on along `normals` where columns did not get half as deep as their targets.
    pub(super) fn along(&mut self, normals: &[DVec3], targets: &[DVec3]) {
        let depths: Vec<f64> = self.skin.points.iter().zip(targets).map(|(s, t)| s.distance(*t)).collect();
        let turned: Vec<DVec3> = (0..targets.len())
            .map(|i| {
                let stuck = self.bone[i].distance(self.skin.points[i]) < 0.5 * depths[i];
                if stuck { self.skin.points[i] - depths[i] * normals[i] } else { targets[i] }
            })
            .collect();
        self.to(&turned);
    }

    /// Draws the bone wrap back towards the skin where it crosses the skin, or itself where the skin does not.
    pub(super) fn untangle(&mut self) {
        let skin = self.skin;
        let own = crossings(&skin.points, None, &skin.triangles);
        for _ in 0..ROUNDS {
            let mut found = crossings(&self.bone, None, &skin.triangles);
            found.retain(|pair| own.binary_search(pair).is_err());
            let mut crossed: Vec<u32> = found.into_iter().flat_map(|(t, u)| [t, u]).collect();
            let through = crossings(&self.bone, Some(&skin.points), &skin.triangles);
            crossed.extend(through.into_iter().map(|(bone, _)| bone));
            if crossed.is_empty() {
                return;
            }
            let mut steps = vec![DVec3::ZERO; skin.points.len()];
            for i in touched(&crossed, skin) {
                // The ring goes half as far, so that the step is smooth.
                for (j, _) in &skin.edges[i] {
                    let half = 0.5 * BACK * (skin.points[*j] - self.bone[*j]);
                    steps[*j] = if steps[*j] == DVec3::ZERO { half } else { steps[*j] };
                }
                steps[i] = BACK * (skin.points[i] - self.bone[i]);
            }
            self.advance(&steps);
        }
    }

    /// Moves all columns by `steps`, or by as much of them as leaves every prism sound.
    pub(super) fn advance(&mut self, steps: &[DVec3]) {
        let mut share = vec![1.0; steps.len()];
        let mut moved: Vec<DVec3> = self.bone.iter().zip(steps).map(|(b, s)| *b + *s).collect();
        let mut unsound = self.unsound(&moved);
        let mut halvings = vec![0; steps.len()];
        while !unsound.is_empty() {
            let touched = touched(&unsound, self.skin);
            for i in &touched {
                halvings[*i] += 1;
                share[*i] = if halvings[*i] > HALVINGS { 0.0 } else { 0.5 * share[*i] };
                moved[*i] = self.bone[*i] + share[*i] * steps[*i];
            }
            let mut again: Vec<u32> =
                touched.iter().flat_map(|i| self.skin.around[*i].iter().copied()).collect();
            again.sort_unstable();
            again.dedup();
            unsound = again.into_par_iter().filter(|t| !self.sound(*t, &moved)).collect();
        }
        self.bone = moved;
    }

    /// Triangles whose prisms are not sound with the bone wrap at `bone`.
    fn unsound(&self, bone: &[DVec3]) -> Vec<u32> {
        let count = u32::try_from(self.skin.triangles.len()).unwrap_or(u32::MAX);
        (0..count).into_par_iter().filter(|t| !self.sound(*t, bone)).collect()
    }

    fn sound(&self, triangle: u32, bone: &[DVec3]) -> bool {
        let [a, b, c] = self.skin.triangles[triangle as usize].map(|i| i as usize);
        let skin = &self.skin.points;
        is_sound(&[bone[a], bone[b], bone[c], skin[a], skin[b], skin[c]], self.floors[triangle as usize])
    }
}

/// Points of some triangles, ascending.
fn touched(triangles: &[u32], skin: &Skin) -> Vec<usize> {
    let mut out: Vec<usize> =
        triangles.iter().flat_map(|t| skin.triangles[*t as usize].map(|i| i as usize)).collect();
    out.sort_unstable();
    out.dedup();
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cage::layers::skin::sphere;
    use crate::cage::layers::unfold::unfold;

    fn shell(skin: &mut Skin) -> (Vec<DVec3>, Vec<f64>) {
        unfold(skin)
    }

    #[test]
    fn a_sphere_marches_to_a_sphere_within() {
        let mut skin = sphere(10);
        let (normals, seen) = shell(&mut skin);
        let targets: Vec<DVec3> = skin.points.iter().map(|p| 0.4 * *p).collect();
        let mut march = March::new(&skin, &normals, &seen).expect("a shell");
        march.to(&targets);
        let off = march.bone.iter().zip(&targets).map(|(b, t)| b.distance(*t)).fold(0.0, f64::max);
        // What is left of the way of 0.6, and of the smoothing in the first half of the steps.
        assert!(off < 0.7 * libm::pow(1.0 - PULL, 30.0), "{off}");
    }

    /// Targets that would turn every prism over: all in one place outside, the antipodes, the places of others.
    #[test]
    fn no_target_makes_a_prism_unsound() {
        let mut skin = sphere(10);
        let (normals, seen) = shell(&mut skin);
        let n = skin.points.len();
        let outside = vec![DVec3::new(3.0, 1.0, -2.0); n];
        let antipodes: Vec<DVec3> = skin.points.iter().map(|p| -*p).collect();
        let others: Vec<DVec3> = (0..n).map(|i| skin.points[i * 77 % n]).collect();
        for targets in [outside, antipodes, others] {
            let mut march = March::new(&skin, &normals, &seen).expect("a shell");
            march.to(&targets);
            assert_eq!(march.unsound(&march.bone), [0; 0]);
            let moved = march.bone.iter().zip(&skin.points).filter(|(b, s)| b.distance(**s) > 0.02).count();
            assert!(moved > n / 4, "{moved} of {n} columns moved");
        }
    }

    /// Where two parts of the bone wrap got into each other they are drawn apart, and the rest stays.
    #[test]
    fn crossings_are_untangled() {
        let mut skin = sphere(14);
        // A peanut: two balls on a neck, whose bone wraps are pushed through the neck.
        skin.points.iter_mut().for_each(|p| *p *= DVec3::new(0.15 + p.y * p.y, 2.0, 0.15 + p.y * p.y));
        let mut skin = Skin::of(skin.points, skin.triangles, skin.weights, skin.point_of);
        let (normals, seen) = shell(&mut skin);
        let mut march = March::new(&skin, &normals, &seen).expect("a shell");
        let targets: Vec<DVec3> =
            skin.points.iter().map(|p| DVec3::new(0.3 * p.x, p.y - 2.0 * p.y.signum(), 0.3 * p.z)).collect();
        march.to(&targets);
        let before = crossings(&march.bone, None, &skin.triangles).len();
        march.untangle();
        let after = crossings(&march.bone, None, &skin.triangles).len();
        assert!(before > 0 && after == 0, "{before} to {after}");
        assert_eq!(march.unsound(&march.bone), [0; 0]);
    }
}
