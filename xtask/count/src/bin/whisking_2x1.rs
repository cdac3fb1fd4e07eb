//! The whole pattern generator of two sides with a whisker each.
#![cfg_attr(target_os = "none", no_std, no_main)]

use count::arguments::Two;
use count::format::in_memory;
use count::samples::pair;
use whisking::{PatternGenerator, State};

count::program!(R,
    ("whisking 2 sides 1 whisker",
        (contact: Two<R>, state: &mut State<R, 2, 1>) {
            in_memory(R::WHISKING).step(state, [contact.0, contact.1]);
        },
        pair::<R>(0.0, 1.0), State::new(&R::START_2, 1)),
);
