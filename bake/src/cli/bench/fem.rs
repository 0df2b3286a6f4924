//! Finite elements: equilibria and steps of a character, assembly and linear solves against their textbook versions, and
//! a body of layered prisms as large as the paper's.

use super::load;
use core::hint::black_box;
use faer::linalg::solvers::Solve;
use faer::sparse::{SparseColMat, Triplet};
use faer::{Mat, Par, Side};
use glam::{DMat4, DVec3};
use serde_json::{Value, json};
use sinew_bake::cage::layers::{Layers, Settings as Layering};
use sinew_bake::cage::{Options, Resolution};
use sinew_bake::fem::assembly::{Assembly, Free};
use sinew_bake::fem::cholesky::Cholesky;
use sinew_bake::fem::element::Elements;
use sinew_bake::fem::energy::{Energy, neo_hookean::NeoHookean};
use sinew_bake::fem::material::Lame;
use sinew_bake::fem::newton::{Newton, Tolerance};
use sinew_bake::fem::potential::{Potential, solid::Solid};
use sinew_bake::fem::solver::{Method, Solver};
use sinew_bake::fem::stiffness::{FIXED, Stiffness};
use sinew_bake::fem::svd::Svd;
use sinew_bake::pose::Pose;
use sinew_bake::simulate::{Settings, Simulation};
use sinew_bake::{Error, Model};
use std::path::Path;
use std::time::Instant;

/// Nodes of a cage of the built-in character with five thousand tetrahedra.
const NODES: usize = 1_320;
/// Poses that are settled, and steps that are taken.
const COUNT: u8 = 12;
/// Time between poses, s.
const FRAME: f32 = 1.0 / 30.0;
/// Rounds of what is short.
const ROUNDS: u32 = 8;

/// Runs `f` on one thread.
fn alone<T: Send>(f: impl FnOnce() -> T + Send) -> T {
    match rayon::ThreadPoolBuilder::new().num_threads(1).build() {
        Ok(pool) => pool.install(f),
        Err(_) => f(),
    }
}

fn settings() -> Settings {
    Settings {
        cage: Options { resolution: Resolution::Vertices(NODES), ..Options::default() },
        ..Settings::default()
    }
}

/// An equilibrium after another, and a step of motion after another, on one core.
pub(super) fn character(model: &Model, wanted: &(impl Fn(&str) -> bool + Sync)) -> Result<Vec<Value>, Error> {
    alone(|| {
        let mut flesh = Simulation::new(model, &settings())?;
        let case = format!("{} tets", flesh.body.cage.tets.len());
        let clip = model.clips.first();
        let pose =
            |k: u8| clip.map_or_else(|| Pose::rest(model), |c| Pose::of_clip(model, c, FRAME * f32::from(k)));
        let mut results = Vec::new();
        if wanted("fem-quasistatic") {
            flesh.settle(&pose(0));
            let start = Instant::now();
            let iterations: usize = (1..=COUNT).map(|k| flesh.settle(&pose(k)).iterations).sum();
            let seconds = start.elapsed().as_secs_f64() / f64::from(COUNT);
            results.push(
                json!({"name": "fem-quasistatic", "case": case, "value": seconds, "unit": "s", "limit": 0.5,
                "iterations": iterations, "poses": COUNT}),
            );
        }
        if wanted("fem-dynamic") {
            flesh.reset();
            flesh.settle(&pose(0));
            flesh.step(&pose(0), f64::from(FRAME))?;
            let start = Instant::now();
            for k in 1..=COUNT {
                flesh.step(&pose(k), f64::from(FRAME))?;
            }
            let seconds = start.elapsed().as_secs_f64() / f64::from(COUNT);
            results.push(
                json!({"name": "fem-dynamic", "case": case, "value": seconds, "unit": "s", "limit": 0.15}),
            );
        }
        if wanted("fem-assembly") || wanted("fem-linear") {
            flesh.settle(&pose(COUNT));
            results.extend(matrix(&flesh, &case, wanted)?);
        }
        Ok(results)
    })
}

