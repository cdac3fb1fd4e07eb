//! A sample by a joint model, with its share of the end of a block of the default length.
#![cfg_attr(target_os = "none", no_std, no_main)]

use count::arguments::Two;
use count::listener::{Listener, joint_4};
use count::samples::codes;

count::program!(
    ("integer": "joint classifier push K=4",
        (codes: Two<i32>, listener: &mut Listener<2>) -> u32 { listener.push([codes.0, codes.1]) },
        codes, Listener::new(joint_4())),
);
