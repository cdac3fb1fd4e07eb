//! The first ticks of the scenes that are taken.
#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| fuzz::simulation(data));