/// Least time of a round, s.
fn best(mut round: impl FnMut()) -> f64 {
    let mut least = f64::INFINITY;
    for _ in 0..ROUNDS {
        let start = Instant::now();
        round();
        least = least.min(start.elapsed().as_secs_f64());
    }
    least
}

/// The stiffness matrix of a character in a pose, and what is solved with it.
fn matrix(
    flesh: &Simulation<'_>,
    case: &str,
    wanted: &(impl Fn(&str) -> bool + Sync),
) -> Result<Vec<Value>, Error> {
    let refused = |e: String| Error::unusable("bench", "matrix", e, "report this");
    let (cage, x) = (&flesh.body.cage, flesh.nodes());
    let free = Free::new(cage.rest.len(), &flesh.body.binding.fixed);
    let lame = Lame::new(15_000.0, 0.45).map_err(|e| refused(e.to_string()))?;
    let moving =
        cage.tets.iter().filter(|t| t.iter().any(|i| free.row[*i as usize] != FIXED)).copied().collect();
    let elements = Elements::tets(&cage.rest, moving).map_err(|e| refused(e.to_string()))?;
    let solid = Solid::new(elements, NeoHookean::new(lame));
    let mut stiffness = free.stiffness(&[&solid]);
    let mut results = Vec::new();
    let ours = best(|| solid.hessian(x, true, &mut Assembly::new(&free, &mut stiffness)));
    let plain = best(|| drop(black_box(dense(&solid, &free, x))));
    if wanted("fem-assembly") {
        results.push(json!({"name": "fem-assembly", "case": case, "value": 1e3 * ours, "unit": "ms",
            "peers": [{"name": "dense loops and triplets", "value": 1e3 * plain}]}));
    }
    if wanted("fem-linear") {
        let right: Vec<DVec3> = free.node.iter().map(|i| cage.rest[*i as usize]).collect();
        let mut factor = Cholesky::new(&stiffness, Par::Seq).map_err(|e| refused(e.to_string()))?;
        let ours = best(|| {
            let mut d = right.clone();
            if factor.factorize(&stiffness).is_ok() {
                factor.solve(&mut d);
            }
            black_box(d);
        });
        let mut grids = Solver::new(&stiffness, Method::Multigrid).map_err(|e| refused(e.to_string()))?;
        let cycles = best(|| black_box(grids.solve(&stiffness, &mut right.clone())).unwrap_or_default());
        let matrix = scalars(&stiffness).map_err(|e| refused(format!("{e:?}")))?;
        let column = Mat::from_fn(3 * right.len(), 1, |r, _| right[r / 3][r % 3]);
        let peer = best(|| drop(black_box(matrix.sp_cholesky(Side::Lower).map(|llt| llt.solve(&column)))));
        results.push(json!({"name": "fem-linear", "case": case, "value": 1e3 * ours, "unit": "ms",
            "peers": [{"name": "faer alone", "value": 1e3 * peer},
                {"name": "core's CG with multigrid", "value": 1e3 * cycles}]}));
    }
    Ok(results)
}

/// As textbooks have it: `Bᵀ H B` of each element by loops over dense matrices, then triplets.
fn dense(solid: &Solid<4, NeoHookean>, free: &Free, x: &[DVec3]) -> Option<SparseColMat<usize, f64>> {
    let mut entries = Vec::new();
    for (e, nodes) in solid.elements.nodes.iter().enumerate() {
        let h = solid.material.hessian(&Svd::new(&solid.elements.deformation(e, x)), true);
        let mut b = [[0.0; 12]; 9];
        for (i, g) in solid.elements.gradients[e].iter().enumerate() {
            for c in 0..3 {
                for r in 0..3 {
                    b[3 * c + r][3 * i + r] = g[c];
                }
            }
        }
        for p in 0..12 {
            for q in 0..12 {
                let [row, column] = [p, q].map(|p| free.row[nodes[p / 3] as usize]);
                if row == FIXED || column == FIXED {
                    continue;
                }
                let mut sum = 0.0;
                for i in 0..9 {
                    for j in 0..9 {
                        sum += b[i][p] * h[i][j] * b[j][q];
                    }
                }
                let [row, column] = [3 * row as usize + p % 3, 3 * column as usize + q % 3];
                if row >= column {
                    entries.push(Triplet::new(row, column, solid.elements.volumes[e] * sum));
                }
            }
        }
    }
    let n = 3 * free.node.len();
    SparseColMat::try_new_from_triplets(n, n, &entries).ok()
}

