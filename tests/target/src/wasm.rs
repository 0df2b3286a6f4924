//! The program as a module without imports: files in, text out, through its memory.
//!
//! `room(i, len)` makes room for file `i`, 0 the asset, 1 the replay; `run()` returns the length of the text, which
//! begins at `text()`. Names that a host sees are unsafe by decree: two of the same name could be linked.

#![allow(unsafe_code, reason = "exported names")]

use std::sync::Mutex;

static FILES: Mutex<[Vec<u8>; 2]> = Mutex::new([const { Vec::new() }; 2]);
static TEXT: Mutex<String> = Mutex::new(String::new());

// SAFETY: no other `room` is linked into this program.
#[unsafe(no_mangle)]
extern "C" fn room(i: usize, len: usize) -> *mut u8 {
    let mut files = FILES.lock().expect("one thread");
    files[i] = vec![0; len];
    files[i].as_mut_ptr()
}

// SAFETY: no other `run` is linked into this program.
#[unsafe(no_mangle)]
extern "C" fn run() -> usize {
    let [asset, replay] = &*FILES.lock().expect("one thread");
    let lines = |all: Vec<sinew_target::Named>| {
        all.iter().map(|(name, digest)| format!("{digest:016x} {name}\n")).collect()
    };
    let text = sinew_target::digests(asset, replay).map_or_else(|reason| reason, lines);
    let len = text.len();
    *TEXT.lock().expect("one thread") = text;
    len
}

// SAFETY: no other `text` is linked into this program.
#[unsafe(no_mangle)]
extern "C" fn text() -> *const u8 {
    TEXT.lock().expect("one thread").as_ptr()
}
