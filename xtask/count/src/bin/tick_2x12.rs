//! A whole tick of an active module of twenty-four whiskers. The small
//! machine's memory does not hold that.
#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(not(machine = "microbit"))]
use count::{each_format, format::Format, kernel, module::Whole};

count::program!(kernels);

fn kernels() {
    #[cfg(not(machine = "microbit"))]
    each_format!(tick);
}

#[cfg(not(machine = "microbit"))]
#[inline(never)]
fn tick<R: Format>() {
    kernel!(R: "tick of 24 whiskers",
        (_: u32, whole: &mut Whole<R, 2, 12>) { whole.tick(); },
        |call| call, Whole::new(&R::START_24));
}
