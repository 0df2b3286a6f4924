//! Colours: smooth fields on the surface as texture coordinates, and the texture that turns them into paint.
//!
//! The texture holds a wheel of paints: the body's colour in the middle, one paint in each direction. A
//! vertex has the direction of the patch it is nearest to and a radius that grows with the depth in that
//! patch. An edge of paint is therefore as smooth as the field, not as the triangles; between two patches
//! everything runs through the middle of the wheel; and one mesh with one material carries all of it
//! without a seam.

use super::shape::{EAR, Knot, TAIL, facing};
use super::texture::{Paint, wheel_uv};
use glam::{DVec3, dvec3};

/// Texture coordinates of the point `p` with normal `n` on the body's surface.
pub(super) fn uv(p: DVec3, n: DVec3) -> [f64; 2] {
    let p = dvec3(p.x.abs(), p.y, p.z);
    let n = dvec3(n.x.abs(), n.y, n.z);
    let patches = [
        (Paint::Belly, belly(p)),
        (Paint::Ear, inner_ear(p, n)),
        (Paint::Blush, blush(p)),
        (Paint::Tip, tips(p, n)),
        (Paint::Stripe, stripes(p)),
        (Paint::Toe, toes(p)),
    ];
    let deepest = patches.into_iter().fold(patches[0], |a, b| if b.1 > a.1 { b } else { a });
    wheel_uv(deepest.0, deepest.1.clamp(0.0, 1.0))
}

/// Depth of signed distance `d` (negative inside): 0 at `range` outside, ½ on the edge, 1 at `range` inside.
fn depth(d: f64, range: f64) -> f64 {
    0.5 - 0.5 * d / range
}

fn ellipsoid(p: DVec3, center: [f64; 3], radii: [f64; 3]) -> f64 {
    let radii = DVec3::from_array(radii);
    let q = (p - DVec3::from_array(center)) / radii;
    let (k0, k1) = (q.length(), (q / radii).length());
    if k1 < 1e-9 { -radii.min_element() } else { k0 * (k0 - 1.0) / k1 }
}

fn belly(p: DVec3) -> f64 {
    depth(ellipsoid(p, [0.0, 0.430, 0.44], [0.262, 0.285, 0.33]), 0.08)
}

fn blush(p: DVec3) -> f64 {
    depth(ellipsoid(p, [0.272, 0.905, 0.215], [0.085, 0.066, 0.13]), 0.07)
}

/// The front of the ear, within its outline.
fn inner_ear(p: DVec3, n: DVec3) -> f64 {
    let (d, radius) = along(p, &EAR[..6]);
    let across = d - facing() * d.dot(facing());
    let inside = across.length() - 0.62 * radius;
    let outside = (0.30 * (0.25 - n.dot(facing()))).max(d.length() - 1.3 * radius).max(1.225 - p.y);
    depth(inside.max(outside), 0.06)
}

/// Darker ends of the tail and of the backs of the ears.
fn tips(p: DVec3, n: DVec3) -> f64 {
    let ear = ((p - EAR[6].0).length() - 0.10).max(0.25 * (n.dot(facing()) - 0.1));
    let tail = (p - TAIL[6].0).length() - 0.16;
    depth(ear, 0.10).max(depth(tail, 0.10))
}

/// Spots down the back and the tail.
fn stripes(p: DVec3) -> f64 {
    let mut best = f64::NEG_INFINITY;
    for (y, z, width) in
        [(0.54, -0.300, 0.058), (0.42, -0.440, 0.052), (0.355, -0.590, 0.044), (0.40, -0.730, 0.036)]
    {
        let d = dvec3(p.x * 0.5, p.y - y, p.z - z).length() - width;
        best = best.max(depth(d, 0.07));
    }
    best
}

fn toes(p: DVec3) -> f64 {
    depth((0.288 - p.z).max(p.y - 0.080), 0.06)
}

/// Vector from the nearest point of a middle line to `p`, and the radius there.
fn along(p: DVec3, line: &[Knot]) -> (DVec3, f64) {
    let mut best = (DVec3::splat(1e9), 0.0);
    for pair in line.windows(2) {
        let ((a, ra), (b, rb)) = (pair[0], pair[1]);
        let edge = b - a;
        let t = ((p - a).dot(edge) / edge.length_squared()).clamp(0.0, 1.0);
        let d = p - a - edge * t;
        if d.length_squared() < best.0.length_squared() {
            best = (d, ra + (rb - ra) * t);
        }
    }
    best
}
