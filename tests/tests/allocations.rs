//! Per-frame code never allocates: a counting allocator proves it.

#![allow(unsafe_code, reason = "an allocator is unsafe by its trait; this one only counts")]

use core::alloc::{GlobalAlloc, Layout};
use core::cell::Cell;
use sinew::{Character, Root};
use sinew_tests::run::{memory, parse};
use sinew_tests::tube;
use std::alloc::System;

thread_local! {
    static COUNT: Cell<usize> = const { Cell::new(0) };
}

struct Counting;

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
}

#[global_allocator]
static COUNTING: Counting = Counting;

fn allocations(f: impl FnOnce()) -> usize {
    let before = COUNT.with(Cell::get);
    f();
    COUNT.with(Cell::get) - before
}

#[test]
fn a_frame_allocates_nothing() {
    assert!(allocations(|| drop(core::hint::black_box(vec![1]))) > 0, "the counter counts");
    let aligned = tube::asset(1.0);
    let asset = parse(&aligned);
    let mut memory = memory(&asset);
    let mut character = Character::new(asset, &mut memory).unwrap();
    let mut state = vec![0; character.state_len()];
    let count = allocations(|| {
        for i in 0..100_u8 {
            let dt = 1.0 / (60.0 + f32::from(i % 3));
            character.step_clip(0, f32::from(i) / 100.0, Root::default(), dt).unwrap();
            core::hint::black_box(character.digests());
        }
        character.save_state(&mut state).unwrap();
        character.load_state(&state).unwrap();
    });
    assert_eq!(count, 0);
}
