//! A dataset being made: samples on all threads, written in their order.
//!
//! ```text
//! indices of the shard that the file does not have ─▶ workers, each with its own flesh ─▶ in order ─▶ Writer
//! ```
//!
//! Every sample begins from rest and depends on nothing but its index, so that neither the number of threads, nor the
//! shard, nor what was there before changes a bit of it.

use super::sample::{self, Record};
use super::settle::Settled;
use super::{Settings, Simulation};
use crate::dataset::{Array, ArrayInfo, Header, Shard, Writer};
use crate::pose::Pose;
use crate::{Error, Model, cage};
use core::sync::atomic::{AtomicUsize, Ordering};
use serde_json::Value;
use std::collections::BTreeMap;
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};
use std::thread;

/// What the samples of a job are.
#[derive(Clone, Debug, PartialEq)]
pub enum Work {
    /// A pose each, root apart, in equilibrium.
    Equilibria(Vec<Pose>),
    /// A motion each, from an equilibrium in its first pose.
    Motions {
        /// Poses at even times.
        sequences: Vec<Vec<Pose>>,
        /// Poses a second.
        rate: f64,
        /// Steps from pose to pose.
        substeps: u32,
    },
}

impl Work {
    /// How many samples there are.
    #[must_use]
    pub fn len(&self) -> usize {
        match self {
            Self::Equilibria(poses) => poses.len(),
            Self::Motions { sequences, .. } => sequences.len(),
        }
    }

    /// Whether there are none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }
}

/// Samples to be made of a character.
#[derive(Debug)]
pub struct Job<'m> {
    /// The character.
    pub model: &'m Model,
    /// What it is made of.
    pub settings: Settings,
    /// Its cage.
    pub body: cage::Body,
    /// Poses or motions.
    pub work: Work,
    /// Whether deformation gradients are kept.
    pub gradients: bool,
}

/// What came of a run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Made {
    /// Samples that were made now.
    pub samples: usize,
    /// Of these, those in which a solve did not come to an end; their `status` says so.
    pub failed: usize,
}

impl<'m> Job<'m> {
    /// Of a character.
    ///
    /// # Errors
    ///
    /// Those of [`Simulation::new`].
    pub fn new(model: &'m Model, settings: Settings, work: Work, gradients: bool) -> Result<Self, Error> {
        let body = cage::Body::new(model, &settings.cage)?;
        Ok(Self { model, settings, body, work, gradients })
    }

