//! What a tick of two sides with twelve whiskers each computes. The small
//! machine's memory does not hold that.
#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(not(machine = "microbit"))]
use count::{each_format, format::Format, kernel, pipeline::Pipeline};

count::program!(kernels);

fn kernels() {
    #[cfg(not(machine = "microbit"))]
    each_format!(tick);
}

#[cfg(not(machine = "microbit"))]
#[inline(never)]
fn tick<R: Format>() {
    kernel!(R: "computation of 24 whiskers",
        (call: u32, pipeline: &mut Pipeline<R, 2, 12>) -> u32 {
            pipeline.tick(call);
            pipeline.said()
        },
        |call| call, Pipeline::new(&R::START_24));
}
