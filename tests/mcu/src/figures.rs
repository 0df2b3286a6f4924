//! One kernel after the other between two [`mark`]s, on the tube's data: what each costs.

use core::hint::black_box;

use sinew::kernel::skin::{self, BLOCK, LinearBlock, Rows};
use sinew::kernel::spring::{self, Knots, Spring, Step};
use sinew::kernel::unskin::{self, Limit, Tissue};
use sinew::math::activation::{gelu, tanh};
use sinew::math::affine::{self, IDENTITY};
use sinew::stage::embed::{self, Surface};
use sinew::stage::skin::{self as skin_stage, Targets};
use sinew::{Asset, Character};

use crate::{NETWORK, STEP, detail, mark, network, required_len, root, take, time};

/// Joints of the tube.
const JOINTS: usize = 3;

/// Says what comes between the next two marks, and by how many elements to divide.
pub type Say<'a> = &'a mut dyn FnMut(&str, usize);

/// Runs everything once; `None` for an asset that is refused or does not fit.
pub fn run(bytes: &[u8], memory: &mut [f32], say: Say<'_>) -> Option<()> {
    let asset = Asset::parse(bytes).ok()?;
    let memory = memory.get_mut(..required_len(&asset))?;
    memory.fill(0.0);
    let palette = frames(asset, &mut *memory, &mut *say)?;
    kernels(&asset, &palette, &mut *memory, &mut *say)?;
    functions(&palette, say);
    // What nobody reads would not be computed.
    black_box(memory);
    Some(())
}

/// What runs between two marks.
fn count(say: Say<'_>, name: &str, elements: usize, work: impl FnOnce()) {
    say(name, elements);
    mark();
    work();
    mark();
}

/// The same between two calls of [`detail`].
fn list(say: Say<'_>, name: &str, elements: usize, work: impl FnOnce()) {
    say(name, elements);
    detail();
    work();
    detail();
}

/// Whole frames of a running character, with equal time steps and with another one; returns the last palette.
fn frames(asset: Asset<'_>, memory: &mut [f32], say: Say<'_>) -> Option<[Rows; JOINTS]> {
    let own = memory.get_mut(..Character::required_len(&asset))?;
    let mut character = Character::new(asset, own).ok()?;
    let mut step = |frame, dt| {
        black_box(character.step_clip(0, time(frame), root(frame), dt)).ok();
    };
    (0..8).for_each(|frame| step(frame, STEP));
    list(say, "step, same time", 1, || step(8, STEP));
    list(say, "step, other time", 1, || step(9, 0.75 * STEP));
    let mut palette = [affine::to_rows(&IDENTITY); JOINTS];
    for (to, from) in palette.iter_mut().zip(character.palette()) {
        *to = *from;
    }
    Some(palette)
}

/// Every kernel that runs once a point or vertex.
fn kernels(asset: &Asset<'_>, palette: &[Rows], mut memory: &mut [f32], say: Say<'_>) -> Option<()> {
    let [active, vertices] = [asset.meta.active, asset.meta.vertices].map(|n| n as usize);
    let rest = asset.rest.get(..active)?;
    let linear = blocks(take(&mut memory, active.div_ceil(BLOCK) * 9)?);
    let mut vectors = |n| take::<3>(&mut memory, n);
    let (targets, f, y, offsets) = (vectors(active)?, vectors(active)?, vectors(active)?, vectors(active)?);
    let (x, v, slope, f0) = (vectors(active)?, vectors(active)?, vectors(active)?, vectors(active)?);
    let (positions, normals) = (vectors(vertices)?, vectors(vertices)?);
    let forces = ([0.0, -9.0, 0.0], [0.0, -9.0, 0.0]);
    count(say, "skin: targets", active, || {
        let out = Targets { positions: targets, accelerations: f, linear };
        skin_stage::targets(palette, asset.influences, rest, forces, out);
    });
    let step = Step::new(Spring::new(3.0, 0.3), STEP, 0.0);
    count(say, "springs", active, || {
        let [y, v, slope] = [&mut *y, v, slope].map(|a| a.as_flattened_mut());
        let (x, f) = ([&*x, &*targets].map(<[_]>::as_flattened), [&*f0, &*f].map(<[_]>::as_flattened));
        spring::advance(&step, Knots { x, f, y, v, slope });
    });
    let limits = [Limit { gain: 1.0, inverse_square: 1.0 }; sinew::asset::layout::MAX_REGIONS];
    let tissue = Tissue { softness: asset.softness, region: asset.region_of_point, limits: &limits };
    count(say, "offsets to bind space", active, || {
        unskin::unskin(palette, asset.influences, linear, y, tissue, offsets);
    });
    let surface = Surface {
        rest: asset.rest,
        normals: asset.normals,
        point_of_vertex: asset.point_of_vertex,
        moved: asset.moved,
        stencils: asset.stencils,
    };
    embed::rest(surface, positions, normals);
    count(say, "positions and normals", asset.moved.len(), || {
        embed::embed(surface, offsets, positions, normals);
    });
    count(say, "skin: vertices and normals", vertices, || {
        skin::skin_surface(palette, asset.influences, asset.point_of_vertex, positions, normals);
    });
    Some(())
}

/// Blocks of linear parts over rows of lanes.
fn blocks(rows: &mut [[f32; BLOCK]]) -> &mut [LinearBlock] {
    rows.as_chunks_mut::<3>().0.as_chunks_mut::<3>().0
}

/// What runs once a frame or less.
fn functions(palette: &[Rows], say: Say<'_>) {
    let x = network::inputs(palette);
    count(say, "network", 1, || {
        black_box(NETWORK.forward(black_box(&x)));
    });
    count(say, "weights of a spring", 1, || {
        let spring = black_box(Spring { ks: 400.0, kd: 12.0 });
        black_box(Step::new(spring, black_box(STEP), 1e-7));
    });
    // Over a wave: they take longer near a middle of two floats.
    for (name, function) in [("tanh", tanh as fn(f32) -> f32), ("gelu", gelu)] {
        count(say, name, 64, || {
            for i in 0..64_u8 {
                black_box(function(f32::from(i) * 0.0625 - 2.0));
            }
        });
    }
}
