//! A character: the stages in order, and time.

use crate::asset::Asset;
use crate::asset::layout::MAX_REGIONS;
use crate::kernel::clip::Channels;
use crate::kernel::copy::copy;
use crate::kernel::skin::{self, Rows};
use crate::kernel::spring::{Spring, Step};
use crate::kernel::tiny::{flush, flush_all};
use crate::kernel::unskin::{self, Limit, Tissue};
use crate::life::{Life, Phase};
use crate::math::affine;
use crate::math::{canary, float, noise, vec3};
use crate::stage::embed::Surface;
use crate::stage::pose::{Root, Skeleton};
use crate::stage::skin::Targets;
use crate::stage::{embed, pose, skin as skin_stage};
use crate::step::{Digests, Pose, StepError, Stepped, check_joints};
use crate::tunables::{Region, TunableError, Tunables};
use crate::workspace::{LengthError, Workspace};

/// Offsets below this share of the body count as rest.
const REST: f32 = 1e-7;
/// A frequency below this, Hz, counts as 0.
const SLOWEST: f32 = 1e-3;
/// Bits of the canary's word under which results would differ: rounding, and contraction.
const ROUNDING: u32 = 0b100_0111;
/// Time shorter than this, s, waits for the next step.
const SHORTEST_STEP: f32 = 1e-5;

/// A character in the caller's memory.
///
/// # Examples
///
/// ```no_run
/// # fn run(bytes: &[u8]) -> Result<(), Box<dyn core::error::Error>> {
/// use sinew::{Asset, Character, Root};
/// let asset = Asset::parse(bytes)?;
/// let mut memory = vec![0.0; Character::required_len(&asset)];
/// let mut character = Character::new(asset, &mut memory)?;
/// for frame in 0..60_u8 {
///     character.step_clip(0, f32::from(frame) / 60.0, Root::default(), 1.0 / 60.0)?;
/// }
/// let (positions, normals) = (character.positions(), character.normals());
/// # Ok(()) }
/// ```
#[derive(Debug)]
pub struct Character<'a> {
    pub(crate) asset: Asset<'a>,
    pub(crate) memory: Workspace<'a>,
    pub(crate) life: Life,
    springs: [Spring; MAX_REGIONS],
    limits: [Limit; MAX_REGIONS],
    /// Weights of the last step, valid for steps of `steps_dt` seconds.
    steps: [Step; MAX_REGIONS],
    steps_dt: f32,
    /// Canary word of the last step.
    environment: u32,
}

impl<'a> Character<'a> {
    /// Length of the memory that [`Self::new`] needs, in floats.
    #[must_use]
    pub fn required_len(asset: &Asset<'_>) -> usize {
        Workspace::required_len(asset)
    }

    /// A character at rest. Its tunables are the asset's.
    ///
    /// # Errors
    ///
    /// [`LengthError`] unless `memory.len() == Self::required_len(&asset)`.
    pub fn new(asset: Asset<'a>, memory: &'a mut [f32]) -> Result<Self, LengthError> {
        let memory = Workspace::new(&asset, memory)?;
        let tunables = Self::default_tunables(&asset);
        embed::rest(surface(&asset), memory.positions, memory.normals);
        memory.palette.fill(affine::to_rows(&affine::IDENTITY));
        let life = Life {
            phase: Phase::Settle,
            frozen: false,
            teleport: false,
            divisor: 1,
            turn: 0,
            pending: 0.0,
            gust_ticks: 0,
            root: Root::default(),
            tunables,
        };
        let spring = Spring { ks: 0.0, kd: 0.0 };
        let mut character = Self {
            asset,
            memory,
            life,
            springs: [spring; MAX_REGIONS],
            limits: [Limit { gain: 1.0, inverse_square: 1.0 }; MAX_REGIONS],
            steps: [Step::new(spring, 1.0, 0.0); MAX_REGIONS],
            steps_dt: 0.0,
            environment: 0,
        };
        character.apply_tunables();
        Ok(character)
    }

