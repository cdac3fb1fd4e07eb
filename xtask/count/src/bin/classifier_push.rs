//! A sample of two channels by the papers' model, in which it ends no block.
#![cfg_attr(target_os = "none", no_std, no_main)]

use count::arguments::Two;
use count::listener::{Listener, open_4};
use count::samples::codes;

count::program!(
    ("integer": "classifier push K=4",
        (codes: Two<i32>, listener: &mut Listener<2>) -> u32 { listener.push([codes.0, codes.1]) },
        codes, Listener::new(open_4())),
);
