//! What a tick of two sides with twelve whiskers each computes. The small
//! machine's memory does not hold that.
#![cfg_attr(target_os = "none", no_std, no_main)]

count::program!(#[cfg(not(machine = "microbit"))] R, parts = count::format::parts(R::HEAD),
    ("computation of 24 whiskers",
        (call: u32, (parts, pipeline): &mut (
            &count::format::Parts<R>,
            count::pipeline::Pipeline<R>,
        )) -> u32 {
            pipeline.tick(parts, call)
        },
        |call| call, (&parts, count::pipeline::Pipeline::new(&parts))),
);
