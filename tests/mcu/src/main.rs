//! The firmware: plays the tube from flash, prints the digest of its frames, then what its parts cost.
//!
//! Every line is a word or more and a hexadecimal number. Text is made by hand: `core::fmt` may panic, and takes room.

#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(not(all(target_arch = "arm", target_os = "none")))]
#[allow(clippy::print_stdout, reason = "a command line prints")]
fn main() {
    let mut memory = vec![0.0; sinew_mcu::MEMORY];
    match sinew_mcu::play(&sinew_mcu::TUBE.0, &mut memory) {
        Some(digest) => println!("{digest:016x}"),
        None => println!("the asset was refused"),
    }
}

#[cfg(all(target_arch = "arm", target_os = "none"))]
mod firmware {
    use core::panic::PanicInfo;

    use cortex_m_semihosting::{debug, hio};
    use sinew_mcu::{MEMORY, TUBE, figures};

    #[cortex_m_rt::entry]
    fn main() -> ! {
        // The attribute makes it a reference that is given out once.
        static mut FLOATS: [f32; MEMORY] = [0.0; MEMORY];
        let digest = sinew_mcu::play(&TUBE.0, FLOATS);
        let stack = stack::used();
        let measured = figures::run(&TUBE.0, FLOATS, &mut |name, elements| say(name, elements as u64));
        say("stack", stack);
        say("digest", digest.unwrap_or(0));
        debug::exit(if measured.is_some() { debug::EXIT_SUCCESS } else { debug::EXIT_FAILURE });
        loop {}
    }

    /// Prints a line.
    fn say(name: &str, number: u64) {
        let mut digits = [b' '; 18];
        for (digit, shift) in digits.iter_mut().skip(1).zip((0..16).rev()) {
            let value = (number >> (4 * shift)).to_le_bytes()[0] & 15;
            *digit = if value < 10 { b'0' + value } else { b'a' + value - 10 };
        }
        digits[17] = b'\n';
        let Ok(mut host) = hio::hstdout() else { return };
        // There is nobody to tell if it fails.
        let _ = host.write_all(name.as_bytes()).and_then(|()| host.write_all(&digits));
    }

    mod stack {
        #![allow(unsafe_code, reason = "memory that belongs to no variable is read")]

        use cortex_m_rt::{STACK_PAINT_VALUE, heap_start};

        unsafe extern "C" {
            /// The linker script's end of the stack's memory; its address matters.
            static _stack_start: u32;
        }

        /// Bytes of the stack that were ever in use: `cortex-m-rt` painted them before `main`.
        pub(super) fn used() -> u64 {
            let (mut word, end) = (heap_start().cast_const(), &raw const _stack_start);
            // SAFETY: from the end of the statics to `_stack_start` lies the stack, in whole words; reading
            // them as volatile holds for no value, and the loop ends at the latest there.
            while word < end && unsafe { word.read_volatile() } == STACK_PAINT_VALUE {
                // SAFETY: not beyond the end, as `word < end`.
                word = unsafe { word.add(1) };
            }
            (end as usize - word as usize) as u64
        }
    }

    #[panic_handler]
    fn panic(_: &PanicInfo<'_>) -> ! {
        debug::exit(debug::EXIT_FAILURE);
        loop {}
    }
}
