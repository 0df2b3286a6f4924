//! What cannot be used is refused in one line that names file, place and remedy; a check that fails is told from it.

use crate::support::{Folder, SINEW, finish};
use std::process::{Command, Stdio};

#[test]
fn files_that_cannot_be_used_are_named() {
    let folder = Folder::new("files");
    folder.line("inspect missing.glb").refused(&["missing.glb: cannot be read"]);
    folder.line("bake missing.glb -o a.sinew").refused(&["missing.glb: cannot be read"]);
    folder.write("text.glb", "this is no model");
    folder.line("bake text.glb -o a.sinew").refused(&["text.glb: "]);
    folder.write("text.sinew", "SINWgarbage");
    folder.line("inspect text.sinew").refused(&["text.sinew: asset: ", "; bake the character again"]);
    folder.write("text.replay", "SNRPgarbage");
    folder.line("verify text.replay").refused(&["text.replay: replay: ", "; record it again"]);
    assert!(!folder.names().contains(&"a.sinew".to_owned()), "nothing is written for them");
    if folder.fox() {
        let whole = folder.read("fox.glb");
        folder.write("cut.glb", &whole[..3000]);
        folder.line("bake cut.glb -o a.sinew").refused(&["cut.glb: ", "cut off", "; "]);
    }
}

#[test]
fn arguments_that_cannot_be_used_are_named_with_what_can() {
    let folder = Folder::new("arguments");
    let refused = |line: &str, parts: &[&str]| folder.line(line).refused(parts);
    refused("play builtin --clip Fly -o a.json", &["Plum: --clip: ", "`Fly`", "choose one of: ", "walk"]);
    refused("play builtin --fps 0 -o a.json", &["--fps: 0 ", "give 1 to 1000"]);
    refused("play builtin --fps NaN -o a.json", &["--fps: NaN ", "give 1 to 1000"]);
    refused("play builtin --seconds=-1 -o a.json", &["--seconds: -1 ", "give up to 3600"]);
    refused("play builtin -o a.mp4", &["a.mp4: --out: ", "`.mp4`", ".gif"]);
    refused("play builtin -o a", &["a: --out: ", ".gif"]);
    refused("bench teapot", &["`teapot`", "choose one of: springs"]);
    folder.write("r.toml", "[[rule]]\njoints = [\"*\"]\nsoftnes = 1\n");
    refused("bake builtin -o a.sinew --recipe r.toml", &["r.toml: line 3", "softnes", "; "]);
    folder.write("r.toml", "softness = -3\n");
    refused("bake builtin -o a.sinew --recipe r.toml", &["r.toml: softness: -3", "write a number from"]);
    assert_eq!(folder.names(), ["r.toml"], "nothing is written for them");
}

#[test]
fn wrong_usage_is_explained_with_2_and_help_is_given_with_0() {
    let folder = Folder::new("usage");
    for line in
        ["play", "bake builtin", "dance", "play builtin --height 3 -o a.png", "bake builtin -o a --jsn"]
    {
        let ran = folder.line(line);
        assert!(ran.code == Some(2) && ran.out.is_empty(), "{line}: {ran:?}");
        assert!(ran.err.contains("--help"), "{line} points to help: {}", ran.err);
    }
    for command in ["", "bake ", "play ", "verify ", "inspect ", "bench "] {
        let help = folder.good(&format!("{command}--help"));
        assert!(help.out.contains("--json") && help.out.contains("Usage: sinew"), "{}", help.out);
    }
    assert!(folder.good("--version").out.starts_with("sinew "), "a version");
}

