//! The whole pattern generator of two sides with a whisker each, with the papers' integrators.
#![cfg_attr(target_os = "none", no_std, no_main)]

use count::arguments::Two;
use count::format::in_memory;
use count::samples::pair;
use whisking::{PatternGenerator, State};

count::program!(R,
    ("whisking 2 sides 1 whisker (euler)",
        (contact: Two<R>, state: &mut State<R, 2, 1>) {
            in_memory(R::EULER_WHISKING).step(state, [contact.0, contact.1]);
        },
        pair::<R>(0.0, 1.0), State::new(&R::EULER_START, 1)),
);
