//! Places in a saved state: which number of which vertex a byte belongs to.

use super::outcome::Stage;
use crate::character::Character;
use crate::math::digest::canonical;
use crate::state::HEAD;
use core::fmt;

/// A number of a saved state that is no array, in the order of the state.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum LifeField {
    /// Magic, version, asset hash.
    Header,
    /// Phase, frozen, teleport declared.
    Flags,
    /// Rate divisor.
    Divisor,
    /// Steps since the last that was due.
    Turn,
    /// Time that waits for the next step, s.
    Pending,
    /// Time of the gusts.
    GustTicks,
    /// Translation of the root.
    RootTranslation,
    /// Rotation of the root.
    RootRotation,
    /// A word of [`crate::Tunables::to_words`], counted by the component.
    Tunable,
}

/// An array of the state, a vector a moving point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PointField {
    /// Target of skinning.
    X,
    /// Acceleration by gravity and wind.
    F,
    /// Offset from the target.
    Y,
    /// Velocity.
    V,
    /// Slope of the target.
    Slope,
    /// Offset shown, bind space.
    Offset,
}

impl PointField {
    /// In the order of a saved state.
    const SAVED: [Self; 6] = [Self::X, Self::Y, Self::V, Self::Slope, Self::F, Self::Offset];

    /// The stage that makes it.
    #[must_use]
    pub fn stage(self) -> Stage {
        match self {
            Self::X | Self::F => Stage::Skin,
            Self::Y | Self::V | Self::Slope => Stage::Dynamics,
            Self::Offset => Stage::Embed,
        }
    }
}

/// A number of the state.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// One that is no array.
    Life {
        /// Which.
        field: LifeField,
        /// Component.
        component: u8,
    },
    /// One of a moving point.
    Point {
        /// Index of the point.
        point: u32,
        /// First render vertex on it.
        vertex: Option<u32>,
        /// Which array.
        field: PointField,
        /// Component: 0, 1, 2 for x, y, z.
        component: u8,
    },
}

impl Place {
    /// The stage that makes it.
    #[must_use]
    pub fn stage(&self) -> Stage {
        match self {
            Self::Life { .. } => Stage::Life,
            Self::Point { field, .. } => field.stage(),
        }
    }

    /// The number at byte `offset` of a saved state with `active` points.
    fn at(offset: usize, active: usize) -> Self {
        // Start of each field of the head, bytes a component.
        const LIFE: [(usize, usize, LifeField); 9] = [
            (0, 16, LifeField::Header),
            (16, 4, LifeField::Flags),
            (20, 4, LifeField::Divisor),
            (24, 4, LifeField::Turn),
            (28, 4, LifeField::Pending),
            (32, 8, LifeField::GustTicks),
            (40, 8, LifeField::RootTranslation),
            (64, 4, LifeField::RootRotation),
            (80, 4, LifeField::Tunable),
        ];
        let narrow = |x: usize| u8::try_from(x).unwrap_or(u8::MAX);
        if offset < HEAD {
            let row = LIFE.iter().rev().find(|(start, ..)| *start <= offset);
            let (start, width, field) = *row.unwrap_or(&LIFE[0]);
            return Self::Life { field, component: narrow((offset - start) / width) };
        }
        let word = (offset - HEAD) / 4;
        let field = PointField::SAVED[(word / (3 * active).max(1)).min(5)];
        let point = u32::try_from(word / 3 % active.max(1)).unwrap_or(u32::MAX);
        Self::Point { point, vertex: None, field, component: narrow(word % 3) }
    }
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Life { field: LifeField::Tunable, component } => {
                write!(f, "tunable {}", Tunable(*component))
            }
            Self::Life { field, component } => write!(f, "{field:?}[{component}]"),
            Self::Point { point, vertex, field, component } => {
                let axis = ["x", "y", "z"].get(usize::from(*component)).unwrap_or(&"?");
                match vertex {
                    Some(vertex) => write!(f, "vertex {vertex} (point {point})")?,
                    None => write!(f, "point {point}")?,
                }
                write!(f, ", {}.{axis}", FieldName(*field))
            }
        }
    }
}

struct FieldName(PointField);

impl fmt::Display for FieldName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self.0 {
            PointField::X => "x",
            PointField::F => "f",
            PointField::Y => "y",
            PointField::V => "v",
            PointField::Slope => "slope",
            PointField::Offset => "offset",
        })
    }
}

