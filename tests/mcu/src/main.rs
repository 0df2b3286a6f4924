//! The firmware: plays the tube from flash and prints the digest of its frames.

#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(not(all(target_arch = "arm", target_os = "none")))]
#[allow(clippy::print_stdout, reason = "a command line prints")]
fn main() {
    match sinew_mcu::play(&sinew_mcu::TUBE.0, &mut [0.0; sinew_mcu::MEMORY]) {
        Some(digest) => println!("digest {digest:016x}"),
        None => println!("the asset was refused"),
    }
}

#[cfg(all(target_arch = "arm", target_os = "none"))]
#[cortex_m_rt::entry]
fn main() -> ! {
    // The attribute makes it a reference that is given out once.
    static mut FLOATS: [f32; sinew_mcu::MEMORY] = [0.0; sinew_mcu::MEMORY];
    use sinew_mcu::board;
    let digest = sinew_mcu::play(&sinew_mcu::TUBE.0, FLOATS);
    board::say("stack", board::stack_used());
    board::say("digest", digest.unwrap_or(0));
    board::exit(digest.is_some())
}
