//! The whole pattern generator, by each integrator.
#![cfg_attr(target_os = "none", no_std, no_main)]

use count::kernel;
use count::module::Module;
use count::samples::{Two, pair};
use whisking::{Config, Fix, Integrator, Number, State};

count::program!(whisking);

fn whisking() {
    each::<f32>("f32");
    each::<f64>("f64");
    each::<Fix>("fix");
}

#[inline(never)]
fn each<R: Number>(format: &str) {
    tick::<R>(format, "whisking 2 sides 1 whisker", Integrator::Exact);
    let euler = "whisking 2 sides 1 whisker (euler)";
    tick::<R>(format, euler, Integrator::Euler);
}

fn tick<R: Number>(format: &str, name: &str, integrator: Integrator) {
    let module = Module::<R>::new(integrator, 2, 1);
    kernel!([R] format, name,
        (contact: Two<R>, (config, state): &mut (&Config<R>, State<R>)) {
            config.step(state, &[contact.0, contact.1]);
        },
        pair::<R>(0.0, 1.0), (&module.whisking, State::new(&module.start, 1)));
}
