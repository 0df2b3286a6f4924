//! `golden FOLDER`: the asset and the recording of the golden frames, and the tube of the microcontroller, made on
//! this machine.

use sinew::Asset;
use sinew_bake::pack;
use sinew_target::golden::Played;
use std::path::Path;
use std::process::ExitCode;
use std::{env, fs, io};

fn write(folder: &Path) -> io::Result<()> {
    let asset = sinew_tests::golden::asset();
    let aligned = pack::align(&asset);
    let parsed = Asset::parse(bytemuck::cast_slice(&aligned)).map_err(io::Error::other)?;
    fs::create_dir_all(folder)?;
    fs::write(folder.join("golden.sinew"), &asset)?;
    fs::write(folder.join("tube.sinew"), bytemuck::cast_slice(&sinew_tests::tube::asset(1.0)))?;
    fs::write(folder.join("golden.replay"), Played::new(parsed).replay)
}

fn main() -> ExitCode {
    let Some(folder) = env::args().nth(1) else {
        eprintln!("usage: golden FOLDER");
        return ExitCode::from(2);
    };
    write(Path::new(&folder)).map_or_else(
        |reason| {
            eprintln!("golden: {folder}: {reason}");
            ExitCode::FAILURE
        },
        |()| ExitCode::SUCCESS,
    )
}
