//! Datasets: the same bytes whoever makes them.

use crate::{plum, walking};
use sinew_bake::Model;
use sinew_bake::dataset::{Header, Reader, Shard, Writer, merge};
use sinew_bake::pose::Pose;
use sinew_bake::simulate::job::{Job, Work};
use sinew_bake::simulate::{Settings, sample};
use std::fs;
use std::path::PathBuf;

/// A file of this test in a folder of its own; removed at the end.
struct Scratch(PathBuf);

impl Scratch {
    fn new(name: &str) -> Self {
        let folder = std::env::temp_dir().join(format!("sinew-job-{name}-{}", std::process::id()));
        fs::create_dir_all(&folder).unwrap();
        Self(folder)
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.join(name)
    }
}

impl Drop for Scratch {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

/// Five poses, or three motions of four frames.
fn job(model: &Model, motion: bool) -> Job<'_> {
    let poses: Vec<Pose> =
        (0..5_u8).map(|k| walking(model, 0.17 * f32::from(k)).split_root(model).1).collect();
    let work = if motion {
        let sequence =
            |k: u8| (0..4_u8).map(|i| walking(model, 0.1 * f32::from(k) + 0.02 * f32::from(i))).collect();
        Work::Motions { sequences: (0..3).map(sequence).collect(), rate: 50.0, substeps: 2 }
    } else {
        Work::Equilibria(poses)
    };
    Job::new(model, Settings::draft(), work, true).unwrap()
}

fn header(job: &Job<'_>, shard: Shard) -> Header {
    job.header(7, shard, &serde_json::json!("a test")).unwrap()
}

fn made(job: &Job<'_>, path: &PathBuf, shard: Shard, threads: usize) -> Vec<u8> {
    let header = header(job, shard);
    let mut writer = Writer::open(path, &header).unwrap();
    let made = job.run(&mut writer, &header, threads, |_| ()).unwrap();
    assert_eq!(made.failed, 0, "all settle");
    drop(writer);
    fs::read(path).unwrap()
}

#[test]
fn neither_threads_nor_shards_nor_interruptions_change_a_bit() {
    let (model, scratch) = (plum(), Scratch::new("bits"));
    for motion in [false, true] {
        let job = job(&model, motion);
        let name = |what: &str| scratch.path(&format!("{what}-{motion}"));
        let whole = made(&job, &name("one"), Shard::WHOLE, 1);
        assert_eq!(made(&job, &name("three"), Shard::WHOLE, 3), whole, "threads");
        // Cut in the middle of a sample.
        fs::write(name("cut"), &whole[..whole.len() * 2 / 3]).unwrap();
        assert_eq!(made(&job, &name("cut"), Shard::WHOLE, 2), whole, "an interruption");
        let shards: Vec<PathBuf> = ["0/2", "1/2"]
            .into_iter()
            .map(|s| {
                let path = name(&s.replace('/', "-"));
                made(&job, &path, s.parse().unwrap(), 1);
                path
            })
            .collect();
        let mut reader = Reader::open(&shards).unwrap();
        assert!(reader.missing().is_empty());
        merge(&mut reader, &name("merged")).unwrap();
        assert_eq!(fs::read(name("merged")).unwrap(), whole, "shards");
    }
}

#[test]
fn a_sample_holds_what_the_flesh_was() {
    let (model, scratch) = (plum(), Scratch::new("holds"));
    let job = job(&model, false);
    let path = scratch.path("set");
    made(&job, &path, Shard::WHOLE, 2);
    let mut reader = Reader::open(&[&path]).unwrap();
    let names: Vec<String> = reader.header().arrays.iter().map(|a| a.name.clone()).collect();
    assert_eq!(names, ["rotations", "translations", "skin", "nodes", "energies", "status", "gradients"]);
    assert_eq!(reader.header().character, sample::character(&model));
    let mut flesh = job.flesh().unwrap();
    let Work::Equilibria(poses) = &job.work else { panic!("poses") };
    let found = flesh.settle(&poses[3]);
    let sample = reader.sample(3).unwrap();
    let close = |k: usize, all: Vec<f64>| {
        assert_eq!(sample.arrays[k].len(), all.len(), "{}", names[k]);
        for (a, b) in sample.arrays[k].iter().zip(all) {
            assert!((f64::from(*a) - b).abs() <= 1e-6 * b.abs().max(1.0), "{}: {a} {b}", names[k]);
        }
    };
    close(0, poses[3].rotations.iter().flat_map(|q| q.to_array()).collect());
    close(2, sample::offsets(&flesh).iter().flat_map(|d| d.to_array()).collect());
    close(3, flesh.nodes().iter().flat_map(|x| x.to_array()).collect());
    close(4, flesh.energies().to_vec());
    close(5, vec![1.0, found.equilibrium.inverted as f64, found.iterations as f64]);
    close(6, flesh.deformations().iter().flat_map(|f| f.to_cols_array()).collect());
    // Offsets bring skinning to the flesh.
    for ((m, p), (d, x)) in flesh
        .skinning()
        .iter()
        .zip(&flesh.body.surface.points)
        .zip(sample::offsets(&flesh).iter().zip(flesh.skin()))
    {
        assert!(m.transform_point3(*p + *d).distance(x) < 1e-9);
    }
}

#[test]
fn another_character_is_another_dataset() {
    let model = plum();
    let mut other = plum();
    other.primitives[0].positions[5][1] += 1e-4;
    assert_ne!(sample::character(&model), sample::character(&other));
    let scratch = Scratch::new("other");
    let path = scratch.path("set");
    made(&job(&model, false), &path, Shard::WHOLE, 1);
    let other = job(&other, false);
    let error =
        Writer::open(&path, &header(&other, Shard::WHOLE)).err().map(|e| e.to_string()).unwrap_or_default();
    assert!(error.contains("character"), "{error}");
}
