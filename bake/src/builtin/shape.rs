//! The body as an implicit surface: a smooth union of ellipsoids and of tubes along curves.
//!
//! The field is negative inside. It is evaluated at `(|x|, y, z)`, so it is mirror-symmetric to the
//! last bit; only the parts with `x ≥ 0` are listed.

use super::skeleton::Bone;
use glam::{DVec2, DVec3, DVec4, dvec3};

/// A primitive of the union.
#[derive(Clone, Debug)]
enum Form {
    /// Axis-aligned ellipsoid.
    Ellipsoid { center: DVec3, radii: DVec3 },
    /// Tube along a line, each point of which has a radius.
    Tube { cones: Vec<Cone>, ball: Ball },
}

/// A ball around something, to tell quickly that it is far.
#[derive(Clone, Copy, Debug)]
struct Ball {
    middle: DVec3,
    radius: f64,
}

/// A piece of a tube: all balls between two, their radii changing evenly.
#[derive(Clone, Debug)]
struct Cone {
    start: DVec3,
    /// Unit vector from end to end.
    axis: DVec3,
    length: f64,
    radii: [f64; 2],
    /// Sine and cosine of the angle between the axis and the side.
    slope: [f64; 2],
    ball: Ball,
    /// Normal of the plane into which the piece is flattened, and how much more distances across it count.
    flat: Option<(DVec3, f64)>,
}

/// A point of a tube's middle line, with the radius there.
pub(super) type Knot = (DVec3, f64);

/// A primitive with the joint that moves it.
#[derive(Clone, Debug)]
pub(super) struct Part {
    form: Form,
    /// Joint on the left, or in the middle.
    pub(super) bone: Bone,
    /// Width of the blend with the parts before, units.
    blend: f64,
}

/// The body.
#[derive(Debug)]
pub(super) struct Shape {
    /// Parts in the order of the union.
    parts: Vec<Part>,
    /// What is taken out of the left ear.
    hollow: Form,
}

/// Farther than anything in the field.
const FAR: f64 = 1e3;

/// Width over which the rim of the ear's hollow is rounded.
const RIM: f64 = 0.035;

/// Middle line of the left ear from base to tip, with radii.
pub(super) const EAR: [Knot; 7] = [
    (dvec3(0.130, 1.165, -0.010), 0.066),
    (dvec3(0.175, 1.290, -0.030), 0.084),
    (dvec3(0.232, 1.400, -0.045), 0.099),
    (dvec3(0.305, 1.487, -0.055), 0.106),
    (dvec3(0.395, 1.535, -0.050), 0.101),
    (dvec3(0.485, 1.527, -0.035), 0.088),
    (dvec3(0.552, 1.472, -0.012), 0.070),
];

/// Where the left ear's opening faces, and how thick the ear is for its width.
const EAR_FACING: DVec3 = dvec3(-0.06, -0.02, 1.0);
const EAR_THICKNESS: f64 = 0.64;

/// Middle line of the tail with radii.
pub(super) const TAIL: [Knot; 7] = [
    (dvec3(0.0, 0.330, -0.190), 0.205),
    (dvec3(0.0, 0.235, -0.390), 0.172),
    (dvec3(0.0, 0.205, -0.560), 0.143),
    (dvec3(0.0, 0.240, -0.715), 0.120),
    (dvec3(0.0, 0.340, -0.830), 0.104),
    (dvec3(0.0, 0.470, -0.870), 0.094),
    (dvec3(0.0, 0.590, -0.840), 0.082),
];

impl Shape {
    /// The creature.
    pub(super) fn creature() -> Self {
        let mut parts = torso();
        parts.extend(head());
        parts.extend(limbs());
        // The tail's second joint stands at the second point of its middle line.
        let tail = fine(&TAIL);
        parts.push(tube(Bone::Tail1, &tail[..=FINE], 0.05));
        parts.push(tube(Bone::Tail2, &tail[FINE..], 0.01));
        let ear = fine(&EAR);
        let hollow: Vec<Knot> =
            ear[FINE..=5 * FINE].iter().map(|(p, r)| (*p + facing() * (0.80 * r), 0.48 * r)).collect();
        let form = along(&ear, Some((facing(), 1.0 / EAR_THICKNESS - 1.0)));
        parts.push(Part { form, bone: Bone::Head, blend: 0.05 });
        Self { parts, hollow: along(&hollow, None) }
    }

    /// The field at `p`.
    pub(super) fn field(&self, p: DVec3) -> f64 {
        let p = dvec3(p.x.abs(), p.y, p.z);
        let mut sum = FAR;
        for part in &self.parts {
            // What is farther than the blend is wide changes nothing.
            sum = smooth_min(sum, part.form.distance(p, sum + part.blend), part.blend);
        }
        // A smooth maximum: the rim of the hollow is round.
        -smooth_min(-sum, self.hollow.distance(p, RIM - sum), RIM)
    }

