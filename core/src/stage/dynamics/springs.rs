//! Springs on the skinned targets: one a point, parameters by region.

use crate::kernel::copy::copy;
use crate::kernel::spring::{self, Knots, Spring, Step};
use crate::math::affine::{self, Affine};
use crate::math::vec3;
use core::ops::Range;

/// State of all moving points at the last step. Vectors in the root's frame, model units and seconds.
#[derive(Debug)]
pub struct State<'a> {
    /// Target of skinning.
    pub x: &'a mut [[f32; 3]],
    /// Offset from it.
    pub y: &'a mut [[f32; 3]],
    /// Velocity.
    pub v: &'a mut [[f32; 3]],
    /// Slope of the target.
    pub slope: &'a mut [[f32; 3]],
    /// Acceleration by gravity and wind.
    pub f: &'a mut [[f32; 3]],
}

/// Turns all `vectors`. One copy of the loop is enough.
#[inline(never)]
fn rotate(map: &Affine, vectors: &mut [[f32; 3]]) {
    for vector in vectors {
        *vector = affine::rotate(map, *vector);
    }
}

/// Components of a run of points, none where there are not so many.
fn components<'a>(points: &'a [[f32; 3]], run: &Range<usize>) -> &'a [f32] {
    points.get(run.clone()).unwrap_or_default().as_flattened()
}

/// The same, to change.
fn components_mut<'a>(points: &'a mut [[f32; 3]], run: &Range<usize>) -> &'a mut [f32] {
    points.get_mut(run.clone()).unwrap_or_default().as_flattened_mut()
}

impl<'a> State<'a> {
    /// The arrays, in the order in which they are saved and hashed.
    #[must_use]
    pub fn arrays(&self) -> [&[[f32; 3]]; 5] {
        [self.x, self.y, self.v, self.slope, self.f]
    }

    /// Expresses the state in the frame of a root that moved: `map` takes old root space to new.
    pub fn carry(&mut self, map: &Affine) {
        for x in self.x.iter_mut() {
            *x = affine::transform(map, *x);
        }
        for vectors in [&mut *self.y, &mut *self.v, &mut *self.slope, &mut *self.f] {
            rotate(map, vectors);
        }
    }

    /// Puts every point where it would come to rest if nothing moved from now on: `y = f/ks`.
    pub fn settle(
        &mut self,
        targets: &[[f32; 3]],
        f: &[[f32; 3]],
        regions: &[u8],
        springs: &[Spring],
        rest: f32,
    ) {
        copy(targets, self.x);
        copy(f, self.f);
        self.v.fill([0.0; 3]);
        self.slope.fill([0.0; 3]);
        for ((y, f), region) in self.y.iter_mut().zip(f).zip(regions) {
            let ks = springs.get(usize::from(*region)).map_or(0.0, |spring| spring.ks);
            let sag = if ks > 0.0 { vec3::scale(*f, 1.0 / ks) } else { [0.0; 3] };
            let small = sag.iter().all(|c| crate::math::float::abs(*c) < rest);
            *y = if small { [0.0; 3] } else { sag };
        }
    }

    /// Starts the first step after a rest: the target and the flesh have its slope from the beginning.
    pub fn start(&mut self, targets: &[[f32; 3]], dt: f32) {
        let inverse = 1.0 / dt;
        let moving = self.x.iter().zip(targets).zip(self.slope.iter_mut().zip(self.v.iter_mut()));
        for ((x, target), (slope, v)) in moving {
            *slope = vec3::scale(vec3::sub(*target, *x), inverse);
            *v = *slope;
        }
    }

    /// Follows targets that jumped: offsets and relative velocities stay, the jump is not felt.
    pub fn jump(&mut self, targets: &[[f32; 3]]) {
        copy(targets, self.x);
        for (v, slope) in self.v.iter_mut().zip(self.slope.iter_mut()) {
            *v = vec3::sub(*v, *slope);
            *slope = [0.0; 3];
        }
    }

    /// Whether every one of up to 16 sampled points moved farther than `limit`.
    #[must_use]
    pub fn jumped(&self, targets: &[[f32; 3]], limit: f32) -> bool {
        let stride = (targets.len() / 16).max(1);
        let mut pairs = self.x.iter().zip(targets).step_by(stride);
        !targets.is_empty()
            && pairs.all(|(x, target)| {
                let d = vec3::sub(*target, *x);
                vec3::dot(d, d) > limit * limit
            })
    }

    /// Advances every point by one step to `targets`; `steps` is indexed by region. Runs of equal regions are one
    /// stream. `targets` and `f` change places with those of the last step.
    pub fn advance(
        &mut self,
        targets: &mut &'a mut [[f32; 3]],
        f: &mut &'a mut [[f32; 3]],
        regions: &[u8],
        steps: &[Step],
    ) {
        let mut range = 0..0;
        while let Some([region, rest @ ..]) = regions.get(range.end..) {
            let others = rest.iter().take_while(|other| *other == region).count();
            range = range.end..range.end + 1 + others;
            let Some(step) = steps.get(usize::from(*region)) else { continue };
            let knots = Knots {
                x: [components(self.x, &range), components(targets, &range)],
                f: [components(self.f, &range), components(f, &range)],
                y: components_mut(self.y, &range),
                v: components_mut(self.v, &range),
                slope: components_mut(self.slope, &range),
            };
            spring::advance(step, knots);
        }
        core::mem::swap(&mut self.x, targets);
        core::mem::swap(&mut self.f, f);
    }
}
