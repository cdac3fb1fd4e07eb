//! The reader of model files, and a classifier with what it takes.
#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| fuzz::model(data));
