//! A camera that keeps a whole clip in the picture.

use glam::Vec3;

/// Half of the vertical field of view, as a tangent: a long lens, as for portraits.
const TAN_Y: f32 = 0.22;
/// Share of the picture that the character may fill.
const FILL: f32 = 0.86;

/// A perspective camera.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// Position.
    pub(super) eye: Vec3,
    pub(super) right: Vec3,
    pub(super) up: Vec3,
    pub(super) forward: Vec3,
    /// Tangents of half the field of view, horizontal and vertical.
    pub(super) tan: [f32; 2],
    /// Height of the ground: the lowest point that was framed.
    pub(super) ground: f32,
    /// Diagonal of the box around all points that were framed.
    pub(super) size: f32,
}

/// A camera in the making: takes the points of every frame of a clip, one after the other.
///
/// ```text
/// p is in the picture  ⇔  |(p − e)·r| ≤ tx (p − e)·f  and  |(p − e)·u| ≤ ty (p − e)·f
/// ⇒  e·r = (A₊ − A₋)/2,   e·f = −(A₊ + A₋)/(2 tx)   with  A± = max over p of (±p·r − tx p·f)
/// ```
///
/// and the same with `u` and `ty`; the farther of the two distances serves both.
#[derive(Clone, Copy, Debug)]
pub struct Framing {
    right: Vec3,
    up: Vec3,
    forward: Vec3,
    /// Tangents of half of what points may fill, horizontal and vertical.
    reach: [f32; 2],
    /// `A₊` and `A₋`, horizontal and vertical.
    extent: [[f32; 2]; 2],
    low: Vec3,
    high: Vec3,
}

impl Framing {
    /// * `aspect`: width by height of the picture, positive.
    /// * `azimuth`: radians from the front (the side of +Z) towards the left hand of the character (+X).
    /// * `elevation`: radians above the horizon.
    #[must_use]
    pub fn new(aspect: f32, azimuth: f32, elevation: f32) -> Self {
        let ((sa, ca), (se, ce)) = (sin_cos(azimuth), sin_cos(elevation));
        let forward = -Vec3::new(sa * ce, se, ca * ce);
        let right = Vec3::new(ca, 0.0, -sa);
        Self {
            right,
            up: right.cross(forward),
            forward,
            reach: [TAN_Y * aspect * FILL, TAN_Y * FILL],
            extent: [[f32::NEG_INFINITY; 2]; 2],
            low: Vec3::splat(f32::INFINITY),
            high: Vec3::splat(f32::NEG_INFINITY),
        }
    }

    /// Takes points, model space; those that are not finite do not count.
    pub fn add(&mut self, points: impl IntoIterator<Item = [f32; 3]>) {
        for p in points.into_iter().map(Vec3::from_array).filter(|p| p.is_finite()) {
            let z = p.dot(self.forward);
            for (axis, side) in [p.dot(self.right), p.dot(self.up)].into_iter().enumerate() {
                let (deep, [plus, minus]) = (self.reach[axis] * z, &mut self.extent[axis]);
                (*plus, *minus) = (plus.max(side - deep), minus.max(-side - deep));
            }
            (self.low, self.high) = (self.low.min(p), self.high.max(p));
        }
    }

    /// How well the points suit the shape of the picture: 1 where they fill it both ways, less where they fill
    /// it one way only.
    #[must_use]
    pub fn fit(&self) -> f32 {
        let [across, along] = self.depths().map(|z| self.middle() - z);
        let fit = across.min(along) / across.max(along);
        if fit.is_finite() { fit } else { 0.0 }
    }

    /// The nearest camera that sees all points, with a margin. The lowest point is the height of the ground.
    #[must_use]
    pub fn camera(&self) -> Camera {
        let Self { right, up, forward, reach, .. } = *self;
        // Nothing to see: any camera will do.
        let empty = self.low.x > self.high.x;
        let extent = if empty { [[1.0; 2]; 2] } else { self.extent };
        let [low, high] = if empty { [-Vec3::ONE, Vec3::ONE] } else { [self.low, self.high] };
        let [across, along] = Self { extent, ..*self }.depths();
        let size = (high - low).length().max(f32::MIN_POSITIVE);
        let [x, y] = extent.map(|[plus, minus]| 0.5 * (plus - minus));
        // A little farther than the points ask for: a single point has a distance too.
        let eye = right * x + up * y + forward * (across.min(along) - 0.05 * size);
        Camera { eye, right, up, forward, tan: reach.map(|r| r / FILL), ground: low.y, size }
    }

