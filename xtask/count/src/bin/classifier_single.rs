//! A sample of one channel by the papers' model, in which it ends no block.
#![cfg_attr(target_os = "none", no_std, no_main)]

use count::listener::{Listener, single_4};
use count::samples::codes;

count::program!(
    ("integer": "classifier push of one channel K=4",
        (code: i32, listener: &mut Listener<1>) -> u32 { listener.push([code]) },
        |call| codes(call).0, Listener::new(single_4())),
);
