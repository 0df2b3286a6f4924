//! `sinew simulate`.

use crate::support::{Folder, SINEW};
use core::time::Duration;
use std::fs;
use std::process::{Command, Stdio};
use std::thread;
use std::time::Instant;

/// A small job.
const JOB: &str = "simulate builtin --vertices 300 --samples 12 -o plum.set";

#[test]
fn a_dataset_is_written_with_pictures_and_gone_on_with() {
    let folder = Folder::new("simulate");
    let json = folder.good(&format!("{JOB} --preview plum.gif --json")).json();
    assert_eq!(
        (json["made"].as_u64(), json["kept"].as_u64(), json["failed"].as_u64()),
        (Some(12), Some(0), Some(0))
    );
    assert_eq!(folder.names(), ["plum.gif", "plum.png", "plum.set"]);
    assert!(
        folder.read("plum.gif").starts_with(b"GIF89a") && folder.read("plum.png").starts_with(b"\x89PNG")
    );
    let whole = folder.read("plum.set");
    let json = folder.good(&format!("{JOB} --json")).json();
    assert_eq!((json["made"].as_u64(), json["kept"].as_u64()), (Some(0), Some(12)), "nothing is left to do");
    assert_eq!(folder.read("plum.set"), whole, "and nothing is done");
}

#[test]
fn a_run_that_is_killed_loses_the_samples_in_work_alone() {
    let folder = Folder::new("killed");
    let whole = {
        let other = Folder::new("not-killed");
        other.good(JOB);
        other.read("plum.set")
    };
    let mut child = Command::new(SINEW)
        .args(JOB.split(' '))
        .current_dir(folder.path())
        .stdout(Stdio::null())
        .spawn()
        .expect("the program starts");
    // Until some samples are there; a machine that is faster than the looking finds all of them.
    let (file, begun) = (folder.path().join("plum.set"), Instant::now());
    while fs::metadata(&file).map_or(0, |m| m.len()) < whole.len() as u64 / 3 {
        assert!(begun.elapsed() < Duration::from_mins(2), "nothing is written");
        thread::sleep(Duration::from_millis(1));
    }
    child.kill().expect("it runs");
    child.wait().expect("it ended");
    let json = folder.good(&format!("{JOB} --json")).json();
    let [kept, made] = ["kept", "made"].map(|k| json[k].as_u64().expect("a count"));
    assert!(kept >= 2 && kept + made == 12, "{kept} and {made}");
    assert_eq!(folder.read("plum.set"), whole, "the same bytes as without an interruption");
}

#[test]
fn shards_go_to_files_of_their_own() {
    let folder = Folder::new("shards");
    for shard in ["0/2", "1/2"] {
        let json = folder.good(&format!("{JOB} --no-gradients --shard {shard} --json")).json();
        assert_eq!(json["made"].as_u64(), Some(6), "half of them");
    }
    assert_eq!(folder.names(), ["plum.0-of-2.set", "plum.1-of-2.set"]);
}

#[test]
fn motion_is_simulated_frame_by_frame() {
    let folder = Folder::new("motion");
    let json = folder
        .good("simulate builtin --vertices 200 --motion --rate 20 --frames 20 --substeps 1 -o m.set --preview m.gif --json")
        .json();
    assert!(json["made"].as_u64() > Some(1) && json["failed"].as_u64() == Some(0), "{json}");
    assert_eq!(folder.names(), ["m.gif", "m.png", "m.set"]);
}

#[test]
fn what_cannot_be_simulated_is_refused_in_a_line() {
    let folder = Folder::new("simulate-refused");
    let refused = |arguments: &str, parts: &[&str]| {
        folder.line(&format!("simulate builtin -o plum.set --vertices 200 {arguments}")).refused(parts);
    };
    refused("--ratio 0.5", &["material", "Poisson", "0.499"]);
    refused("--young 0", &["material", "modulus"]);
    refused("--young NaN", &["material"]);
    refused("--gravity inf", &["gravity", "finite"]);
    refused("--bvh missing.bvh", &["missing.bvh", "cannot be read"]);
    folder.write("not.bvh", b"HIERARCHY\nROOT a\n{");
    refused("--bvh not.bvh", &["not.bvh", "line 3"]);
    refused("--rate 0", &["rate"]);
    refused("--motion --rate 1e9", &["poses a second"]);
    let ran = folder.line("simulate builtin -o plum.set --shard 2/2");
    assert!(ran.code == Some(2) && ran.err.contains("i/n"), "{ran:?}");
    folder.write("plum.set", b"something else");
    refused("--samples 2", &["plum.set", "no dataset"]);
    assert_eq!(folder.names(), ["not.bvh", "plum.set"], "and nothing is left behind");
    assert_eq!(folder.read("plum.set"), b"something else");
}

#[test]
fn the_manuals_reader_reads() {
    let folder = Folder::new("numpy");
    if !Command::new("python3")
        .args(["-c", "import numpy"])
        .stderr(Stdio::null())
        .status()
        .is_ok_and(|s| s.success())
    {
        eprintln!("skipped: no python3 with numpy");
        return;
    }
    folder.good("simulate builtin --vertices 200 --samples 3 --no-gradients -o e.set");
    folder.good("simulate builtin --vertices 200 --motion --rate 20 --frames 20 --substeps 1 -o m.set");
    let manual = include_str!("../../../docs/dataset.md");
    let code = manual.split("```python\n").nth(1).and_then(|c| c.split("```").next()).expect("a listing");
    let check = "
header, samples = read('e.set')
assert sorted(samples) == [0, 1, 2] and all(s['status'][0] == 1 for s in samples.values())
assert all(abs((s['rotations'] ** 2).sum(1) - 1).max() < 1e-6 for s in samples.values())
header, samples = read('m.set')
assert samples[0]['skin'].shape[0] == samples[0]['status'].shape[0] == 20
assert len(samples) == header['samples']
";
    folder.write("read.py", format!("{code}{check}"));
    let ran = Command::new("python3").arg("read.py").current_dir(folder.path()).output().expect("it starts");
    assert!(ran.status.success(), "{}", String::from_utf8_lossy(&ran.stderr));
}