/// The lower triangle by numbers.
fn scalars(k: &Stiffness) -> Result<SparseColMat<usize, f64>, faer::sparse::CreationError> {
    let mut entries = Vec::new();
    k.each(|row, column, block| {
        for c in 0..3 {
            for r in 0..3 {
                let [row, column] = [3 * row as usize + r, 3 * column as usize + c];
                if row >= column {
                    entries.push(Triplet::new(row, column, block.col(c)[r]));
                }
            }
        }
    });
    SparseColMat::try_new_from_triplets(3 * k.len(), 3 * k.len(), &entries)
}

/// One equilibrium of layered prisms from the start that skinning gives, on all cores.
pub(super) fn prisms(input: Option<&Path>) -> Result<Value, Error> {
    let model = load::character(input.unwrap_or_else(|| Path::new("builtin")))?;
    let refused = |e: String| Error::unusable(&model.name, "layers", e, "choose another character");
    let layers = Layers::new(&model, &Layering::everywhere()).map_err(|e| refused(e.to_string()))?;
    let elements =
        Elements::prisms(&layers.rest, layers.prisms.clone()).map_err(|e| refused(e.to_string()))?;
    let lame = Lame::new(15_000.0, 0.45).map_err(|e| refused(e.to_string()))?;
    let case = format!("{} prisms", elements.len());
    let solid = Solid::new(elements, NeoHookean::new(lame));
    let mut held: Vec<bool> = vec![true; layers.rest.len()];
    layers.prisms.iter().flatten().for_each(|i| held[*i as usize] = layers.fixed[*i as usize]);
    let fixed: Vec<u32> = (0..).zip(&held).filter(|(_, held)| **held).map(|(i, _)| i).collect();
    let free = Free::new(layers.rest.len(), &fixed);
    let count = free.node.len();
    let pose = model.clips.first().map(|c| Pose::of_clip(&model, c, 0.5 * c.duration));
    let pose = pose.unwrap_or_else(|| Pose::rest(&model)).split_root(&model).1;
    let mut x = skinned(&model, &layers, &pose);
    let start = Instant::now();
    let mut newton = Newton::new(free, &[&solid], Method::DIRECT).map_err(|e| refused(e.to_string()))?;
    let found = newton.minimize(&[&solid], &mut x, Tolerance { step: 1e-5, iterations: 60 });
    let seconds = start.elapsed().as_secs_f64();
    Ok(json!({"name": "fem-prisms", "case": case, "value": seconds, "unit": "s", "limit": 6.0, "free": count,
        "iterations": found.steps.len(), "converged": found.converged, "inverted": found.inverted,
        "memory_gib": memory()}))
}

/// Where skinning puts the nodes of layers.
fn skinned(model: &Model, layers: &Layers, pose: &Pose) -> Vec<DVec3> {
    let rest = model.rest_transforms();
    let moved: Vec<DMat4> =
        pose.transforms(model).iter().zip(&rest).map(|(now, rest)| *now * rest.inverse()).collect();
    let place = |(x, row): (&DVec3, &Vec<(usize, f64)>)| {
        let blend = row.iter().fold(DMat4::ZERO, |sum, (n, w)| sum + moved[*n] * *w);
        if row.is_empty() { *x } else { blend.transform_point3(*x) }
    };
    // The layers one after the other, with the columns in the same order.
    layers.rest.iter().zip(layers.weights.iter().cycle()).map(place).collect()
}

/// The most memory that this process had, GiB, where the system tells.
fn memory() -> Option<f64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find(|l| l.starts_with("VmHWM"))?;
    let kib: f64 = line.split_whitespace().nth(1)?.parse().ok()?;
    Some(kib / 1_048_576.0)
}
