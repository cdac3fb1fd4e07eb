//! The same of nine classes.
#![cfg_attr(target_os = "none", no_std, no_main)]

use count::arguments::Two;
use count::listener::{Listener, block_9};
use count::samples::codes;

count::program!(
    ("integer": "classifier push and end of block K=9",
        (codes: Two<i32>, listener: &mut Listener<2>) -> u32 { listener.push([codes.0, codes.1]) },
        codes, Listener::new(block_9())),
);
