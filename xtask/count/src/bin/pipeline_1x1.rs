//! What a tick of one side and one whisker computes.
#![cfg_attr(target_os = "none", no_std, no_main)]

use count::format::{Parts, parts};
use count::pipeline::Pipeline;

count::program!(R, parts = parts(R::LONE),
    ("computation of 1 whisker",
        (call: u32, (parts, pipeline): &mut (&Parts<R>, Pipeline<R>)) -> u32 {
            pipeline.tick(parts, call)
        },
        |call| call, (&parts, Pipeline::new(&parts))),
);
