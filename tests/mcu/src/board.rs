//! Out of the emulated board: text, an exit status, how deep the stack went. No `core::fmt`: it takes room and may panic.

#![allow(unsafe_code, reason = "memory that belongs to no variable is read")]

use core::panic::PanicInfo;

use cortex_m_rt::{STACK_PAINT_VALUE, heap_start};
use cortex_m_semihosting::{debug, hio};

/// Prints a line: a name and a hexadecimal number.
pub fn say(name: &str, number: u64) {
    let mut line = [b' '; 18];
    for (digit, shift) in line.iter_mut().skip(1).zip((0..16).rev()) {
        let value = (number >> (4 * shift)).to_le_bytes()[0] & 15;
        *digit = if value < 10 { b'0' + value } else { b'a' + value - 10 };
    }
    line[17] = b'\n';
    let Ok(mut host) = hio::hstdout() else { return };
    // There is nobody to tell if it fails.
    let _ = host.write_all(name.as_bytes()).and_then(|()| host.write_all(&line));
}

/// Ends the emulation.
pub fn exit(success: bool) -> ! {
    debug::exit(if success { debug::EXIT_SUCCESS } else { debug::EXIT_FAILURE });
    loop {
        core::hint::spin_loop();
    }
}

unsafe extern "C" {
    /// The linker script's end of the stack's memory; its address matters.
    static _stack_start: u32;
}

/// Bytes of the stack that were ever in use: `cortex-m-rt` painted them before `main`.
#[must_use]
pub fn stack_used() -> u64 {
    let (mut word, end) = (heap_start().cast_const(), &raw const _stack_start);
    // SAFETY: from the end of the statics to `_stack_start` lies the stack, in whole words, and the loop ends
    // there at the latest. Read as volatile: no variable has this memory.
    while word < end && unsafe { word.read_volatile() } == STACK_PAINT_VALUE {
        // SAFETY: not beyond the end, as `word < end`.
        word = unsafe { word.add(1) };
    }
    (end as usize - word as usize) as u64
}

#[panic_handler]
fn panic(_: &PanicInfo<'_>) -> ! {
    exit(false)
}
