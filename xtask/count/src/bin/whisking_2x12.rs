//! The whole pattern generator of two sides with twelve whiskers each.
#![cfg_attr(target_os = "none", no_std, no_main)]

use count::arguments::Two;
use count::format::parts;
use count::samples::pair;
use whisking::{Config, State};

count::program!(R, parts = parts::<R>(R::HEAD),
    ("whisking 2 sides 12 whiskers",
        (contact: Two<R>, (config, state): &mut (&Config<R>, State<R>)) {
            config.step(state, &[contact.0, contact.1]);
        },
        pair::<R>(0.0, 1.0), (&parts.motion.whisking, State::new(&parts.motion.start, 1))),
);
