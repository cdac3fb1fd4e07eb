//! A whole tick of an active module of twenty-four whiskers. The small
//! machine's memory does not hold that.
#![cfg_attr(target_os = "none", no_std, no_main)]

count::program!(#[cfg(not(machine = "microbit"))] R, config = count::format::config(R::HEAD),
    ("tick of 24 whiskers",
        (_: u32, (config, whole): &mut (&firmware::Config<R>, count::module::Whole<R>)) {
            whole.tick(config);
        },
        |call| call, (&config, count::module::Whole::new(&config))),
);
