//! A whole tick of an active module of one whisker.
#![cfg_attr(target_os = "none", no_std, no_main)]

use count::format::config;
use count::module::Whole;
use firmware::Config;

count::program!(R, config = config(R::LONE),
    ("tick of 1 whisker",
        (_: u32, (config, whole): &mut (&Config<R>, Whole<R>)) { whole.tick(config); },
        |call| call, (&config, Whole::new(&config))),
);
