//! The firmware: plays the tube from flash and prints the digest of its frames.

#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(not(all(target_arch = "arm", target_os = "none")))]
#[allow(clippy::print_stdout, reason = "a command line prints")]
fn main() {
    let mut memory = [0.0; sinew_mcu::MEMORY];
    println!("{:016x}", sinew_mcu::play(&sinew_mcu::TUBE.0, &mut memory));
}

#[cfg(all(target_arch = "arm", target_os = "none"))]
mod firmware {
    #![allow(unsafe_code, reason = "the entry point is exported by name")]

    use core::panic::PanicInfo;
    use cortex_m as _;
    use cortex_m_semihosting::{debug, hprintln};

    #[cortex_m_rt::entry]
    fn main() -> ! {
        let mut memory = [0.0; sinew_mcu::MEMORY];
        let digest = sinew_mcu::play(&sinew_mcu::TUBE.0, &mut memory);
        hprintln!("{:016x}", digest);
        debug::exit(debug::EXIT_SUCCESS);
        loop {}
    }

    #[panic_handler]
    fn panic(_: &PanicInfo<'_>) -> ! {
        debug::exit(debug::EXIT_FAILURE);
        loop {}
    }
}
