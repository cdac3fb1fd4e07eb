//! A whole tick of an active module of twenty-four whiskers. The small
//! machine's memory does not hold that.
#![cfg_attr(target_os = "none", no_std, no_main)]

count::program!(#[cfg(not(machine = "microbit"))] R,
    ("tick of 24 whiskers",
        (_: u32, whole: &mut count::module::Whole<R, 2, 12>) { whole.tick(); },
        |call| call, count::module::Whole::new(&R::START_24)),
);
