//! A character that owns its memory.

use crate::asset::{Parsed, RawAsset};
use crate::error::Thrown;
use crate::memory::{Aligned, address};
use self_cell::{MutBorrow, self_cell};
use sinew::replay::{Event, RecordError, Tape};
use sinew::{Affine, Character, Pose, Root, Stepped, Tunables};
use std::rc::Rc;
use wasm_bindgen::prelude::wasm_bindgen;

struct Owner {
    asset: Rc<Parsed>,
    memory: MutBorrow<Aligned>,
}

self_cell! {
    struct Living {
        owner: Owner,
        #[covariant]
        dependent: Character,
    }
}

/// A character in the module's memory.
///
/// Methods that return a number of type `usize` return an address in that memory.
#[wasm_bindgen]
#[allow(missing_debug_implementations, reason = "a handle for JavaScript")]
pub struct RawCharacter {
    living: Living,
    pose: Vec<Affine>,
    /// While it is recorded.
    tape: Option<Tape<Vec<u8>>>,
    /// Why the last step was refused.
    refusal: Option<RecordError>,
    /// Made when first asked for: share of the largest offset of each render vertex.
    heat: Vec<f32>,
    /// Made when first asked for: skinned positions, then normals.
    skinned: Vec<[f32; 3]>,
    /// Made when first asked for: a saved state.
    state: Aligned,
}

/// `n` elements, or an error without memory for them.
fn filled<T: Clone>(n: usize, value: T) -> Result<Vec<T>, Thrown> {
    let mut out = Vec::new();
    let full = |_| Thrown::out_of_memory(&format!("{n} elements"));
    out.try_reserve_exact(n).map_err(full)?;
    out.resize(n, value);
    Ok(out)
}

#[wasm_bindgen]
impl RawCharacter {
    /// A character at rest.
    ///
    /// # Errors
    ///
    /// Without memory for it.
    #[wasm_bindgen(constructor)]
    pub fn new(asset: &RawAsset) -> Result<Self, Thrown> {
        let asset = Rc::clone(&asset.0);
        let joints = asset.borrow_dependent().joint_from_bind.len();
        let len = Character::required_len(asset.borrow_dependent()) * size_of::<f32>();
        let owner = Owner { asset, memory: MutBorrow::new(Aligned::zeroed(len)?) };
        let living = Living::try_new(owner, |owner| {
            Character::new(*owner.asset.borrow_dependent(), owner.memory.borrow_mut().floats_mut())
        })?;
        let pose = filled(joints, sinew::math::affine::IDENTITY)?;
        let (heat, skinned, state) = (Vec::new(), Vec::new(), Aligned::default());
        Ok(Self { living, pose, tape: None, refusal: None, heat, skinned, state })
    }

