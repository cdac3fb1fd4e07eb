//! The whole pattern generator of one side with a whisker.
#![cfg_attr(target_os = "none", no_std, no_main)]

use count::format::parts;
use count::samples::number;
use whisking::{Config, State};

count::program!(R, parts = parts::<R>(R::LONE),
    ("whisking 1 side 1 whisker",
        (contact: R, (config, state): &mut (&Config<R>, State<R>)) {
            config.step(state, &[contact]);
        },
        number::<R>(0.0, 1.0), (&parts.motion.whisking, State::new(&parts.motion.start, 1))),
);
