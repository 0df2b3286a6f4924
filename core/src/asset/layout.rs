//! Where everything stands in the file: one table for reader, writer and documentation.

use core::fmt;

/// First bytes of an asset.
pub const MAGIC: [u8; 4] = *b"SINW";
/// The version that this build writes and reads.
pub const VERSION: u16 = 1;
/// Bytes of the header.
pub const HEADER_LEN: usize = 32;
/// Bytes of an entry of the section table.
pub const ENTRY_LEN: usize = 16;
/// Sections start on multiples of this.
pub const ALIGNMENT: usize = 16;
/// Where the content hash stands in the header: eight bytes that it does not cover.
pub const HASH_OFFSET: usize = 16;
/// Words of [`Section::Meta`].
pub const META_WORDS: usize = 32;
/// Most regions an asset can have.
pub const MAX_REGIONS: usize = 16;
/// Parent of a root node.
pub const NO_PARENT: u32 = u32::MAX;

macro_rules! sections {
    ($($(#[$doc:meta])* $name:ident $tag:literal $count:expr, $size:literal;)*) => {
        /// A section of the asset, in file order.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub enum Section { $($(#[$doc])* $name,)* }

        impl Section {
            /// All sections in file order.
            pub const ALL: [Self; [$($tag),*].len()] = [$(Self::$name),*];

            /// Four letters that name it in the file.
            #[must_use]
            pub const fn tag(self) -> [u8; 4] {
                match self { $(Self::$name => *$tag,)* }
            }

            /// Bytes that it has for the counts in `meta`.
            #[must_use]
            pub fn byte_len(self, meta: &Meta) -> u64 {
                match self {
                    $(Self::$name => {
                        let count: fn(&Meta) -> u64 = $count;
                        count(meta).saturating_mul($size)
                    })*
                }
            }
        }
    };
}

impl Section {
    /// Bytes of a number in the section; 1 for text.
    #[must_use]
    pub const fn width(self) -> usize {
        match self {
            Self::RegionOfPoint | Self::RegionNames | Self::ClipNames => 1,
            Self::InfluenceJoints => 2,
            _ => 4,
        }
    }
}

sections! {
    /// Counts and constants, `META_WORDS` words.
    Meta b"META" |_| 1, 128;
    /// Inverse bind matrices: four columns of three floats a joint.
    JointFromBind b"JBND" |m| m.joints.into(), 48;
    /// Node of each joint.
    JointNode b"JNOD" |m| m.joints.into(), 4;
    /// Rest position of each point, bind space: three floats.
    Rest b"REST" |m| m.points.into(), 12;
    /// Joint indices, `stride` a point, `u16`.
    InfluenceJoints b"INFJ" |m| u64::from(m.points).saturating_mul(m.stride.into()), 2;
    /// Weights, `stride` a point, falling, sum 1.
    InfluenceWeights b"INFW" |m| u64::from(m.points).saturating_mul(m.stride.into()), 4;
    /// Region of each active point, one byte.
    RegionOfPoint b"REGN" |m| m.active.into(), 1;
    /// Softness of each active point, `0..=1`.
    Softness b"SOFT" |m| m.active.into(), 4;
    /// Point of each render vertex.
    PointOfVertex b"PNTV" |m| m.vertices.into(), 4;
    /// Rest normal of each render vertex, bind space.
    Normals b"NORM" |m| m.vertices.into(), 12;
    /// Render vertices on active points.
    Moved b"MOVE" |m| m.moved.into(), 4;
    /// Render vertices whose normals turn.
    Lit b"LITV" |m| m.lit.into(), 4;
    /// Four neighbouring points of each of them.
    StencilPoints b"STNP" |m| m.lit.into(), 16;
    /// Four tangent vectors of each of them.
    StencilTangents b"STNT" |m| m.lit.into(), 48;
    /// Frequency (Hz), damping ratio, gain, largest offset (body sizes) of each region.
    Regions b"RGNS" |m| m.regions.into(), 16;
    /// Name of each region, UTF-8, 16 bytes padded with zeros.
    RegionNames b"RGNN" |m| m.regions.into(), 16;
    /// `[node in the file, mesh, primitive, first vertex, vertices, 0]` of each primitive.
    Primitives b"PRIM" |m| m.primitives.into(), 24;
    /// Parent of each node (`NO_PARENT` for a root); parents come first.
    Parents b"NPAR" |m| m.nodes.into(), 4;
    /// Index of each node in the file it came from.
    NodeIndex b"NIDX" |m| m.nodes.into(), 4;
    /// Rest translation, rotation, scale of each node: ten floats.
    NodeRest b"NTRS" |m| m.nodes.into(), 40;
    /// `[first channel, channels, duration bits, 0]` of each clip.
    Clips b"CLIP" |m| m.clips.into(), 16;
    /// Name of each clip, UTF-8, 32 bytes padded with zeros.
    ClipNames b"CLPN" |m| m.clips.into(), 32;
    /// `[node, property + 4·interpolation, first key, keys, first value, 0]` of each channel.
    Channels b"CHAN" |m| m.channels.into(), 24;
    /// Key times, s.
    Times b"TIME" |m| m.times.into(), 4;
    /// Key values.
    Values b"VALU" |m| m.values.into(), 4;
}

impl fmt::Display for Section {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.tag().escape_ascii())
    }
}

