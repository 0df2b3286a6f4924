//! The rules of the house, checked by reading the sources: layers, lengths, forbidden words.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

/// Lines a file may have.
const FILE_LINES: usize = 400;
/// Lines a function may have, from its `fn` to its last brace.
const FUNCTION_LINES: usize = 60;
/// Exceptions: `(file, function or "" for the file, lines allowed, reason)`. One that is not needed fails.
const EXCEPTIONS: [(&str, &str, usize, &str); 0] = [];

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

/// All Rust files below the crates, without build folders.
fn sources() -> Vec<(String, String)> {
    let mut stack: Vec<PathBuf> =
        ["core", "bake", "wasm", "tests", "xtask"].iter().map(|d| root().join(d)).collect();
    let mut out = Vec::new();
    while let Some(folder) = stack.pop() {
        for entry in fs::read_dir(&folder).expect("a folder of the workspace") {
            let path = entry.expect("an entry").path();
            let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
            if path.is_dir() && !["target", "node_modules", "pkg"].contains(&name.as_str()) {
                stack.push(path);
            } else if name.ends_with(".rs") {
                let text = fs::read_to_string(&path).expect("UTF-8");
                let relative = path.strip_prefix(root()).expect("below the root").display().to_string();
                out.push((relative, text));
            }
        }
    }
    out.sort();
    assert!(out.len() > 30, "the sources were not found");
    out
}

/// Code without comments, strings and character literals, line by line.
fn code(text: &str) -> Vec<String> {
    let mut out = Vec::new();
    let mut raw_string = None;
    for line in text.lines() {
        let mut kept = String::new();
        let mut rest = line;
        if let Some(end) = &raw_string {
            match rest.find(end) {
                Some(at) => rest = &rest[at + String::len(end)..],
                None => {
                    out.push(kept);
                    continue;
                }
            }
            raw_string = None;
        }
        let mut in_string = false;
        let mut chars = rest.char_indices().peekable();
        while let Some((at, c)) = chars.next() {
            let tail = &rest[at..];
            if in_string {
                match c {
                    '\\' => {
                        chars.next();
                    }
                    '"' => in_string = false,
                    _ => {}
                }
            } else if tail.starts_with("//") {
                break;
            } else if tail.starts_with("r#\"") || tail.starts_with("r\"") {
                let end = if tail.starts_with("r#") { "\"#".to_owned() } else { "\"".to_owned() };
                let start = at + tail.find('"').unwrap_or(0) + 1;
                match rest[start..].find(&end) {
                    Some(length) => {
                        while chars.peek().is_some_and(|(i, _)| *i < start + length + end.len()) {
                            chars.next();
                        }
                    }
                    None => {
                        raw_string = Some(end);
                        break;
                    }
                }
            } else if c == '"' {
                in_string = true;
            } else if let Some(length) = character_literal(tail) {
                for _ in 1..length {
                    chars.next();
                }
            } else {
                kept.push(c);
            }
        }
        out.push(kept);
    }
    out
}

/// Characters of the literal at the start of `text`: `'{'`, `'\n'`; not a lifetime.
fn character_literal(text: &str) -> Option<usize> {
    let chars: Vec<char> = text.chars().take(4).collect();
    match chars.as_slice() {
        ['\'', '\\', _, '\''] => Some(4),
        ['\'', c, '\'', ..] if *c != '\'' => Some(3),
        _ => None,
    }
}

/// Functions of a file with their lengths.
fn functions(text: &str) -> Vec<(String, usize)> {
    let lines = code(text);
    let mut out = Vec::new();
    for (start, line) in lines.iter().enumerate() {
        let Some(at) = line.find("fn ").filter(|at| *at == 0 || !is_word(line.as_bytes()[at - 1])) else {
            continue;
        };
        let name: String = line[at + 3..].chars().take_while(|c| is_word(*c as u8)).collect();
        let (mut depth, mut opened) = (0_i32, false);
        for (end, line) in lines.iter().enumerate().skip(start) {
            let skip = if end == start { at } else { 0 };
            for c in line[skip..].chars() {
                match c {
                    '{' => (depth, opened) = (depth + 1, true),
                    '}' => depth -= 1,
                    _ => {}
                }
            }
            let declaration = !opened && line.contains(';');
            if declaration {
                break;
            }
            if opened && depth <= 0 {
                out.push((name.clone(), end - start + 1));
                break;
            }
        }
    }
    out.retain(|(name, _)| !name.is_empty());
    out
}

