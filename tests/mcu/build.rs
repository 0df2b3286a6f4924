//! Where flash and RAM lie on the emulated boards; nothing on other machines.

use std::path::PathBuf;
use std::{env, fs};

const MEMORY: &str =
    "MEMORY { FLASH : ORIGIN = 0, LENGTH = 1024K\n RAM : ORIGIN = 0x20000000, LENGTH = 128K }\n";

fn main() {
    println!("cargo:rerun-if-changed=build.rs");
    if env::var("CARGO_CFG_TARGET_OS").as_deref() != Ok("none") {
        return;
    }
    let folder = PathBuf::from(env::var_os("OUT_DIR").expect("cargo sets it"));
    fs::write(folder.join("memory.x"), MEMORY).expect("cargo's folder can be written");
    println!("cargo:rustc-link-search={}", folder.display());
    println!("cargo:rustc-link-arg-bins=-Tlink.x");
    println!("cargo:rustc-link-arg-bins=--nmagic");
}
