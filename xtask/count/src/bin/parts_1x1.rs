//! The part of a tick that is another with one side.
#![cfg_attr(target_os = "none", no_std, no_main)]

use count::format::{Oscillators, oscillators, parts};

count::program!(R, parts = parts::<R>(R::LONE),
    ("oscillator of 1 side",
        (_: u32, (config, state, drive): &mut Oscillators<R>) {
            config.step(state, None);
            *drive = config.drives(state);
        },
        |call| call, oscillators(&parts)),
);
