//! The whole pattern generator of one side with a whisker.
#![cfg_attr(target_os = "none", no_std, no_main)]

use count::format::in_memory;
use count::samples::number;
use whisking::{PatternGenerator, State};

count::program!(R,
    ("whisking 1 side 1 whisker",
        (contact: R, state: &mut State<R, 1, 1>) {
            in_memory(R::WHISKING).step(state, [contact]);
        },
        number::<R>(0.0, 1.0), State::new(&R::START_1, 1)),
);
