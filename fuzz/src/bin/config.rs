//! The reader of configurations, and a module's ticks by those it takes.
#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| fuzz::config(data));
