//! A sample of two channels that ends a block; in some a decision falls.
#![cfg_attr(target_os = "none", no_std, no_main)]

use count::arguments::Two;
use count::listener::{Listener, block_4};
use count::samples::codes;

count::program!(
    ("integer": "classifier push and end of block K=4",
        (codes: Two<i32>, listener: &mut Listener<2>) -> u32 { listener.push([codes.0, codes.1]) },
        codes, Listener::new(block_4())),
);
