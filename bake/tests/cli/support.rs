//! Running the command in a folder of its own.

use std::ffi::OsStr;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// The program under test.
pub(crate) const SINEW: &str = env!("CARGO_BIN_EXE_sinew");

/// What a run left behind.
#[derive(Debug)]
pub(crate) struct Ran {
    pub(crate) code: Option<i32>,
    pub(crate) out: String,
    pub(crate) err: String,
}

impl Ran {
    /// Standard output as the one JSON object that `--json` promises.
    pub(crate) fn json(&self) -> serde_json::Value {
        let value: serde_json::Value = serde_json::from_str(&self.out).expect("one JSON value on stdout");
        assert!(value.is_object() && self.out.lines().count() == 1, "{}", self.out);
        value
    }

    /// That the run was refused with one line that holds all of `parts`.
    pub(crate) fn refused(&self, parts: &[&str]) {
        assert_eq!(self.code, Some(2), "{self:?}");
        assert!(self.out.is_empty(), "nothing on stdout: {}", self.out);
        assert!(self.err.lines().count() == 1 && self.err.starts_with("sinew: "), "one line: {}", self.err);
        parts.iter().for_each(|part| assert!(self.err.contains(part), "{part} is not in {}", self.err));
    }
}

/// Runs a command to its end.
pub(crate) fn finish(command: &mut Command) -> Ran {
    let output = command.output().expect("the program starts");
    let text = |bytes| String::from_utf8(bytes).expect("text");
    Ran { code: output.status.code(), out: text(output.stdout), err: text(output.stderr) }
}

/// A folder that goes when the test ends.
pub(crate) struct Folder(PathBuf);

impl Folder {
    /// `name` is the test's.
    pub(crate) fn new(name: &str) -> Self {
        let path = std::env::temp_dir().join(format!("sinew-cli-{name}-{}", std::process::id()));
        drop(fs::remove_dir_all(&path)); // what a killed run left
        fs::create_dir_all(&path).expect("a temporary folder");
        Self(path)
    }

    pub(crate) fn path(&self) -> &Path {
        &self.0
    }

    /// Runs `sinew` in the folder.
    pub(crate) fn sinew<S: AsRef<OsStr>>(&self, arguments: impl IntoIterator<Item = S>) -> Ran {
        finish(Command::new(SINEW).args(arguments).current_dir(&self.0))
    }

    /// Runs `sinew` with arguments that are apart by spaces, and expects it to succeed.
    pub(crate) fn good(&self, arguments: &str) -> Ran {
        let ran = self.sinew(arguments.split(' '));
        assert_eq!(ran.code, Some(0), "sinew {arguments}: {}", ran.err);
        assert!(ran.err.is_empty(), "no progress bar and no noise where there is no terminal: {}", ran.err);
        ran
    }

    /// Runs `sinew` with arguments that are apart by spaces.
    pub(crate) fn line(&self, arguments: &str) -> Ran {
        self.sinew(arguments.split(' '))
    }

    pub(crate) fn read(&self, name: &str) -> Vec<u8> {
        fs::read(self.0.join(name)).expect("the file was written")
    }

    pub(crate) fn write(&self, name: &str, bytes: impl AsRef<[u8]>) {
        fs::write(self.0.join(name), bytes).expect("a writable folder");
    }

    /// Names of the files in it, sorted.
    pub(crate) fn names(&self) -> Vec<String> {
        let entries = fs::read_dir(&self.0).expect("the folder").map(|e| e.expect("an entry").file_name());
        let mut names: Vec<String> = entries.map(|n| n.to_string_lossy().into_owned()).collect();
        names.sort();
        names
    }

    /// Copies a character of the shared data here; `false` where it is missing, which is a failure on the build
    /// machine.
    pub(crate) fn fetch(&self, file: &str, name: &str) -> bool {
        let from = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../shared/data")).join(file);
        if !from.exists() {
            assert!(std::env::var("CI").as_deref() != Ok("true"), "{} is missing", from.display());
            eprintln!("skipped: {} is missing", from.display());
            return false;
        }
        fs::copy(from, self.0.join(name)).is_ok()
    }

    /// Copies the fox here as `fox.glb`.
    pub(crate) fn fox(&self) -> bool {
        self.fetch("khronos/Fox.glb", "fox.glb")
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        drop(fs::remove_dir_all(&self.0));
    }
}