    /// Where the camera has to stand along its axis for all points to be in the picture, across and along it.
    fn depths(&self) -> [f32; 2] {
        [0, 1].map(|axis: usize| -(self.extent[axis][0] + self.extent[axis][1]) / (2.0 * self.reach[axis]))
    }

    /// Depth of the middle of the points.
    fn middle(&self) -> f32 {
        (0.5 * (self.low + self.high)).dot(self.forward)
    }
}

impl Camera {
    /// The nearest camera in a given direction that sees all of `points`, with a margin; see [`Framing`].
    #[must_use]
    pub fn framing(
        points: impl IntoIterator<Item = [f32; 3]>,
        aspect: f32,
        azimuth: f32,
        elevation: f32,
    ) -> Self {
        let mut framing = Framing::new(aspect, azimuth, elevation);
        framing.add(points);
        framing.camera()
    }

    /// Where `p` is in a picture of `size` pixels: x to the right and y down from the upper left corner, px,
    /// and the inverse of the distance; `None` behind the camera.
    #[must_use]
    pub fn project(&self, p: [f32; 3], size: [f32; 2]) -> Option<[f32; 3]> {
        let q = Vec3::from_array(p) - self.eye;
        let inverse = 1.0 / q.dot(self.forward);
        let x = q.dot(self.right) * inverse / self.tan[0];
        let y = q.dot(self.up) * inverse / self.tan[1];
        let seen = inverse > 0.0 && x.is_finite() && y.is_finite();
        seen.then_some([0.5 * (1.0 + x) * size[0], 0.5 * (1.0 - y) * size[1], inverse])
    }

    /// Direction, not normalized, in which the camera sees the place `x`, `y` of a picture (0 to 1 from the upper
    /// left corner).
    pub(super) fn ray(&self, x: f32, y: f32) -> Vec3 {
        let (x, y) = ((2.0 * x - 1.0) * self.tan[0], (1.0 - 2.0 * y) * self.tan[1]);
        self.forward + self.right * x + self.up * y
    }
}

/// Sine and cosine with the same bits on every host.
fn sin_cos(angle: f32) -> (f32, f32) {
    let (sin, cos) = libm::sincos(f64::from(angle));
    #[allow(clippy::cast_possible_truncation, reason = "single precision is meant")]
    (sin as f32, cos as f32)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_point_is_in_the_picture_and_touches_the_margin() {
        let points: Vec<[f32; 3]> = (0..200_u16)
            .map(|i| {
                let i = f32::from(i);
                [(i * 7.3) % 3.0 - 1.0, (i * 1.7) % 5.0, (i * 3.1) % 2.0]
            })
            .collect();
        for (azimuth, elevation, aspect) in [(0.0, 0.0, 1.0), (0.6, 0.3, 1.6), (2.5, -0.4, 0.5)] {
            let camera = Camera::framing(points.iter().copied(), aspect, azimuth, elevation);
            let seen = points.iter().map(|&p| camera.project(p, [2.0, 2.0]).expect("in front"));
            let worst = seen.flat_map(|[x, y, _]| [(x - 1.0).abs(), (y - 1.0).abs()]).fold(0.0, f32::max);
            assert!(worst <= FILL && worst > 0.75 * FILL, "fills {worst} of the picture at {azimuth}");
        }
    }

    #[test]
    fn front_is_plus_z_and_azimuth_turns_to_the_left_hand() {
        let camera = Camera::framing([[0.0; 3], [0.0, 1.0, 0.0]], 1.0, 0.0, 0.0);
        assert!(camera.eye.z > 1.0 && camera.right.x > 0.99, "{camera:?}");
        let left = Camera::framing([[0.0; 3], [0.0, 1.0, 0.0]], 1.0, core::f32::consts::FRAC_PI_2, 0.0);
        assert!(left.eye.x > 1.0 && left.eye.z.abs() < 1e-3, "{left:?}");
    }

    #[test]
    fn nothing_or_one_point_gives_a_usable_camera() {
        for points in [vec![], vec![[1.0, 2.0, 3.0]], vec![[f32::NAN; 3]]] {
            let camera = Camera::framing(points, 1.0, 0.5, 0.5);
            assert!(camera.eye.is_finite() && camera.ground.is_finite(), "{camera:?}");
        }
    }
}
