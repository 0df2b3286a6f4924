#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| sinew_tests::fuzz::run("bvh", bytes));