/// A word of the tunables.
struct Tunable(u8);

impl fmt::Display for Tunable {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        const GLOBAL: [&str; 8] =
            ["gust", "gust_rate", "inertia", "gain", "frequency", "damping", "teleport", "settle_after"];
        const REGION: [&str; 4] = ["frequency", "damping", "gain", "max_offset"];
        match usize::from(self.0) {
            i @ 0..3 => write!(f, "gravity[{i}]"),
            i @ 3..6 => write!(f, "wind[{}]", i - 3),
            i @ 6..14 => f.write_str(GLOBAL[i - 6]),
            i => write!(f, "{} of region {}", REGION[(i - 14) % 4], (i - 14) / 4),
        }
    }
}

/// A number that differs, with the bits on both sides.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Detail {
    /// Frame after which the values were taken: the first snapshot at or after the difference.
    pub frame: u64,
    /// Which number.
    pub place: Place,
    /// Bits in the replay, low bits of the word.
    pub recorded: u64,
    /// Bits here.
    pub computed: u64,
}

impl Detail {
    /// Distance of two finite floats of a point in units of the last place; `None` for other numbers.
    #[must_use]
    pub fn ulps(&self) -> Option<u32> {
        let ordered = |bits: u64| {
            let bits = u32::try_from(bits).ok()?;
            let magnitude = i64::from(bits & 0x7fff_ffff);
            (magnitude < 0x7f80_0000).then_some(if bits >> 31 == 0 { magnitude } else { -magnitude })
        };
        match self.place {
            Place::Point { .. } => {
                u32::try_from(ordered(self.recorded)?.abs_diff(ordered(self.computed)?)).ok()
            }
            Place::Life { .. } => None,
        }
    }
}

impl fmt::Display for Detail {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { frame, place, recorded, computed } = self;
        write!(f, "{place}: recorded {recorded:#010x}, computed {computed:#010x} (after frame {frame})")
    }
}

/// The first number, in the order of the stages, in which the state of `character` differs from a saved one.
///
/// `exact`: floats of the points are compared as they are; otherwise by their [`canonical`] bits.
pub(super) fn first_difference(
    character: &Character<'_>,
    saved: &[u8],
    exact: bool,
) -> Option<(Place, [u64; 2])> {
    let active = character.asset.meta.active as usize;
    let mut offset = 0_usize;
    let mut first: Option<(Place, [u64; 2])> = None;
    let same = |a: u32, b: u32| a == b || (!exact && canonical(a) == canonical(b));
    character.write_state(&mut |bytes| {
        let start = offset;
        offset += bytes.len();
        let recorded = saved.get(start..offset).unwrap_or_default();
        if recorded == bytes {
            return;
        }
        let step = if start < HEAD { bytes.len() } else { 4 };
        for (i, (a, b)) in recorded.chunks(step).zip(bytes.chunks(step)).enumerate() {
            let [a, b] = [a, b].map(wide);
            let place = Place::at(start + i * step, active);
            let equal = match place {
                Place::Life { .. } => a == b,
                Place::Point { .. } => same(low(a), low(b)),
            };
            if !equal && first.is_none_or(|(other, _)| order(&place) < order(&other)) {
                first = Some((place, [a, b]));
            }
        }
    });
    first.map(|(place, bits)| (with_vertex(place, character), bits))
}

/// Place in the order of the stages; equal ones keep the order of the state.
fn order(place: &Place) -> (Stage, u8) {
    match place {
        Place::Life { .. } => (Stage::Life, 0),
        Place::Point { field, .. } => (field.stage(), *field as u8),
    }
}

fn with_vertex(place: Place, character: &Character<'_>) -> Place {
    match place {
        Place::Point { point, field, component, .. } => {
            let vertex = character.asset.point_of_vertex.iter().position(|p| *p == point);
            let vertex = vertex.and_then(|v| u32::try_from(v).ok());
            Place::Point { point, vertex, field, component }
        }
        life @ Place::Life { .. } => life,
    }
}

/// Up to eight bytes as a number.
fn wide(bytes: &[u8]) -> u64 {
    bytes.iter().take(8).rev().fold(0, |x, b| (x << 8) | u64::from(*b))
}

fn low(x: u64) -> u32 {
    #[allow(clippy::cast_possible_truncation, reason = "four bytes")]
    {
        x as u32
    }
}
