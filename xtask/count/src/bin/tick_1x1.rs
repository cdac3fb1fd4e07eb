//! A whole tick of an active module of one whisker.
#![cfg_attr(target_os = "none", no_std, no_main)]

use count::module::Whole;

count::program!(R,
    ("tick of 1 whisker",
        (_: u32, whole: &mut Whole<R, 1, 1>) { whole.tick(); },
        |call| call, Whole::new(&R::START_1)),
);
