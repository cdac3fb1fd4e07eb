//! The parts of a tick, with the structure-preserving integrators.
#![cfg_attr(target_os = "none", no_std, no_main)]

use count::arguments::Three;
use count::format::in_memory;
use count::samples::{drives, number};
use whisking::gate::Gate;
use whisking::muscle::MuscleIntegrator;
use whisking::oscillator::OscillatorIntegrator;
use whisking::{filter, muscle, oscillator, pd};

count::program!(R,
    ("h50",
        (x: R, state: &mut filter::State<R>) -> R { in_memory(R::H50).process(state, x) },
        number::<R>(-1.0, 1.0), filter::State::default()),
    ("gates z and g",
        (contact: R, (z, lift, nominal): &mut (Gate<R>, Gate<R>, R)) {
            in_memory(R::RCP).step(z, contact);
            in_memory(R::CIA).step(lift, *nominal, contact);
        },
        number::<R>(0.0, 1.0), (Gate::default(), Gate::default(), R::ONE)),
    ("muscle",
        (at: Three<R>, state: &mut muscle::State<R>) {
            let Three(gain, before, after) = at;
            in_memory(R::MUSCLE).step(state, gain, before, after);
        },
        drives::<R>(), muscle::State::default()),
    ("oscillator of 1 side",
        (_: u32, (state, drive): &mut (oscillator::State<R, 1>, [R; 1])) {
            in_memory(R::OSCILLATORS).step(state, None);
            *drive = in_memory(R::OSCILLATORS).drives(state);
        },
        |call| call, (oscillator::State::new(R::START_1.oscillators), [R::ZERO; 1])),
    ("oscillators of 2 sides",
        (_: u32, (state, drive): &mut (oscillator::State<R, 2>, [R; 2])) {
            in_memory(R::OSCILLATORS).step(state, None);
            *drive = in_memory(R::OSCILLATORS).drives(state);
        },
        |call| call, (oscillator::State::new(R::START_2.oscillators), [R::ZERO; 2])),
    ("pd",
        (setpoint: R, (state, counts): &mut (pd::State<R>, i32)) -> i16 {
            *counts += 1;
            in_memory(R::PD).step(state, setpoint, *counts, 1).q15()
        },
        number::<R>(-0.4, 1.2), (pd::State::default(), 0)),
);
