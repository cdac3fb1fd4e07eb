//! The tables of a campaign's shards, their merge and the page of it.
#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| fuzz::shards(data));
