//! Other programs: run with their output kept, the last line shown meanwhile.

use core::time::Duration;
use std::env;
use std::ffi::OsStr;
use std::fs;
use std::io::{self, BufRead, BufReader};
use std::path::Path;
use std::process::{Command, ExitStatus, Stdio};
use std::sync::mpsc::{self, RecvTimeoutError};
use std::thread;

use anyhow::{Context, Result, bail};

use crate::report::Step;
use crate::workspace;

/// Lines of a failed program's output that go into the error.
const TAIL: usize = 60;

/// A program in a folder, without the variables cargo set for this one.
pub(crate) fn command(program: impl AsRef<OsStr>, dir: &Path) -> Command {
    let mut command = Command::new(program);
    command.current_dir(dir).stdin(Stdio::null());
    for (name, _) in env::vars_os() {
        let text = name.to_string_lossy();
        // Left in place they would make build scripts see a changed environment, hence rebuild.
        if text.starts_with("CARGO_PKG_") || text.starts_with("CARGO_MANIFEST_") {
            command.env_remove(&name);
        }
    }
    command
}

/// The cargo that runs this program, in the root, with the workspace's target folder.
pub(crate) fn cargo() -> Command {
    let program = env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let mut cargo = command(program, &workspace::root());
    cargo.env("CARGO_TARGET_DIR", workspace::target_dir());
    if workspace::ci() {
        // Incremental data is never read again there, and is half of the disk space.
        cargo.env("CARGO_INCREMENTAL", "0");
    }
    cargo
}

/// What a program printed, if it starts and succeeds; nothing is shown.
pub(crate) fn output(command: &mut Command) -> Option<String> {
    let output = command.stderr(Stdio::null()).output().ok()?;
    output.status.success().then(|| String::from_utf8_lossy(&output.stdout).trim().to_owned())
}

/// Runs as one step of progress and returns both output streams as they came.
///
/// # Errors
///
/// If the program cannot be started or fails; the error ends with the last lines of its output.
pub(crate) fn run(name: &str, command: &mut Command) -> Result<String> {
    let step = Step::start(name);
    let (status, text) = stream(&step, command)?;
    if status.success() {
        step.done();
        return Ok(text);
    }
    step.end("FAILED");
    bail!(failure(name, command, status, &text))
}

/// What is told of a program that failed; its whole output is kept in a file.
#[must_use]
pub(crate) fn failure(name: &str, command: &Command, status: ExitStatus, text: &str) -> String {
    let file = name.replace(|c: char| !c.is_ascii_alphanumeric(), "-");
    let log = workspace::target_dir().join("xtask-logs").join(file).with_extension("log");
    let kept =
        log.parent().is_some_and(|dir| fs::create_dir_all(dir).is_ok()) && fs::write(&log, text).is_ok();
    let whole = if kept { format!("\nwhole output: {}", workspace::shown(&log)) } else { String::new() };
    format!("`{}`: {status}\n{}{whole}", shown(command), tail(text))
}

/// Runs inside a step; a failing program is not an error here.
///
/// # Errors
///
/// If the program cannot be started.
pub(crate) fn stream(step: &Step, command: &mut Command) -> Result<(ExitStatus, String)> {
    let (reader, writer) = io::pipe()?;
    let program = shown(command);
    let mut child = command
        .stdout(writer.try_clone()?)
        .stderr(writer)
        .spawn()
        .with_context(|| format!("cannot start `{program}`"))?;
    // The command holds the writing end: let go of it, or the reader would never see the end.
    command.stdout(Stdio::null()).stderr(Stdio::null());
    let text = collect(step, reader);
    Ok((child.wait()?, text))
}

/// Reads to the end, showing the lines.
fn collect(step: &Step, reader: io::PipeReader) -> String {
    let (sender, lines) = mpsc::channel();
    thread::spawn(move || {
        // Split by hand: a program may print what is not UTF-8.
        for line in BufReader::new(reader).split(b'\n').map_while(Result::ok) {
            if sender.send(String::from_utf8_lossy(&line).into_owned()).is_err() {
                break;
            }
        }
    });
    let mut text = String::new();
    loop {
        match lines.recv_timeout(Duration::from_millis(500)) {
            Ok(line) => {
                step.line(&line);
                text.push_str(&line);
                text.push('\n');
            }
            Err(RecvTimeoutError::Timeout) => {}
            Err(RecvTimeoutError::Disconnected) => return text,
        }
        step.tick();
    }
}

/// The last lines of a log, without tests that passed.
#[must_use]
pub(crate) fn tail(text: &str) -> String {
    let telling = |line: &&str| !line.ends_with("... ok") && !line.trim().is_empty();
    let lines: Vec<&str> = text.lines().filter(telling).collect();
    lines[lines.len().saturating_sub(TAIL)..].join("\n")
}

/// A command as one would type it.
#[must_use]
pub(crate) fn shown(command: &Command) -> String {
    let words = core::iter::once(command.get_program()).chain(command.get_args());
    words.map(|word| word.to_string_lossy()).collect::<Vec<_>>().join(" ")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn shell(script: &str) -> Command {
        let mut command = command("sh", Path::new("."));
        command.args(["-c", script]);
        command
    }

    #[test]
    fn both_streams_are_kept_in_order() {
        let text = run("echo", &mut shell("echo one; echo two >&2; echo three")).unwrap();
        assert_eq!(text, "one\ntwo\nthree\n", "merged as a terminal would show them");
    }

    #[test]
    fn failure_carries_the_last_output() {
        let error = run("fail", &mut shell("echo reason; exit 3")).unwrap_err().to_string();
        assert!(error.contains("reason") && error.contains('3'), "{error}");
    }

    #[test]
    fn a_missing_program_is_named() {
        let error = run("absent", &mut command("no-such-program", Path::new("."))).unwrap_err().to_string();
        assert!(error.contains("no-such-program"), "{error}");
    }
}
