//! A sample by a joint model in the air.
#![cfg_attr(target_os = "none", no_std, no_main)]

use count::arguments::Two;
use count::listener::{Listener, joint_4};
use count::samples::codes;

count::program!(
    ("integer": "joint classifier in the air K=4",
        (codes: Two<i32>, listener: &mut Listener<2>) -> u32 { listener.pass([codes.0, codes.1]) },
        codes, Listener::new(joint_4())),
);
