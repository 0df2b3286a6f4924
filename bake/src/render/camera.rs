//! A camera that keeps a whole motion in the picture.

use glam::DVec3;

/// Vertical field of view, radians.
const FIELD: f64 = 0.45;

/// A perspective camera.
#[derive(Clone, Copy, Debug)]
pub struct Camera {
    /// Right and up, divided by the extent of the picture at unit distance, and back.
    axes: [DVec3; 3],
    /// Where it stands, model space.
    pub eye: DVec3,
    /// Width over height.
    aspect: f64,
}

impl Camera {
    /// A camera that sees the box `low..high` whole, from `azimuth` (0 is from +Z) and `elevation`, radians.
    #[must_use]
    pub fn framing(low: DVec3, high: DVec3, aspect: f64, azimuth: f64, elevation: f64) -> Self {
        let center = (low + high) * 0.5;
        let (sa, ca) = (libm::sin(azimuth), libm::cos(azimuth));
        let (se, ce) = (libm::sin(elevation), libm::cos(elevation));
        let back = DVec3::new(sa * ce, se, ca * ce);
        let right = DVec3::new(ca, 0.0, -sa);
        let up = back.cross(right);
        let tangent = libm::tan(0.5 * FIELD);
        let corners = (0..8).map(|i| {
            let pick = |bit: usize, a: f64, b: f64| if i >> bit & 1 == 0 { a } else { b };
            DVec3::new(pick(0, low.x, high.x), pick(1, low.y, high.y), pick(2, low.z, high.z)) - center
        });
        // Each corner asks for a distance at which it is inside the frame.
        let needed = corners.map(|c| {
            let across = (c.dot(right).abs() / aspect).max(c.dot(up).abs()) / tangent;
            across + c.dot(back)
        });
        let distance = needed.fold(1e-6, f64::max) * 1.06;
        let axes = [right / (tangent * aspect), up / tangent, back];
        Self { eye: center + back * distance, axes, aspect }
    }

    /// Pixel coordinates and inverse depth of a point for a picture of the given height; `None` behind the camera.
    #[must_use]
    pub fn project(&self, p: DVec3, height: f64) -> Option<DVec3> {
        let [x, y, z] = self.axes.map(|axis| axis.dot(p - self.eye));
        (z < 0.0).then(|| {
            let width = height * self.aspect;
            DVec3::new((0.5 - 0.5 * x / z) * width, (0.5 + 0.5 * y / z) * height, -1.0 / z)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_corner_is_in_the_frame() {
        let (low, high) = (DVec3::new(-3.0, 0.0, -1.0), DVec3::new(2.0, 7.0, 9.0));
        for (azimuth, aspect) in [(0.0, 1.0), (0.7, 1.6), (2.5, 0.6)] {
            let camera = Camera::framing(low, high, aspect, azimuth, 0.2);
            for i in 0..8 {
                let pick = |b: usize, a: f64, c: f64| if i >> b & 1 == 0 { a } else { c };
                let p = DVec3::new(pick(0, low.x, high.x), pick(1, low.y, high.y), pick(2, low.z, high.z));
                let q = camera.project(p, 100.0).unwrap();
                assert!(q.x > 0.0 && q.x < 100.0 * aspect && q.y > 0.0 && q.y < 100.0, "{q:?}");
            }
        }
    }
}
