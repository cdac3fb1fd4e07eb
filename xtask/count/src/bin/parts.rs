//! The parts of a tick.
#![cfg_attr(target_os = "none", no_std, no_main)]

use count::kernel;
use count::module::Module;
use count::samples::{Three, drives, number};
use tactile::SelfMotion;
use whisking::gate::{Cia, Gate, Rcp};
use whisking::{Fix, Integrator, MAX_SIDES, Number, filter, muscle, oscillator, pd};

count::program!(parts);

type Gates<'c, R> = (&'c Rcp<R>, &'c Cia<R>, Gate<R>, Gate<R>, R);
/// Of two seconds at 2 kHz.
const OWN_RATE: u16 = 1048;

type Own<'c, R> = (&'c oscillator::Config<R>, oscillator::State<R>, SelfMotion);
type Oscillators<'c, R> = (
    &'c oscillator::Config<R>,
    oscillator::State<R>,
    [R; MAX_SIDES],
);

fn parts() {
    each::<f32>("f32");
    each::<Fix>("fix");
}

#[inline(never)]
fn each<R: Number>(format: &str) {
    let two = Module::<R>::new(Integrator::Exact, 2, 1);
    kernel!([R] format, "h50",
        (x: R, (h50, state): &mut (&filter::Config<R>, filter::State<R>)) -> R {
            h50.process(state, x)
        },
        number::<R>(-1.0, 1.0), (&two.h50, filter::State::default()));
    kernel!([R] format, "gates z and g",
    (contact: R, (rcp, cia, z, lift, nominal): &mut Gates<R>) {
        rcp.step(z, contact);
        cia.step(lift, *nominal, contact);
    },
    number::<R>(0.0, 1.0),
    (
        two.whisking.rcp.as_ref().expect("RCP"),
        two.whisking.cia.as_ref().expect("CIA"),
        Gate::default(), Gate::default(), R::ONE,
    ));
    kernel!([R] format, "muscle",
        (at: Three<R>, (config, state): &mut (&muscle::Config<R>, muscle::State<R>)) {
            let Three(gain, before, after) = at;
            config.step(state, gain, before, after);
        },
        drives::<R>(), (&two.whisking.muscle, muscle::State::default()));
    kernel!([R] format, "pd",
        (setpoint: R, (config, state, counts): &mut (&pd::Config<R>, pd::State<R>, i32)) -> i16 {
            *counts += 1;
            config.step(state, setpoint, *counts, 1).q15()
        },
        number::<R>(-0.4, 1.2), (&two.pd, pd::State::default(), 0));
    let one = Module::<R>::new(Integrator::Exact, 1, 1);
    let start = one.start.sides.iter().map(|side| side.oscillator).collect();
    kernel!([R] format, "self-motion",
        (code: u32, (config, state, own): &mut Own<R>) -> i16 {
            let phase = config.phase(state, 0);
            own.step((code & 0x1fff) as i16, phase, OWN_RATE, true)
        },
        |call| call.wrapping_mul(0x9E37_79B9) >> 16,
        (&one.whisking.oscillators, oscillator::State::new(start), SelfMotion::new(OWN_RATE)));
    oscillators(format, "oscillators of 2 sides", &two);
    oscillators(format, "oscillator of 1 side", &one);
}

fn oscillators<R: Number>(format: &str, name: &str, module: &Module<R>) {
    let start = module.start.sides.iter();
    let state = oscillator::State::new(start.map(|side| side.oscillator).collect());
    kernel!([R] format, name,
        (_: u32, (config, state, drive): &mut Oscillators<R>) {
            config.step(state, None);
            *drive = config.drives(state);
        },
        |call| call, (&module.whisking.oscillators, state, [R::ZERO; MAX_SIDES]));
}
