//! Saved states: byte-exact, versioned, for rollback and replays.
//!
//! ```text
//! "SNST", version u16, 0 u16, asset hash u64, life (fixed words), five arrays of the state, offsets, digest u64
//! ```
//!
//! Little-endian; the digest covers every byte before it.

use crate::character::{Character, surface};
use crate::kernel::unskin;
use crate::life::{Life, Phase};
use crate::math::{digest, float};
use crate::stage::embed;
use crate::stage::pose::Root;
use crate::tunables::Tunables;
use core::fmt;

const MAGIC: [u8; 4] = *b"SNST";
const VERSION: u16 = 1;
/// Bytes before the arrays: header, flags, divisor, turn, pending, ticks, root, tunables.
pub(crate) const HEAD: usize = 16 + 4 * 4 + 8 + 24 + 16 + 4 * Tunables::WORDS;

/// Largest number of a state that can come of steps (see the limits of a pose).
const LARGEST: f32 = 1e32;

/// Why bytes are not a state of this character; nothing changed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum StateError {
    /// The buffer has not [`Character::state_len`] bytes.
    Length {
        /// Bytes needed.
        expected: usize,
        /// Bytes given.
        found: usize,
    },
    /// Not a saved state, or one of another version.
    BadHeader,
    /// A state of another asset: its hash.
    OtherAsset(u64),
    /// The bytes are damaged.
    Damaged,
}

impl StateError {
    /// Stable name of the error, for programs; its text may change, this does not.
    #[must_use]
    pub const fn code(&self) -> &'static str {
        match self {
            Self::Length { .. } => "STATE_WRONG_LENGTH",
            Self::BadHeader => "STATE_BAD_HEADER",
            Self::OtherAsset(_) => "STATE_OTHER_ASSET",
            Self::Damaged => "STATE_DAMAGED",
        }
    }
}

impl fmt::Display for StateError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Length { expected, found } => write!(f, "state has {found} bytes, {expected} are needed"),
            Self::BadHeader => write!(f, "not a saved state of this version"),
            Self::OtherAsset(hash) => write!(f, "state of another asset, {hash:016x}"),
            Self::Damaged => write!(f, "saved state is damaged"),
        }
    }
}

impl core::error::Error for StateError {}

/// Writes fields one after the other.
struct Writer<'a>(&'a mut [u8]);

impl Writer<'_> {
    fn put(&mut self, bytes: &[u8]) {
        let (head, rest) = core::mem::take(&mut self.0).split_at_mut(bytes.len());
        head.copy_from_slice(bytes);
        self.0 = rest;
    }
}

/// Reads fields one after the other; the length was checked.
struct Reader<'a>(&'a [u8]);

impl Reader<'_> {
    fn take<const N: usize>(&mut self) -> [u8; N] {
        let (head, rest) = self.0.split_first_chunk().copied_head();
        self.0 = rest;
        head
    }

    fn u32(&mut self) -> u32 {
        u32::from_le_bytes(self.take())
    }

    fn u64(&mut self) -> u64 {
        u64::from_le_bytes(self.take())
    }

    fn f32(&mut self) -> f32 {
        f32::from_le_bytes(self.take())
    }

    fn f64(&mut self) -> f64 {
        f64::from_le_bytes(self.take())
    }
}

/// The head of a split, or zeros past the end.
trait Head<'a, const N: usize> {
    fn copied_head(self) -> ([u8; N], &'a [u8]);
}

impl<'a, const N: usize> Head<'a, N> for Option<(&'a [u8; N], &'a [u8])> {
    fn copied_head(self) -> ([u8; N], &'a [u8]) {
        self.map_or(([0; N], &[]), |(head, rest)| (*head, rest))
    }
}

