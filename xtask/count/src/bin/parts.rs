//! The parts of a tick, with the structure-preserving integrators.
#![cfg_attr(target_os = "none", no_std, no_main)]

use count::arguments::Three;
use count::format::{Oscillators, oscillators, parts};
use count::samples::{drives, number};
use whisking::gate::{Cia, Gate, Rcp};
use whisking::{filter, muscle, pd};

type Gates<'c, R> = (&'c Rcp<R>, &'c Cia<R>, Gate<R>, Gate<R>, R);

count::program!(R, parts = parts::<R>(R::PAIR),
    ("h50",
        (x: R, (h50, state): &mut (&filter::Config<R>, filter::State<R>)) -> R {
            h50.process(state, x)
        },
        number::<R>(-1.0, 1.0), (&parts.h50, filter::State::default())),
    ("gates z and g",
        (contact: R, (rcp, cia, z, lift, nominal): &mut Gates<R>) {
            rcp.step(z, contact);
            cia.step(lift, *nominal, contact);
        },
        number::<R>(0.0, 1.0),
        (
            parts.motion.whisking.rcp.as_ref().expect("RCP"),
            parts.motion.whisking.cia.as_ref().expect("CIA"),
            Gate::default(), Gate::default(), R::ONE,
        )),
    ("muscle",
        (at: Three<R>, (config, state): &mut (&muscle::Config<R>, muscle::State<R>)) {
            let Three(gain, before, after) = at;
            config.step(state, gain, before, after);
        },
        drives::<R>(), (&parts.motion.whisking.muscle, muscle::State::default())),
    ("oscillators of 2 sides",
        (_: u32, (config, state, drive): &mut Oscillators<R>) {
            config.step(state, None);
            *drive = config.drives(state);
        },
        |call| call, oscillators(&parts)),
    ("pd",
        (setpoint: R, (config, state, counts): &mut (&pd::Config<R>, pd::State<R>, i32)) -> i16 {
            *counts += 1;
            config.step(state, setpoint, *counts, 1).q15()
        },
        number::<R>(-0.4, 1.2), (&parts.motion.servo.pd, pd::State::default(), 0)),
);
