//! The elementary functions of a tick.
#![cfg_attr(target_os = "none", no_std, no_main)]

use count::samples::{Two, number, pair};
use count::{Format, kernel};
use whisking::Fix;

count::program!(functions);

fn functions() {
    each::<f32>();
    each::<Fix>();
}

#[inline(never)]
fn each<R: Format>() {
    kernel!([R] R::NAME, "drive",
        (x: R, _: &mut ()) -> R { whisking::muscle::drive(x) },
        number::<R>(-1.5, 1.5), ());
    kernel!([R] R::NAME, "exp_neg_square",
        (x: R, _: &mut ()) -> R { x.exp_neg_square() },
        number::<R>(-1.5, 1.5), ());
    kernel!([R] R::NAME, "unit",
        (at: Two<R>, unit: &mut [R; 2]) {
            if let Some(found) = R::unit(at.0, at.1) {
                *unit = found;
            }
        },
        pair::<R>(-1.5, 1.5), [R::ZERO; 2]);
}
