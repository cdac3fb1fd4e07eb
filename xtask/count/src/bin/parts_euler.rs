//! The parts of a tick that differ with the papers' integrators.
#![cfg_attr(target_os = "none", no_std, no_main)]

use count::arguments::Three;
use count::format::in_memory;
use count::samples::drives;
use whisking::muscle::{self, MuscleIntegrator};
use whisking::oscillator::{self, OscillatorIntegrator};

count::program!(R,
    ("muscle (euler)",
        (at: Three<R>, state: &mut muscle::State<R>) {
            let Three(gain, before, after) = at;
            in_memory(R::EULER_MUSCLE).step(state, gain, before, after);
        },
        drives::<R>(), muscle::State::default()),
    ("oscillators of 2 sides (euler)",
        (_: u32, (state, drive): &mut (oscillator::State<R, 2>, [R; 2])) {
            in_memory(R::EULER_OSCILLATORS).step(state, None);
            *drive = in_memory(R::EULER_OSCILLATORS).drives(state);
        },
        |call| call, (oscillator::State::new(R::EULER_START.oscillators), [R::ZERO; 2])),
);
