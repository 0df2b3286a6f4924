//! Full disks and places that cannot be written: an error, no half file, nothing left over, old files untouched.

#![cfg(unix)]

use crate::support::{Folder, Ran, SINEW, finish};
use std::process::Command;

/// Runs `sinew` where no file may grow beyond `blocks` of 512 bytes (or 1024, by the shell); the signal that tells of
/// it is ignored, so that writing fails as on a full disk.
fn limited(folder: &Folder, blocks: u32, arguments: &str) -> Ran {
    let script = format!("trap '' XFSZ; ulimit -f {blocks}; exec \"$0\" {arguments}");
    finish(Command::new("sh").args(["-c", &script, SINEW]).current_dir(folder.path()))
}

#[test]
fn whatever_is_played_to_a_full_disk_leaves_nothing_half_written() {
    let folder = Folder::new("full");
    if !folder.fox() {
        return;
    }
    for ending in ["gif", "png", "glb", "npy", "replay", "json"] {
        let name = format!("out.{ending}");
        let line = format!("play fox.glb --clip Run --seconds 1 --height 128 -o {name}");
        limited(&folder, 1, &line).refused(&[&name, "cannot be written"]);
        assert_eq!(folder.names(), ["fox.glb"], "{ending}: nothing is left");
        folder.write(&name, "old");
        limited(&folder, 1, &line).refused(&[&name]);
        assert_eq!(folder.read(&name), b"old", "{ending}: the old file is untouched");
        std::fs::remove_file(folder.path().join(&name)).expect("it is there");
    }
}

#[test]
fn a_bake_to_a_full_disk_leaves_nothing_half_written() {
    let folder = Folder::new("full-bake");
    if !folder.fox() {
        return;
    }
    limited(&folder, 1, "bake fox.glb -o fox.sinew").refused(&["fox.sinew: cannot be written"]);
    assert_eq!(folder.names(), ["fox.glb"]);
    // Room for the asset and its knobs, not for the page.
    let ran = limited(&folder, 600, "bake fox.glb -o fox.sinew --report page");
    ran.refused(&["page/index.html: cannot be written"]);
    assert_eq!(folder.names(), ["fox.glb", "fox.sinew", "fox.sinew.json", "page"]);
    assert_eq!(std::fs::read_dir(folder.path().join("page")).expect("a folder").count(), 0, "no half page");
    folder.good("inspect fox.sinew");
}

#[test]
fn places_that_are_no_place_for_a_file_are_named() {
    let folder = Folder::new("places");
    folder.write("file", "x");
    std::fs::create_dir(folder.path().join("folder.json")).expect("a writable folder");
    folder.line("bake builtin -o missing/a.sinew").refused(&["missing/a.sinew: cannot be written"]);
    folder.line("play builtin --seconds 0.1 -o missing/a.npy").refused(&["missing/a.npy: cannot be written"]);
    folder.line("play builtin --seconds 0.1 -o folder.json").refused(&["folder.json: cannot be written"]);
    let ran = folder.line("bake builtin -o a.sinew --report file");
    ran.refused(&["file: cannot be written"]);
    if std::path::Path::new("/dev/full").exists() {
        folder.line("bake builtin -o /dev/full").refused(&["/dev/full: cannot be written"]);
    }
}

#[test]
fn a_link_stays_a_link() {
    let folder = Folder::new("link");
    folder.write("real.json", "old");
    std::os::unix::fs::symlink("real.json", folder.path().join("link.json")).expect("a link");
    folder.good("play builtin --seconds 0.1 -o link.json");
    assert!(folder.path().join("link.json").is_symlink(), "the link remains");
    assert!(folder.read("real.json").starts_with(b"{"), "its target is new");
}