fn is_word(c: u8) -> bool {
    c.is_ascii_alphanumeric() || c == b'_'
}

#[test]
fn files_and_functions_keep_their_budgets() {
    let mut broken = Vec::new();
    let mut used = BTreeSet::new();
    let mut allow = |file: &str, function: &str, lines: usize, budget: usize| {
        if lines <= budget {
            return;
        }
        match EXCEPTIONS.iter().position(|(f, n, most, _)| *f == file && *n == function && lines <= *most) {
            Some(i) => drop(used.insert(i)),
            None => broken.push(format!("{file} {function}: {lines} lines, {budget} allowed")),
        }
    };
    for (file, text) in sources() {
        allow(&file, "", text.lines().count(), FILE_LINES);
        for (function, lines) in functions(&text) {
            allow(&file, &function, lines, FUNCTION_LINES);
        }
    }
    assert!(broken.is_empty(), "over budget:\n{}", broken.join("\n"));
    assert_eq!(used.len(), EXCEPTIONS.len(), "an exception is not needed any more");
}

/// What each layer of `core` may use; `character.rs` and its neighbours are the layer `character`.
fn arrows() -> BTreeMap<&'static str, &'static [&'static str]> {
    BTreeMap::from([
        ("math", &["dispatch"][..]), // a square root that Rust has no name for
        ("lanes", &[]),
        ("dispatch", &["lanes"]),
        ("kernel", &["math", "lanes", "dispatch"]),
        ("stage", &["kernel", "math", "lanes"]),
        ("asset", &["kernel", "math"]),
        ("character", &["stage", "asset", "kernel", "math"]),
        ("replay", &["character", "stage", "asset", "math"]),
    ])
}

/// Layer of a path below `core/src`, or of a module name.
fn layer(module: &str) -> &str {
    match module {
        "math" | "lanes" | "dispatch" | "kernel" | "stage" | "asset" | "replay" => module,
        _ => "character",
    }
}

#[test]
fn layers_point_one_way() {
    let arrows = arrows();
    let mut broken = Vec::new();
    for (file, text) in sources() {
        let Some(below) = file.strip_prefix("core/src/") else { continue };
        if below == "lib.rs" {
            continue;
        }
        let from = layer(below.split('/').next().unwrap_or_default().trim_end_matches(".rs"));
        let text = text.split("#[cfg(test)]\nmod tests").next().unwrap_or_default();
        for line in code(text) {
            for used in line.split("crate::").skip(1) {
                let module: String = used.chars().take_while(|c| is_word(*c as u8)).collect();
                let to = layer(&module);
                if to != from && !arrows[from].contains(&to) {
                    broken.push(format!("{file}: {from} uses {to}"));
                }
            }
        }
    }
    assert!(broken.is_empty(), "arrows that must not be:\n{}", broken.join("\n"));
}

#[test]
fn no_module_is_a_drawer() {
    for (file, _) in sources() {
        let name = file.rsplit('/').next().unwrap_or_default();
        assert!(!["utils.rs", "util.rs", "common.rs", "helpers.rs", "misc.rs"].contains(&name), "{file}");
    }
}

/// Per-frame code never names a platform float function or a fused operation.
#[test]
fn the_runtime_uses_its_own_functions() {
    let forbidden =
        [".mul_add(", ".exp(", ".sin(", ".cos(", ".powf(", ".powi(", ".sin_cos(", "libm::exp", "libm::sin"];
    for (file, text) in sources().into_iter().filter(|(f, _)| f.starts_with("core/src")) {
        let text = text.split("#[cfg(test)]\nmod tests").next().unwrap_or_default().to_owned();
        let text = text.split("#[cfg(test)]\n#[allow").next().unwrap_or_default();
        for (i, line) in code(text).iter().enumerate() {
            for word in forbidden {
                assert!(!line.contains(word), "{file}:{}: {word}", i + 1);
            }
        }
    }
}

#[test]
fn the_counters_count() {
    let text = "fn a() {\n    let s = \"}\"; // }\n    let c = '{';\n}\n\nfn b();\nfn c<'a>(x: &'a str) -> usize {\n    x.len()\n}\n";
    assert_eq!(functions(text), [("a".to_owned(), 4), ("c".to_owned(), 3)]);
}
