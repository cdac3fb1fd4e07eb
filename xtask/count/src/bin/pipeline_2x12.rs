//! What a tick of two sides with twelve whiskers each computes. The small
//! machine's memory does not hold that.
#![cfg_attr(target_os = "none", no_std, no_main)]

count::program!(#[cfg(not(machine = "microbit"))] R,
    ("computation of 24 whiskers",
        (call: u32, pipeline: &mut count::pipeline::Pipeline<R, 2, 12>) -> u32 {
            pipeline.tick_apart(call)
        },
        |call| call, count::pipeline::Pipeline::new(&R::START_24)),
);
