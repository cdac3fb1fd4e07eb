//! The elementary functions of a tick.
#![cfg_attr(target_os = "none", no_std, no_main)]

use count::kernel;
use count::samples::{Two, number, pair};
use whisking::{Fix, Number};

count::program!(functions);

fn functions() {
    each::<f32>("f32");
    each::<Fix>("fix");
}

#[inline(never)]
fn each<R: Number>(format: &str) {
    kernel!([R] format, "drive",
        (x: R, _: &mut ()) -> R { whisking::muscle::drive(x) },
        number::<R>(-1.5, 1.5), ());
    kernel!([R] format, "exp_neg_square",
        (x: R, _: &mut ()) -> R { x.exp_neg_square() },
        number::<R>(-1.5, 1.5), ());
    kernel!([R] format, "unit",
        (at: Two<R>, unit: &mut [R; 2]) {
            if let Some(found) = R::unit(at.0, at.1) {
                *unit = found;
            }
        },
        pair::<R>(-1.5, 1.5), [R::ZERO; 2]);
}
