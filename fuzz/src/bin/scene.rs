//! The reader of scenes, and the configurations of those it takes.
#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| fuzz::scene(data));