impl Character<'_> {
    /// Bytes of a saved state.
    #[must_use]
    pub fn state_len(&self) -> usize {
        HEAD + 6 * 12 * self.asset.meta.active as usize + 8
    }

    /// Saves the state.
    ///
    /// # Errors
    ///
    /// [`StateError::Length`] unless `out.len() == self.state_len()`.
    pub fn save_state(&self, out: &mut [u8]) -> Result<(), StateError> {
        self.check_length(out.len())?;
        let content = out.len() - 8;
        let mut w = Writer(&mut out[..content]);
        self.write_state(&mut |bytes| w.put(bytes));
        let hash = digest::of_bytes(&out[..content]);
        out[content..].copy_from_slice(&hash.to_le_bytes());
        Ok(())
    }

    /// Hands the bytes of a saved state but the closing digest to `put`, piece by piece; no field of
    /// the head is split, nor a float of the arrays.
    pub(crate) fn write_state(&self, put: &mut impl FnMut(&[u8])) {
        let life = &self.life;
        put(&MAGIC);
        put(&VERSION.to_le_bytes());
        put(&[0; 2]);
        put(&self.asset.hash.to_le_bytes());
        let phase = match life.phase {
            Phase::Settle => 0_u32,
            Phase::Fresh => 1,
            Phase::Running => 2,
        };
        let flags = phase | (u32::from(life.frozen) << 2) | (u32::from(life.teleport) << 3);
        for word in [flags, life.divisor, life.turn, life.pending.to_bits()] {
            put(&word.to_le_bytes());
        }
        put(&life.gust_ticks.to_le_bytes());
        life.root.translation.iter().for_each(|x| put(&x.to_le_bytes()));
        life.root.rotation.iter().for_each(|x| put(&x.to_le_bytes()));
        life.tunables.to_words().iter().for_each(|x| put(&x.to_le_bytes()));
        let mut floats = |x: &[f32]| {
            let (blocks, tail) = x.as_chunks::<8>();
            blocks.iter().for_each(|b| put(b.map(f32::to_le_bytes).as_flattened()));
            tail.iter().for_each(|x| put(&x.to_le_bytes()));
        };
        self.memory.state.arrays().iter().for_each(|a| floats(a.as_flattened()));
        floats(self.memory.offsets.as_flattened());
    }

    /// Restores a state; the buffers show it, and the next step goes on from it bit for bit.
    ///
    /// # Errors
    ///
    /// [`StateError`] for bytes that are not an undamaged state of this asset; nothing changes then.
    pub fn load_state(&mut self, bytes: &[u8]) -> Result<(), StateError> {
        self.check_length(bytes.len())?;
        let (content, hash) = bytes.split_at(bytes.len() - 8);
        let mut r = Reader(content);
        if (r.take(), r.take(), r.take()) != (MAGIC, VERSION.to_le_bytes(), [0_u8; 2]) {
            return Err(StateError::BadHeader);
        }
        let asset = r.u64();
        if asset != self.asset.hash {
            return Err(StateError::OtherAsset(asset));
        }
        if digest::of_bytes(content).to_le_bytes() != hash {
            return Err(StateError::Damaged);
        }
        let life = read_life(&mut r).ok_or(StateError::Damaged)?;
        let (state, offsets) = r.0.split_at(r.0.len() / 6 * 5);
        let below = |bytes: &[u8], most: f32| {
            bytes.as_chunks::<4>().0.iter().all(|x| float::abs(f32::from_le_bytes(*x)) <= most)
        };
        if !below(state, LARGEST) || !below(offsets, unskin::LARGEST) {
            return Err(StateError::Damaged);
        }
        self.life = life;
        self.apply_tunables();
        let m = &mut self.memory;
        let s = &mut m.state;
        for array in [&mut *s.x, &mut *s.y, &mut *s.v, &mut *s.slope, &mut *s.f, &mut *m.offsets] {
            array.as_flattened_mut().iter_mut().for_each(|x| *x = r.f32());
        }
        embed::embed(surface(&self.asset), m.offsets, m.positions, m.normals);
        Ok(())
    }

    fn check_length(&self, found: usize) -> Result<(), StateError> {
        let expected = self.state_len();
        if expected == found { Ok(()) } else { Err(StateError::Length { expected, found }) }
    }
}

/// The fixed words; `None` where one is out of its range.
fn read_life(r: &mut Reader<'_>) -> Option<Life> {
    let (flags, divisor, turn, pending) = (r.u32(), r.u32(), r.u32(), r.f32());
    let phase = match flags & 3 {
        0 => Phase::Settle,
        1 => Phase::Fresh,
        2 => Phase::Running,
        _ => return None,
    };
    let gust_ticks = r.u64();
    let translation = [r.f64(), r.f64(), r.f64()];
    let rotation = [r.f32(), r.f32(), r.f32(), r.f32()];
    let root = Root { translation, rotation };
    let mut words = [0.0; Tunables::WORDS];
    words.iter_mut().for_each(|w| *w = r.f32());
    let tunables = Tunables::from_words(&words).ok()?.flushed();
    let (frozen, teleport) = (flags & 4 != 0, flags & 8 != 0);
    let valid = flags < 16 && turn < divisor && (0.0..=1e9).contains(&pending) && root.is_valid();
    valid.then_some(Life { phase, frozen, teleport, divisor, turn, pending, gust_ticks, root, tunables })
}
