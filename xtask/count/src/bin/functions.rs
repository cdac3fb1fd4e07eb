//! The elementary functions of the tick.
#![cfg_attr(target_os = "none", no_std, no_main)]

use count::arguments::Two;
use count::samples::{number, pair};

count::program!(R,
    ("drive", (x: R, _: &mut ()) -> R { whisking::muscle::drive(x) },
        number::<R>(-1.5, 1.5), ()),
    ("exp_neg_square", (x: R, _: &mut ()) -> R { x.exp_neg_square() },
        number::<R>(-1.5, 1.5), ()),
    ("unit",
        (at: Two<R>, unit: &mut [R; 2]) {
            if let Some(found) = R::unit(at.0, at.1) {
                *unit = found;
            }
        },
        pair::<R>(-1.5, 1.5), [R::ZERO; 2]),
);