/// Counts and constants of an asset.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Meta {
    /// Distinct points: position and influences.
    pub points: u32,
    /// Points with flesh; they come first.
    pub active: u32,
    /// Render vertices.
    pub vertices: u32,
    /// Joints.
    pub joints: u32,
    /// Influences a point.
    pub stride: u32,
    /// Regions.
    pub regions: u32,
    /// Render vertices on active points.
    pub moved: u32,
    /// Render vertices whose normals turn.
    pub lit: u32,
    /// Nodes of the skeleton.
    pub nodes: u32,
    /// Clips.
    pub clips: u32,
    /// Channels of all clips.
    pub channels: u32,
    /// Key times of all channels.
    pub times: u32,
    /// Values of all channels.
    pub values: u32,
    /// Primitives.
    pub primitives: u32,
    /// Diagonal of the rest pose's bounding box, model units.
    pub body_size: f32,
    /// Direction of gravity as authored, bind space, for unit gravity in model space.
    pub bind_down: [f32; 3],
    /// Strength of gravity as authored, body sizes per s².
    pub gravity: f32,
    /// Digest of the file that was baked.
    pub source: u64,
}

impl Meta {
    /// From the words of the section.
    #[must_use]
    pub fn from_words(w: &[u32; META_WORDS]) -> Self {
        let f = f32::from_bits;
        let [points, active, vertices, joints, stride, regions, moved, lit, nodes, clips, rest @ ..] = *w;
        let [channels, times, values, primitives, size, x, y, z, gravity, low, high, ..] = rest;
        Self {
            points,
            active,
            vertices,
            joints,
            stride,
            regions,
            moved,
            lit,
            nodes,
            clips,
            channels,
            times,
            values,
            primitives,
            body_size: f(size),
            bind_down: [f(x), f(y), f(z)],
            gravity: f(gravity),
            source: u64::from(low) | (u64::from(high) << 32),
        }
    }

    /// To the words of the section.
    #[must_use]
    pub fn to_words(&self) -> [u32; META_WORDS] {
        let [x, y, z] = self.bind_down.map(f32::to_bits);
        #[allow(clippy::cast_possible_truncation, reason = "the low and the high half")]
        let (low, high) = (self.source as u32, (self.source >> 32) as u32);
        let counts = [self.points, self.active, self.vertices, self.joints, self.stride, self.regions];
        let counts2 = [self.moved, self.lit, self.nodes, self.clips, self.channels, self.times];
        let constants = [self.values, self.primitives, self.body_size.to_bits(), x, y, z];
        let tail = [self.gravity.to_bits(), low, high];
        let all = counts.iter().chain(&counts2).chain(&constants).chain(&tail);
        let mut words = [0; META_WORDS];
        for (to, from) in words.iter_mut().zip(all) {
            *to = *from;
        }
        words
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn meta_goes_round() {
        let words: [u32; META_WORDS] =
            core::array::from_fn(|i| if i < 21 { 0x3f80_0001 + u32::try_from(i).unwrap() } else { 0 });
        assert_eq!(Meta::from_words(&words).to_words(), words);
    }
}