    /// The field and its gradient at `p`, by four samples at the corners of a tetrahedron.
    pub(super) fn sample(&self, p: DVec3) -> (f64, DVec3) {
        const H: f64 = 5e-4;
        let (mut value, mut gradient) = (0.0, DVec3::ZERO);
        for corner in [dvec3(1., -1., -1.), dvec3(-1., -1., 1.), dvec3(-1., 1., -1.), dvec3(1., 1., 1.)] {
            let f = self.field(p + corner * H);
            value += f * 0.25;
            gradient += corner * (f / (4.0 * H));
        }
        (value, gradient)
    }

    /// `p` after a Newton step towards the surface, and the unit normal there.
    pub(super) fn project(&self, p: DVec3) -> (DVec3, DVec3) {
        let (value, gradient) = self.sample(p);
        let square = gradient.length_squared().max(0.05);
        // A step is never longer than a few cells: the field is no true distance.
        let step = (gradient * (value / square)).clamp_length_max(0.05);
        (p - step, gradient.normalize_or(DVec3::Y))
    }

    /// First point of the surface from `from` along the unit direction `along`, and its normal.
    pub(super) fn hit(&self, from: DVec3, along: DVec3) -> (DVec3, DVec3) {
        let (mut outside, mut inside) = (0.0, 0.0);
        while self.field(from + along * inside) > 0.0 && inside < 2.0 {
            outside = inside;
            inside += 0.01;
        }
        for _ in 0..40 {
            let middle = 0.5 * (outside + inside);
            if self.field(from + along * middle) > 0.0 { outside = middle } else { inside = middle }
        }
        let p = from + along * inside;
        (p, self.sample(p).1.normalize_or(DVec3::Z))
    }

    /// Part nearest to `p`, a point with `x ≥ 0`.
    pub(super) fn nearest(&self, p: DVec3) -> &Part {
        let mut best = &self.parts[0];
        let mut least = FAR;
        for part in &self.parts {
            let d = part.form.distance(p, least);
            if d < least {
                (best, least) = (part, d);
            }
        }
        best
    }
}

impl Form {
    /// Distance of `p`, where that is below `limit`; elsewhere `limit` or more.
    fn distance(&self, p: DVec3, limit: f64) -> f64 {
        match *self {
            Self::Ellipsoid { center, radii } => {
                let q = (p - center) / radii;
                let (square, least) = (q.length_squared(), radii.min_element());
                // The quotient below is never less than `least · (k0 − 1)`.
                let bound = 1.0 + limit / least;
                if bound > 0.0 && square > bound * bound {
                    return limit;
                }
                let (k0, k1) = (square.sqrt(), (q / radii).length());
                if k1 < 1e-9 { -least } else { k0 * (k0 - 1.0) / k1 }
            }
            Self::Tube { ref cones, ball } if ball.nearer(p, limit) => {
                cones.iter().fold(limit, |least, cone| {
                    if cone.ball.nearer(p, least) { least.min(cone.distance(p)) } else { least }
                })
            }
            Self::Tube { .. } => limit,
        }
    }
}

impl Ball {
    /// Whether `p` is less than `limit` from the ball, or deeper in it.
    fn nearer(self, p: DVec3, limit: f64) -> bool {
        let bound = limit + self.radius;
        bound > 0.0 && (p - self.middle).length_squared() < bound * bound
    }
}

impl Cone {
    fn new((a, ra): Knot, (b, rb): Knot, flat: Option<(DVec3, f64)>) -> Self {
        let length = (b - a).length();
        let sine = (ra - rb) / length;
        Self {
            start: a,
            axis: (b - a) / length,
            length,
            radii: [ra, rb],
            slope: [sine, (1.0 - sine * sine).max(0.0).sqrt()],
            // Flattening shears a little where the line leaves the plane.
            ball: Ball {
                middle: (a + b) * 0.5,
                radius: 0.5 * length + ra.max(rb) + if flat.is_some() { 0.05 } else { 0.0 },
            },
            flat,
        }
    }

    fn distance(&self, p: DVec3) -> f64 {
        let mut q = p - self.start;
        if let Some((normal, more)) = self.flat {
            let foot = self.axis * q.dot(self.axis).clamp(0.0, self.length);
            q += normal * (normal.dot(q - foot) * more);
        }
        let along = q.dot(self.axis);
        let across = (q.length_squared() - along * along).max(0.0).sqrt();
        let ([ra, rb], [sine, cosine]) = (self.radii, self.slope);
        let p = DVec2::new(across, along);
        let k = p.dot(DVec2::new(-sine, cosine));
        if k < 0.0 {
            p.length() - ra
        } else if k > cosine * self.length {
            (p - DVec2::new(0.0, self.length)).length() - rb
        } else {
            p.dot(DVec2::new(cosine, sine)) - ra
        }
    }
}

