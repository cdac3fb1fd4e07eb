//! A sample of one or two channels: by the papers' models, in which it ends no block; by
//! a joint model, with its share of the end of a block of 20, and in the air.
#![cfg_attr(target_os = "none", no_std, no_main)]

use count::arguments::Two;
use count::listener::{Listener, joint_4, open_4, open_9, single_4};
use count::samples::codes;

count::program!(
    ("integer": "classifier push K=4",
        (codes: Two<i32>, listener: &mut Listener<2>) -> u32 { listener.push([codes.0, codes.1]) },
        codes, Listener::new(open_4())),
    ("integer": "classifier push of one channel K=4",
        (code: i32, listener: &mut Listener<1>) -> u32 { listener.push([code]) },
        |call| codes(call).0, Listener::new(single_4())),
    ("integer": "classifier push K=9",
        (codes: Two<i32>, listener: &mut Listener<2>) -> u32 { listener.push([codes.0, codes.1]) },
        codes, Listener::new(open_9())),
    ("integer": "joint classifier push K=4",
        (codes: Two<i32>, listener: &mut Listener<2>) -> u32 { listener.push([codes.0, codes.1]) },
        codes, Listener::new(joint_4())),
    ("integer": "joint classifier in the air K=4",
        (codes: Two<i32>, listener: &mut Listener<2>) -> u32 { listener.pass([codes.0, codes.1]) },
        codes, Listener::new(joint_4())),
);
