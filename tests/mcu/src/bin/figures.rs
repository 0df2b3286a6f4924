//! The firmware that runs one part after the other, to be counted.

#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(not(all(target_arch = "arm", target_os = "none")))]
#[allow(clippy::print_stdout, reason = "a command line prints")]
fn main() {
    let mut say = |name: &str, elements| println!("{name} {elements:016x}");
    let _ = sinew_mcu::figures::run(&sinew_mcu::TUBE.0, &mut [0.0; sinew_mcu::MEMORY], &mut say);
}

#[cfg(all(target_arch = "arm", target_os = "none"))]
#[cortex_m_rt::entry]
fn main() -> ! {
    // The attribute makes it a reference that is given out once.
    static mut FLOATS: [f32; sinew_mcu::MEMORY] = [0.0; sinew_mcu::MEMORY];
    use sinew_mcu::{board, figures};
    let done =
        figures::run(&sinew_mcu::TUBE.0, FLOATS, &mut |name, elements| board::say(name, elements as u64));
    board::exit(done.is_some())
}
