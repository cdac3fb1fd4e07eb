//! The whole pattern generator, by each integrator.
#![cfg_attr(target_os = "none", no_std, no_main)]

use count::module::Module;
use count::samples::{Two, pair};
use count::{Format, kernel};
use whisking::{Config, Fix, Integrator, State};

count::program!(whisking);

fn whisking() {
    each::<f32>();
    each::<f64>();
    each::<Fix>();
}

#[inline(never)]
fn each<R: Format>() {
    tick::<R>("whisking 2 sides 1 whisker", Integrator::Exact);
    tick::<R>("whisking 2 sides 1 whisker (euler)", Integrator::Euler);
}

fn tick<R: Format>(name: &str, integrator: Integrator) {
    let module = Module::<R>::new(integrator, 2, 1);
    kernel!([R] R::NAME, name,
        (contact: Two<R>, (config, state): &mut (&Config<R>, State<R>)) {
            config.step(state, &[contact.0, contact.1]);
        },
        pair::<R>(0.0, 1.0), (&module.whisking, State::new(&module.start, 1)));
}