    /// The tunables with which an asset was baked.
    #[must_use]
    pub fn default_tunables(asset: &Asset<'_>) -> Tunables {
        let mut tunables = Tunables { gravity: [0.0, -asset.meta.gravity, 0.0], ..Tunables::default() };
        for (region, row) in tunables.regions.iter_mut().zip(asset.regions) {
            *region = Region::from_row(*row);
        }
        tunables.flushed()
    }

    /// The asset.
    #[must_use]
    pub fn asset(&self) -> &Asset<'a> {
        &self.asset
    }

    /// The tunables in force.
    #[must_use]
    pub fn tunables(&self) -> &Tunables {
        &self.life.tunables
    }

    /// Changes the tunables; the motion goes on.
    ///
    /// # Errors
    ///
    /// [`TunableError`] for a value out of its range; nothing changes then.
    pub fn set_tunables(&mut self, tunables: &Tunables) -> Result<(), TunableError> {
        tunables.validate()?;
        self.life.tunables = tunables.flushed();
        self.apply_tunables();
        Ok(())
    }

    pub(crate) fn apply_tunables(&mut self) {
        let t = &self.life.tunables;
        let size = self.asset.meta.body_size;
        for (i, region) in t.regions.iter().enumerate() {
            let frequency = float::min(region.frequency * t.frequency, 60.0);
            // A slower spring would sag beyond all bounds; without stiffness it is free.
            let frequency = if frequency < SLOWEST { 0.0 } else { frequency };
            let damping = flush(float::min(region.damping * t.damping, 100.0));
            self.springs[i] = Spring::new(frequency, damping);
            self.limits[i] = region.limit(size, t.gain);
        }
        self.steps_dt = 0.0;
    }

    /// Advances by `dt` seconds to `pose`.
    ///
    /// `dt ≤ 0` does nothing. Any `dt` costs the same; one beyond [`Tunables::settle_after`] settles the flesh.
    ///
    /// # Errors
    ///
    /// [`StepError`] for input that is not finite or does not fit the asset; nothing changes then.
    pub fn step(&mut self, pose: Pose<'_>, dt: f32) -> Result<Stepped, StepError> {
        self.check(&pose.root, dt)?;
        let (expected, found) = (self.asset.joint_from_bind.len(), pose.root_from_joint.len());
        if expected != found {
            return Err(StepError::JointCount(LengthError { expected, found }));
        }
        check_joints(pose.root_from_joint, self.asset.joint_from_bind)?;
        Ok(self.elapse(dt).map_or(Stepped::Held, |dt| {
            pose::palette(pose.root_from_joint, self.asset.joint_from_bind, self.memory.palette);
            self.advance(pose.root, dt)
        }))
    }

    /// Advances by `dt` seconds to the asset's clip `clip` at time `t`, s.
    ///
    /// # Errors
    ///
    /// As [`Self::step`]; [`StepError::NoSuchClip`] past the last clip.
    pub fn step_clip(&mut self, clip: u32, t: f32, root: Root, dt: f32) -> Result<Stepped, StepError> {
        let channels = self.asset.clip(clip as usize).ok_or(StepError::NoSuchClip(clip))?.channels;
        self.check(&root, dt)?;
        if !t.is_finite() {
            return Err(StepError::TimeNotFinite);
        }
        self.sample_and_advance(channels, t, root, dt)
    }

    fn sample_and_advance(
        &mut self,
        channels: Channels<'_>,
        t: f32,
        root: Root,
        dt: f32,
    ) -> Result<Stepped, StepError> {
        let (before, t) = ((self.life.pending, self.life.turn), flush(t));
        let Some(dt) = self.elapse(dt) else { return Ok(Stepped::Held) };
        let asset = &self.asset;
        let skeleton =
            Skeleton { parents: asset.parents, rest: asset.node_rest, joint_node: asset.joint_node };
        let m = &mut self.memory;
        pose::sample(skeleton, channels, t, m.joints, (m.local, m.model));
        if let Err(error) = check_joints(m.joints, asset.joint_from_bind) {
            (self.life.pending, self.life.turn) = before;
            return Err(error);
        }
        pose::palette(m.joints, asset.joint_from_bind, m.palette);
        Ok(self.advance(root, dt))
    }

    /// Advances by `dt` seconds in the rest pose of the asset's skeleton.
    ///
    /// # Errors
    ///
    /// As [`Self::step`].
    pub fn step_rest(&mut self, root: Root, dt: f32) -> Result<Stepped, StepError> {
        self.check(&root, dt)?;
        self.sample_and_advance(Channels::default(), 0.0, root, dt)
    }

    fn check(&mut self, root: &Root, dt: f32) -> Result<(), StepError> {
        self.environment = canary::float_environment();
        if self.environment & ROUNDING != 0 {
            return Err(StepError::FloatEnvironment(self.environment));
        }
        if !dt.is_finite() {
            return Err(StepError::TimeNotFinite);
        }
        if root.is_valid() { Ok(()) } else { Err(StepError::BadRoot) }
    }

    /// Lets `dt` seconds pass; the time to advance by, where a step is due.
    fn elapse(&mut self, dt: f32) -> Option<f32> {
        let dt = flush(dt);
        if dt <= 0.0 {
            return None;
        }
        let life = &mut self.life;
        life.pending = float::min(life.pending + dt, 1e9);
        life.turn = (life.turn + 1) % life.divisor.max(1);
        if life.frozen || life.turn != 0 || life.pending < SHORTEST_STEP {
            return None;
        }
        Some(core::mem::replace(&mut life.pending, 0.0))
    }

    /// The [`canary`] word of the thread that made the last step: 0 where floats behave as IEEE 754 begins.
    ///
    /// A host that flushes subnormals, as audio threads do, shows here (bits 3 to 5) and gets the same bits all the
    /// same. One that rounds another way gets [`StepError::FloatEnvironment`] instead of a step.
    #[must_use]
    pub fn float_environment(&self) -> u32 {
        self.environment
    }

    /// The stages, in order; the palette is set.
    fn advance(&mut self, root: Root, dt: f32) -> Stepped {
        let root = root.flushed();
        let forces = self.forces(&root, dt);
        let (asset, m) = (&self.asset, &mut self.memory);
        let out = Targets { positions: m.targets, accelerations: m.f, linear: m.linear };
        skin_stage::targets(m.palette, asset.influences, asset.rest, forces, out);
        self.follow(&root, dt);
        let (asset, m) = (&self.asset, &mut self.memory);
        let tissue = Tissue { softness: asset.softness, region: asset.region_of_point, limits: &self.limits };
        unskin::unskin(m.palette, asset.influences, m.linear, m.state.y, tissue, m.offsets);
        embed::embed(surface(asset), m.offsets, m.positions, m.normals);
        self.life.root = root;
        Stepped::Advanced
    }

    /// Gravity and wind in the root's frame, and gravity as authored in bind space; model units per s².
    fn forces(&mut self, root: &Root, dt: f32) -> ([f32; 3], [f32; 3]) {
        let (life, meta) = (&mut self.life, &self.asset.meta);
        let t = &life.tunables;
        #[allow(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "saturating, not negative"
        )]
        let ticks = (dt * t.gust_rate * 16_777_216.0) as u64;
        life.gust_ticks = life.gust_ticks.wrapping_add(ticks);
        let gusts = [0, 1, 2].map(|channel| t.gust * noise::value(life.gust_ticks, channel));
        let strength = float::sqrt(vec3::dot(t.wind, t.wind));
        let wind = [0, 1, 2].map(|i| t.wind[i] * (1.0 + gusts[0]) + strength * 0.5 * gusts[i]);
        let world = flush_all(vec3::scale(vec3::add(t.gravity, wind), meta.body_size));
        let [x, y, z] = root.from_world();
        let local = affine::rotate(&[x, y, z, [0.0; 3]], world);
        (local, vec3::scale(meta.bind_down, meta.gravity * meta.body_size))
    }

    /// The dynamics: carry, settle, start or advance.
    fn follow(&mut self, root: &Root, dt: f32) {
        let (life, m) = (&mut self.life, &mut self.memory);
        let size = self.asset.meta.body_size;
        let regions = self.asset.region_of_point;
        if life.phase == Phase::Settle || dt > life.tunables.settle_after {
            m.state.settle(m.targets, m.f, regions, &self.springs, REST * size);
            (life.phase, life.teleport) = (Phase::Fresh, false);
            return;
        }
        let limit = life.tunables.teleport * size;
        let teleport = core::mem::take(&mut life.teleport) || root.distance(&life.root) > limit;
        if !teleport && let Some(map) = Root::felt(&life.root, root, life.tunables.inertia) {
            m.state.carry(&map);
        }
        if teleport || m.state.jumped(m.targets, limit) {
            m.state.jump(m.targets);
        }
        if life.phase == Phase::Fresh {
            m.state.start(m.targets, dt);
            life.phase = Phase::Running;
        }
        if self.steps_dt.to_bits() != dt.to_bits() {
            let used = self.steps.iter_mut().zip(&self.springs).take(self.asset.regions.len());
            used.for_each(|(step, spring)| *step = Step::new(*spring, dt, REST * size));
            self.steps_dt = dt;
        }
        m.state.advance(&mut m.targets, &mut m.f, regions, &self.steps);
    }

    /// Positions of the render vertices, bind space: rest plus offsets. Skinning them shows the flesh.
    #[must_use]
    pub fn positions(&self) -> &[[f32; 3]] {
        self.memory.positions
    }

    /// Unit normals of the render vertices, bind space.
    #[must_use]
    pub fn normals(&self) -> &[[f32; 3]] {
        self.memory.normals
    }

    /// Offsets of the moving points from their targets, model space, before softness and limits.
    #[must_use]
    pub fn raw_offsets(&self) -> &[[f32; 3]] {
        self.memory.state.y
    }

    /// Offsets of the moving points, bind space, as shown.
    #[must_use]
    pub fn offsets(&self) -> &[[f32; 3]] {
        self.memory.offsets
    }

    /// Map of each joint in the last step, model from bind.
    #[must_use]
    pub fn palette(&self) -> &[Rows] {
        self.memory.palette
    }

    /// Skins the render vertices: positions and normals in the root's frame, with flesh or without.
    ///
    /// # Errors
    ///
    /// [`LengthError`] unless both buffers have one element a render vertex.
    pub fn skin_surface(
        &self,
        flesh: bool,
        positions: &mut [[f32; 3]],
        normals: &mut [[f32; 3]],
    ) -> Result<(), LengthError> {
        let (asset, m) = (&self.asset, &self.memory);
        let expected = m.positions.len();
        for found in [positions.len(), normals.len()] {
            if found != expected {
                return Err(LengthError { expected, found });
            }
        }
        if flesh {
            copy(m.positions, positions);
            copy(m.normals, normals);
        } else {
            embed::rest(surface(asset), positions, normals);
        }
        skin::skin_surface(m.palette, asset.influences, asset.point_of_vertex, positions, normals);
        Ok(())
    }

    /// Digests of what each stage made.
    #[must_use]
    pub fn digests(&self) -> Digests {
        Digests::of(&self.memory)
    }
}

/// The part of an asset that the render mesh needs.
pub(crate) fn surface<'a>(asset: &Asset<'a>) -> Surface<'a> {
    Surface {
        rest: asset.rest,
        normals: asset.normals,
        point_of_vertex: asset.point_of_vertex,
        moved: asset.moved,
        stencils: asset.stencils,
    }
}