    /// The flesh at rest.
    ///
    /// # Errors
    ///
    /// Those of [`Simulation::in_cage`].
    pub fn flesh(&self) -> Result<Simulation<'m>, Error> {
        Simulation::in_cage(self.model, self.body.clone(), &self.settings)
    }

    /// Header of its dataset; `source` says where its poses are from.
    ///
    /// # Errors
    ///
    /// As [`flesh`](Self::flesh).
    pub fn header(&self, seed: u64, shard: Shard, source: &Value) -> Result<Header, Error> {
        let mut setting = self.settings.to_json();
        setting["poses"] = source.clone();
        if let Work::Motions { rate, substeps, .. } = &self.work {
            setting["motion"] = serde_json::json!({ "rate": rate, "substeps": substeps });
        }
        Ok(Header {
            seed,
            samples: self.work.len() as u64,
            shard,
            character: sample::character(self.model),
            setting,
            arrays: self.arrays(&self.flesh()?),
        })
    }

    fn arrays(&self, flesh: &Simulation<'_>) -> Vec<ArrayInfo> {
        sample::arrays(flesh, self.gradients, matches!(self.work, Work::Motions { .. }))
    }

    /// Makes sample `index`.
    ///
    /// # Errors
    ///
    /// If there is not memory enough.
    ///
    /// # Panics
    ///
    /// If there are not so many.
    pub fn sample(&self, flesh: &mut Simulation<'_>, index: usize) -> Result<Record, Error> {
        let mut record = Record::new(self.gradients);
        flesh.reset();
        match &self.work {
            Work::Equilibria(poses) => {
                let settled = flesh.settle(&poses[index]);
                record.add(flesh, &settled);
            }
            Work::Motions { sequences, rate, substeps } => {
                let (poses, steps) = (&sequences[index], (*substeps).max(1));
                let settled = flesh.settle(&poses[0]);
                record.add(flesh, &settled);
                for pair in poses.windows(2) {
                    let mut settled = Settled::default();
                    for k in 1..=steps {
                        let t = f64::from(k) / f64::from(steps);
                        let pose = if k < steps { pair[0].interpolate(&pair[1], t) } else { pair[1].clone() };
                        let found = flesh.step(&pose, 1.0 / (rate * f64::from(steps)))?;
                        settled.iterations += found.steps.len();
                        settled.equilibrium = found;
                    }
                    record.add(flesh, &settled);
                }
            }
        }
        Ok(record)
    }

    /// Makes the samples that `writer` does not have on `threads` threads; `progress` is called after each with how many
    /// are written by now.
    ///
    /// # Errors
    ///
    /// [`Error::Write`], as on a full disk: what was written before is whole. As [`flesh`](Self::flesh).
    pub fn run(
        &self,
        writer: &mut Writer,
        header: &Header,
        threads: usize,
        mut progress: impl FnMut(usize),
    ) -> Result<Made, Error> {
        let wanted = header.shard.indices(header.samples).filter(|i| !writer.has(*i));
        let wanted: Vec<usize> = wanted.filter_map(|i| usize::try_from(i).ok()).collect();
        let next = AtomicUsize::new(0);
        // A worker that is ahead waits: what is not written yet is in memory.
        let (send, receive) = sync_channel(threads.max(1));
        thread::scope(|scope| {
            for _ in 0..threads.clamp(1, wanted.len().max(1)) {
                let (send, next, wanted) = (send.clone(), &next, &wanted);
                scope.spawn(move || self.work_on(wanted, next, &send));
            }
            drop(send);
            let made = collect(&wanted, header, writer, &receive, &mut progress);
            // Workers end when nobody listens.
            drop(receive);
            next.store(wanted.len(), Ordering::Relaxed);
            made
        })
    }

    /// Takes numbers of samples until there are none.
    fn work_on(&self, wanted: &[usize], next: &AtomicUsize, send: &SyncSender<Finished>) {
        // Its own pool of one thread: work within a sample is not shared out, samples are.
        let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build();
        let run = || {
            let mut flesh = self.flesh();
            loop {
                let k = next.fetch_add(1, Ordering::Relaxed);
                let Some(index) = wanted.get(k) else { return };
                let record = match &mut flesh {
                    Ok(flesh) => self.sample(flesh, *index),
                    Err(_) => self.flesh().map(|_| Record::new(self.gradients)),
                };
                let failed = record.is_err();
                if send.send((k, record)).is_err() || failed {
                    return;
                }
            }
        };
        match pool {
            Ok(pool) => pool.install(run),
            Err(_) => run(),
        }
    }
}

/// A place among the samples that are wanted, and what came of it.
type Finished = (usize, Result<Record, Error>);

/// Writes what comes, in order.
fn collect(
    wanted: &[usize],
    header: &Header,
    writer: &mut Writer,
    receive: &Receiver<Finished>,
    progress: &mut impl FnMut(usize),
) -> Result<Made, Error> {
    let (mut early, mut made) = (BTreeMap::new(), Made::default());
    while made.samples < wanted.len() {
        let Ok((k, record)) = receive.recv() else { break };
        early.insert(k, record?);
        while let Some(record) = early.remove(&made.samples) {
            let named = header.arrays.iter().zip(&record.arrays);
            let arrays: Vec<Array<'_>> = named.map(|(a, values)| Array { name: &a.name, values }).collect();
            writer.append(wanted[made.samples] as u64, &arrays)?;
            made.samples += 1;
            made.failed += usize::from(record.failed > 0);
            progress(made.samples);
        }
    }
    writer.sync()?;
    Ok(made)
}