/// A tube along a line, optionally flattened.
fn along(line: &[Knot], flat: Option<(DVec3, f64)>) -> Form {
    let cones: Vec<Cone> = line.windows(2).map(|pair| Cone::new(pair[0], pair[1], flat)).collect();
    let middle = (line[0].0 + line[line.len() - 1].0) * 0.5;
    let far = |cone: &Cone| (cone.ball.middle - middle).length() + cone.ball.radius;
    let radius = cones.iter().map(far).fold(0.0, f64::max);
    Form::Tube { cones, ball: Ball { middle, radius } }
}

/// Direction in which the left ear's opening faces.
pub(super) fn facing() -> DVec3 {
    EAR_FACING.normalize()
}

/// Parts into which [`fine`] cuts each piece of a line.
const FINE: usize = 5;

/// The line as a smooth curve through its points (Catmull-Rom).
fn fine(line: &[Knot]) -> Vec<Knot> {
    let at = |i: usize| line[i.min(line.len() - 1)];
    let mut out = Vec::with_capacity(line.len() * FINE);
    for i in 0..line.len() - 1 {
        let [a, b, c, d] = [at(i.saturating_sub(1)), at(i), at(i + 1), at(i + 2)];
        for t in [0.0, 0.2, 0.4, 0.6, 0.8] {
            let cubic = |a: DVec4, b: DVec4, c: DVec4, d: DVec4| {
                b + ((c - a) + (a * 2.0 - b * 5.0 + c * 4.0 - d + (b * 3.0 - a - c * 3.0 + d) * t) * t)
                    * (0.5 * t)
            };
            let wide = |k: Knot| k.0.extend(k.1);
            let x = cubic(wide(a), wide(b), wide(c), wide(d));
            out.push((x.truncate(), x.w));
        }
    }
    out.push(at(line.len() - 1));
    out
}

/// The minimum with its corner rounded over a width of `k` (quadratic).
fn smooth_min(a: f64, b: f64, k: f64) -> f64 {
    let h = (k - (a - b).abs()).max(0.0) / k;
    a.min(b) - h * h * k * 0.25
}

fn ellipsoid(bone: Bone, center: [f64; 3], radii: [f64; 3], blend: f64) -> Part {
    let form = Form::Ellipsoid { center: DVec3::from_array(center), radii: DVec3::from_array(radii) };
    Part { form, bone, blend }
}

fn tube(bone: Bone, line: &[Knot], blend: f64) -> Part {
    Part { form: along(line, None), bone, blend }
}

fn capsule(bone: Bone, a: DVec3, b: DVec3, ra: f64, rb: f64, blend: f64) -> Part {
    tube(bone, &[(a, ra), (b, rb)], blend)
}

fn torso() -> Vec<Part> {
    vec![
        ellipsoid(Bone::Hips, [0.0, 0.320, -0.02], [0.340, 0.215, 0.300], 0.10),
        ellipsoid(Bone::Spine, [0.0, 0.430, 0.065], [0.385, 0.320, 0.355], 0.10),
        ellipsoid(Bone::Chest, [0.0, 0.675, -0.005], [0.230, 0.190, 0.205], 0.14),
    ]
}

fn head() -> Vec<Part> {
    vec![
        ellipsoid(Bone::Neck, [0.0, 0.815, 0.0], [0.175, 0.110, 0.160], 0.08),
        ellipsoid(Bone::Head, [0.0, 1.025, 0.020], [0.345, 0.272, 0.285], 0.06),
        // Cheeks.
        ellipsoid(Bone::Head, [0.215, 0.920, 0.105], [0.170, 0.132, 0.155], 0.09),
        // Muzzle and chin.
        ellipsoid(Bone::Head, [0.0, 0.920, 0.235], [0.128, 0.084, 0.108], 0.08),
    ]
}

fn limbs() -> Vec<Part> {
    let at = dvec3;
    let mut parts = vec![
        // Arm: shoulder, elbow, wrist, paw.
        capsule(Bone::Shoulder, at(0.130, 0.700, 0.005), at(0.215, 0.688, 0.012), 0.098, 0.095, 0.06),
        capsule(Bone::UpperArm, at(0.215, 0.688, 0.012), at(0.375, 0.640, 0.030), 0.095, 0.081, 0.06),
        capsule(Bone::Forearm, at(0.375, 0.640, 0.030), at(0.515, 0.563, 0.090), 0.081, 0.078, 0.05),
        ellipsoid(Bone::Hand, [0.560, 0.531, 0.115], [0.092, 0.090, 0.090], 0.05),
        // Leg: thigh, shank, foot.
        ellipsoid(Bone::Thigh, [0.215, 0.245, 0.045], [0.150, 0.160, 0.175], 0.06),
        capsule(Bone::Shin, at(0.215, 0.190, 0.020), at(0.222, 0.090, 0.020), 0.108, 0.090, 0.05),
        ellipsoid(Bone::Foot, [0.232, 0.085, 0.105], [0.116, 0.076, 0.185], 0.04),
    ];
    for (x, z) in [(0.158, 0.240), (0.238, 0.264), (0.316, 0.234)] {
        parts.push(ellipsoid(Bone::Toes, [x, 0.062, z], [0.047, 0.052, 0.062], 0.04));
    }
    parts
}
