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
    /// A camera that sees all `points`, from `azimuth` (0 is from +Z) and `elevation`, radians.
    #[must_use]
    pub fn framing(points: &[DVec3], aspect: f64, azimuth: f64, elevation: f64) -> Self {
        let (sa, ca) = (libm::sin(azimuth), libm::cos(azimuth));
        let (se, ce) = (libm::sin(elevation), libm::cos(elevation));
        let back = DVec3::new(sa * ce, se, ca * ce);
        let right = DVec3::new(ca, 0.0, -sa);
        let up = back.cross(right);
        let tangent = libm::tan(0.5 * FIELD);
        let extent = |axis: DVec3| {
            let along = points.iter().map(|p| p.dot(axis));
            along.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), x| (a.min(x), b.max(x)))
        };
        let middle = |axis: DVec3| {
            let (a, b) = extent(axis);
            if a <= b { axis * (0.5 * (a + b)) } else { DVec3::ZERO }
        };
        let center = middle(right) + middle(up) + middle(back);
        // Each point asks for a distance at which it is inside the frame.
        let needed = points.iter().map(|p| {
            let c = *p - center;
            (c.dot(right).abs() / aspect).max(c.dot(up).abs()) / tangent + c.dot(back)
        });
        let distance = needed.fold(1e-6, f64::max) * 1.08;
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
    fn every_point_is_in_the_frame() {
        let (low, high) = (DVec3::new(-3.0, 0.0, -1.0), DVec3::new(2.0, 7.0, 9.0));
        let pick = |i: usize, b: usize, a: f64, c: f64| if i >> b & 1 == 0 { a } else { c };
        let corner =
            |i| DVec3::new(pick(i, 0, low.x, high.x), pick(i, 1, low.y, high.y), pick(i, 2, low.z, high.z));
        let corners: Vec<DVec3> = (0..8).map(corner).collect();
        for (azimuth, aspect) in [(0.0, 1.0), (0.7, 1.6), (2.5, 0.6)] {
            let camera = Camera::framing(&corners, aspect, azimuth, 0.2);
            for p in &corners {
                let q = camera.project(*p, 100.0).unwrap();
                assert!(q.x > 0.0 && q.x < 100.0 * aspect && q.y > 0.0 && q.y < 100.0, "{q:?}");
            }
        }
    }
}
