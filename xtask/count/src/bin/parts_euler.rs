//! The parts of a tick that differ with the papers' integrators.
#![cfg_attr(target_os = "none", no_std, no_main)]

use count::arguments::Three;
use count::format::{Oscillators, oscillators, parts};
use count::samples::drives;
use whisking::muscle;

count::program!(R, parts = parts::<R>(R::EULER),
    ("muscle (euler)",
        (at: Three<R>, (config, state): &mut (&muscle::Config<R>, muscle::State<R>)) {
            let Three(gain, before, after) = at;
            config.step(state, gain, before, after);
        },
        drives::<R>(), (&parts.motion.whisking.muscle, muscle::State::default())),
    ("oscillators of 2 sides (euler)",
        (_: u32, (config, state, drive): &mut Oscillators<R>) {
            config.step(state, None);
            *drive = config.drives(state);
        },
        |call| call, oscillators(&parts)),
);