    fn get(&self) -> &Character<'_> {
        self.living.borrow_dependent()
    }

    /// The pose to fill in: twelve floats a joint.
    #[must_use]
    pub fn pose(&self) -> usize {
        address(&self.pose)
    }

    /// Positions of the render vertices, bind space.
    #[must_use]
    pub fn positions(&self) -> usize {
        address(self.get().positions())
    }

    /// Normals of the render vertices, bind space.
    #[must_use]
    pub fn normals(&self) -> usize {
        address(self.get().normals())
    }

    /// Offsets of the moving points, bind space.
    #[must_use]
    pub fn offsets(&self) -> usize {
        address(self.get().offsets())
    }

    /// Advances by `dt` seconds to the pose filled in: 1 where the buffers are new, 0 where nothing was due, 2
    /// where the step was refused. [`Self::refusal`] tells why: a `Result` would cost JavaScript an array a step.
    #[allow(clippy::too_many_arguments, reason = "numbers cross without an allocation, arrays do not")]
    pub fn step(&mut self, x: f64, y: f64, z: f64, qx: f32, qy: f32, qz: f32, qw: f32, dt: f32) -> u32 {
        let root = Root { translation: [x, y, z], rotation: [qx, qy, qz, qw] };
        let (tape, pose) = (&mut self.tape, Pose { root, root_from_joint: &self.pose });
        let stepped = self.living.with_dependent_mut(|_, character| match tape {
            Some(tape) => tape.step(character, pose, dt),
            None => Ok(character.step(pose, dt)?),
        });
        self.told(stepped)
    }

    /// As [`Self::step`], to a clip at `time`, s.
    #[allow(clippy::too_many_arguments, reason = "numbers cross without an allocation, arrays do not")]
    pub fn step_clip(
        &mut self,
        clip: u32,
        time: f32,
        x: f64,
        y: f64,
        z: f64,
        qx: f32,
        qy: f32,
        qz: f32,
        qw: f32,
        dt: f32,
    ) -> u32 {
        let root = Root { translation: [x, y, z], rotation: [qx, qy, qz, qw] };
        let tape = &mut self.tape;
        let stepped = self.living.with_dependent_mut(|_, character| match tape {
            Some(tape) => tape.step_clip(character, clip, time, root, dt),
            None => Ok(character.step_clip(clip, time, root, dt)?),
        });
        self.told(stepped)
    }

    /// What a step did, as a number.
    fn told(&mut self, stepped: Result<Stepped, RecordError>) -> u32 {
        match stepped {
            Ok(Stepped::Held) => 0,
            Ok(Stepped::Advanced) => 1,
            Err(error) => {
                self.refusal = Some(error);
                2
            }
        }
    }

    /// Throws why the last step was refused. A recording that has no room left ends.
    ///
    /// # Errors
    ///
    /// That.
    pub fn refusal(&mut self) -> Result<(), Thrown> {
        let refusal = self.refusal.take();
        self.keep(refusal.map_or(Ok(()), Err))
    }

    fn keep(&mut self, result: Result<(), RecordError>) -> Result<(), Thrown> {
        if matches!(result, Err(RecordError::SinkFull)) {
            self.tape = None;
        }
        Ok(result?)
    }

    /// Does `event`, on the tape where there is one.
    fn event(&mut self, event: &Event<'_>) -> Result<(), Thrown> {
        let tape = &mut self.tape;
        let done = self.living.with_dependent_mut(|_, character| match tape {
            Some(tape) => tape.event(character, event),
            None => event.apply(character),
        });
        self.keep(done)
    }

    /// Plays a clip in a loop, unseen.
    ///
    /// # Errors
    ///
    /// As [`Character::warm_up`], and while it is recorded.
    #[allow(clippy::too_many_arguments, reason = "numbers cross without an allocation, arrays do not")]
    pub fn warm_up(
        &mut self,
        clip: u32,
        loops: u32,
        x: f64,
        y: f64,
        z: f64,
        qx: f32,
        qy: f32,
        qz: f32,
        qw: f32,
        dt: f32,
    ) -> Result<(), Thrown> {
        if self.tape.is_some() {
            return Err(Thrown::new("RECORDING", &"warm up before recording: a replay cannot hold it"));
        }
        let root = Root { translation: [x, y, z], rotation: [qx, qy, qz, qw] };
        self.living.with_dependent_mut(|_, character| character.warm_up(clip, loops, root, dt))?;
        Ok(())
    }

    /// [`Character::reset`].
    ///
    /// # Errors
    ///
    /// Without memory for the recording.
    pub fn reset(&mut self) -> Result<(), Thrown> {
        self.event(&Event::Reset)
    }

    /// [`Character::settle`].
    ///
    /// # Errors
    ///
    /// Without memory for the recording.
    pub fn settle(&mut self) -> Result<(), Thrown> {
        self.event(&Event::Settle)
    }

    /// [`Character::teleport`].
    ///
    /// # Errors
    ///
    /// Without memory for the recording.
    pub fn teleport(&mut self) -> Result<(), Thrown> {
        self.event(&Event::Teleport)
    }

    /// [`Character::freeze`].
    ///
    /// # Errors
    ///
    /// Without memory for the recording.
    pub fn freeze(&mut self, frozen: bool) -> Result<(), Thrown> {
        self.event(&Event::Freeze(frozen))
    }

    /// [`Character::set_rate_divisor`].
    ///
    /// # Errors
    ///
    /// Without memory for the recording.
    pub fn set_rate_divisor(&mut self, divisor: u32) -> Result<(), Thrown> {
        self.event(&Event::Divisor(divisor))
    }

    /// [`Tunables::to_words`].
    #[must_use]
    pub fn tunables(&self) -> Vec<f32> {
        self.get().tunables().to_words().to_vec()
    }

    /// [`Tunables::from_words`], in force from now on.
    ///
    /// # Errors
    ///
    /// For a value out of its range; nothing changes then.
    pub fn set_tunables(&mut self, words: &[f32]) -> Result<(), Thrown> {
        let words =
            words.try_into().map_err(|_| Thrown::new("TUNABLE_COUNT", &"another number of tunables"))?;
        let tunables = Tunables::from_words(words)?;
        self.event(&Event::Tunables(tunables))
    }

    /// Bytes of a saved state.
    #[must_use]
    pub fn state_len(&self) -> usize {
        self.get().state_len()
    }

    /// Saves the state and returns where it stands.
    ///
    /// # Errors
    ///
    /// Without memory for it.
    pub fn save_state(&mut self) -> Result<usize, Thrown> {
        if self.state.is_empty() {
            self.state = Aligned::zeroed(self.state_len())?;
        }
        self.living.borrow_dependent().save_state(self.state.bytes_mut())?;
        Ok(address(self.state.bytes()))
    }

    /// Restores a state.
    ///
    /// # Errors
    ///
    /// As [`Character::load_state`]; nothing changes then.
    pub fn load_state(&mut self, bytes: &[u8]) -> Result<(), Thrown> {
        self.event(&Event::Load(bytes))
    }

    /// Begins a recording, with a snapshot after every `snapshot_every`-th step.
    ///
    /// # Errors
    ///
    /// While it is recorded, and without memory for it.
    pub fn record(&mut self, snapshot_every: u32) -> Result<(), Thrown> {
        if self.tape.is_some() {
            return Err(Thrown::new("RECORDING", &"already recording: stop that recording first"));
        }
        self.tape = Some(Tape::begin(self.get(), snapshot_every, Vec::new())?);
        Ok(())
    }

    /// Whether it is recorded.
    #[must_use]
    pub fn is_recording(&self) -> bool {
        self.tape.is_some()
    }

    /// Ends the recording and returns the replay.
    ///
    /// # Errors
    ///
    /// While it is not recorded, and without memory for the end.
    pub fn stop_recording(&mut self) -> Result<Vec<u8>, Thrown> {
        let tape =
            self.tape.take().ok_or_else(|| Thrown::new("NOT_RECORDING", &"nothing is being recorded"))?;
        Ok(tape.finish(self.get())?.0)
    }

    /// Digests of what pose, skin, dynamics and embed made.
    #[must_use]
    pub fn digests(&self) -> Vec<u64> {
        let digests = self.get().digests();
        vec![digests.pose, digests.skin, digests.dynamics, digests.embed]
    }

    /// Writes the share of its largest offset that each render vertex is away from rest.
    ///
    /// # Errors
    ///
    /// Without memory for it.
    pub fn heat(&mut self) -> Result<usize, Thrown> {
        let character = self.living.borrow_dependent();
        let asset = character.asset();
        if self.heat.is_empty() {
            self.heat = filled(asset.point_of_vertex.len(), 0.0)?;
        }
        let regions = &character.tunables().regions;
        for vertex in asset.moved {
            let point = asset.point_of_vertex[*vertex as usize] as usize;
            let region = &regions[usize::from(asset.region_of_point[point])];
            let [x, y, z] = character.offsets()[point];
            let longest = region.max_offset * asset.meta.body_size;
            self.heat[*vertex as usize] = sinew::math::float::sqrt(x * x + y * y + z * z) / longest;
        }
        Ok(address(&self.heat))
    }

    /// Skins the render vertices, with flesh or without: positions, then normals, in the root's frame.
    ///
    /// # Errors
    ///
    /// Without memory for them.
    pub fn skin(&mut self, flesh: bool) -> Result<usize, Thrown> {
        let character = self.living.borrow_dependent();
        let vertices = character.positions().len();
        if self.skinned.is_empty() {
            self.skinned = filled(2 * vertices, [0.0; 3])?;
        }
        let (positions, normals) = self.skinned.split_at_mut(vertices);
        character.skin_surface(flesh, positions, normals)?;
        Ok(address(&self.skinned))
    }
}