#[test]
fn with_json_a_refusal_is_an_object_too() {
    let folder = Folder::new("refusal");
    let ran = folder.line("inspect missing.glb --json");
    assert_eq!(ran.code, Some(2));
    let reason = ran.json()["error"].as_str().expect("a reason").to_owned();
    assert_eq!(ran.err, format!("sinew: {reason}\n"));
    assert!(reason.starts_with("missing.glb: cannot be read"), "{reason}");
    assert_eq!(ran.json()["code"], "FILE_UNREADABLE");
    for (file, bytes, code) in [
        ("a.glb", "this is no model", "INPUT_UNUSABLE"),
        ("a.sinew", "SINWgarbage", "ASSET_TOO_SHORT"),
        ("a.replay", "SNRPgarbage", "REPLAY_NO_HEADER"),
    ] {
        folder.write(file, bytes);
        assert_eq!(folder.line(&format!("inspect {file} --json")).json()["code"], code, "{file}");
    }
}

#[test]
fn assets_and_recordings_of_another_character_are_told_apart() {
    let folder = Folder::new("another");
    if !folder.fox() {
        return;
    }
    folder.good("bake fox.glb -o fox.sinew");
    folder.good("bake builtin -o plum.sinew");
    let wrong = folder.line("play builtin --asset fox.sinew -o a.json");
    wrong.refused(&["Plum: asset: it has ", "the asset 1728", "; bake this file again"]);
    folder.good("play fox.glb --asset fox.sinew --seconds 0.2 -o fox.replay");
    folder.line("verify fox.replay --asset plum.sinew").refused(&["fox.replay: replay: ", "; "]);
    std::fs::remove_file(folder.path().join("fox.sinew")).expect("it is there");
    folder.line("verify fox.replay").refused(&["fox.replay: asset: ", "; name it with --asset"]);
    folder.write("plum.sinew.json", "{\"asset\": \"0123456789abcdef\"}");
    let other = folder.line("play builtin --asset plum.sinew -o a.json");
    other.refused(&["plum.sinew.json: asset: ", "0123456789abcdef", "; bake again"]);
    folder.write("plum.sinew.json", "{\n  \"asset\": 3\n}");
    folder.line("play builtin --asset plum.sinew -o a.json").refused(&["plum.sinew.json: line 2, column "]);
}

#[test]
fn a_recording_that_differs_fails_with_1_and_says_where() {
    let folder = Folder::new("differs");
    if !folder.fox() {
        return;
    }
    folder.good("bake fox.glb -o fox.sinew");
    folder.good("play fox.glb --asset fox.sinew --seconds 0.2 -o fox.replay");
    let mut bytes = folder.read("fox.replay");
    let place = bytes.len() - 588; // in the state after the last frame
    bytes[place] ^= 1;
    folder.write("fox.replay", bytes);
    let ran = folder.line("verify fox.replay");
    assert_eq!(ran.code, Some(1), "{ran:?}");
    assert!(ran.err.is_empty() && ran.out.starts_with("fox.replay: frame 11, stage "), "{ran:?}");
    let json = folder.line("verify fox.replay --json");
    assert_eq!((json.code, json.json()["same"].as_bool()), (Some(1), Some(false)));
    assert_eq!(json.json()["frame"].as_u64(), Some(11));
}

#[cfg(unix)]
#[test]
fn names_with_line_breaks_do_not_break_the_line() {
    let folder = Folder::new("breaks");
    folder.write("a\nb.sinew", "SINW");
    folder.sinew(["inspect", "a\nb.sinew"]).refused(&["a b.sinew: asset: "]);
}

#[cfg(unix)]
#[test]
fn a_full_standard_output_is_told_and_a_closed_one_is_no_failure() {
    if std::path::Path::new("/dev/full").exists() {
        let full = std::fs::OpenOptions::new().write(true).open("/dev/full").expect("it exists");
        let ran = finish(Command::new(SINEW).args(["inspect", "builtin"]).stdout(full));
        ran.refused(&["standard output: cannot be written"]);
    }
    let mut child = Command::new(SINEW);
    child.args(["inspect", "builtin"]).stdout(Stdio::piped()).stderr(Stdio::piped());
    let mut child = child.spawn().expect("the program starts");
    drop(child.stdout.take());
    let output = child.wait_with_output().expect("it ends");
    assert_eq!((output.status.code(), output.stderr), (Some(0), Vec::new()));
}
