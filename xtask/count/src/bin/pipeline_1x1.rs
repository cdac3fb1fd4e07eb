//! What a tick of one side and one whisker computes.
#![cfg_attr(target_os = "none", no_std, no_main)]

use count::pipeline::Pipeline;

count::program!(R,
    ("computation of 1 whisker",
        (call: u32, pipeline: &mut Pipeline<R, 1, 1>) -> u32 {
            pipeline.tick(call)
        },
        |call| call, Pipeline::new(&R::START_1)),
);
