//! What safe code cannot see or do: count this thread's allocations, and set its float environment.
//!
//! The one file of this crate with `unsafe`. A test counts with
//! `#[global_allocator] static COUNTING: Counting = Counting;`.

#![allow(unsafe_code, reason = "an allocator is unsafe by its trait, the control register by its nature")]

use core::alloc::{GlobalAlloc, Layout};
use core::cell::Cell;
use std::alloc::System;

thread_local! {
    static COUNT: Cell<usize> = const { Cell::new(0) };
}

/// The system's allocator, counting.
#[derive(Debug)]
pub struct Counting;

// SAFETY: every call is passed on to the system's allocator unchanged.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        COUNT.with(|c| c.set(c.get() + 1));
        // SAFETY: the caller's contract is the system allocator's.
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        // SAFETY: as above.
        unsafe { System.dealloc(pointer, layout) }
    }

    unsafe fn realloc(&self, pointer: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        COUNT.with(|c| c.set(c.get() + 1));
        // SAFETY: as above.
        unsafe { System.realloc(pointer, layout, size) }
    }
}

/// What `f` returns, and how often this thread allocated meanwhile; 0 where [`Counting`] is not installed.
pub fn allocations<T>(f: impl FnOnce() -> T) -> (T, usize) {
    let before = COUNT.with(Cell::get);
    let out = f();
    (out, COUNT.with(Cell::get) - before)
}

/// The control and status register of SSE, as a C library, an audio host or a plug-in sets it on a thread.
#[cfg(target_arch = "x86_64")]
pub mod control {
    use core::arch::asm;

    /// As a process starts: round to nearest, keep subnormals, no exception traps.
    pub const DEFAULT: u32 = 0x1f80;
    /// Subnormal operands count as zero.
    pub const DAZ: u32 = 1 << 6;
    /// Subnormal results become zero.
    pub const FTZ: u32 = 1 << 15;
    /// Round down, up, towards zero.
    pub const ROUNDING: [u32; 3] = [1 << 13, 2 << 13, 3 << 13];
    /// Flag: an operand was subnormal (not raised under [`DAZ`]).
    pub const DENORMAL: u32 = 1 << 1;
    /// Flag: a result was subnormal and not exact, or was made zero.
    pub const UNDERFLOW: u32 = 1 << 4;

    fn get() -> u32 {
        let mut word = 0_u32;
        // SAFETY: writes the four bytes of `word` and nothing else.
        unsafe { asm!("stmxcsr [{}]", in(reg) &raw mut word, options(nostack)) };
        word
    }

    fn set(word: u32) {
        // SAFETY: `word` is `DEFAULT` with rounding, DAZ and FTZ changed: no reserved bit, no unmasked trap. Code
        // that runs meanwhile is what is under test: a host of the library does the same to it from outside. No
        // memory is touched whatever the rounding, and `Restore` sets the register back.
        unsafe { asm!("ldmxcsr [{}]", in(reg) &raw const word, options(nostack)) };
    }

    struct Restore;

    impl Drop for Restore {
        fn drop(&mut self) {
            set(DEFAULT);
        }
    }

    /// Runs `f` with `changes` to the register and all flags down; what it returns, and the flags it raised.
    #[inline(never)]
    pub fn with<T>(changes: u32, f: impl FnOnce() -> T) -> (T, u32) {
        let restore = Restore;
        set(DEFAULT | changes);
        let out = core::hint::black_box(core::hint::black_box(f)());
        let flags = get() & 0x3f;
        drop(restore);
        (out, flags)
    }
}
