//! What a tick of two sides with twelve whiskers each computes.
#![cfg_attr(target_os = "none", no_std, no_main)]

use count::format::Format;
use count::pipeline::Pipeline;
use count::{each_format, kernel, program};

program!(kernels);

fn kernels() {
    each_format!(tick);
}

#[inline(never)]
fn tick<R: Format>() {
    kernel!(R: "computation of 24 whiskers",
        (call: u32, pipeline: &mut Pipeline<R, 2, 12>) -> u32 {
            pipeline.tick(call);
            pipeline.said()
        },
        |call| call, Pipeline::new(&R::START_24));
}
