//! What a tick of two sides with twelve whiskers each computes. The small
//! machine's memory does not hold that.
#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(not(machine = "microbit"))]
use count::pipeline::{self, Channel, Pipeline};
#[cfg(not(machine = "microbit"))]
use count::{each_format, format::Format, kernel};
#[cfg(not(machine = "microbit"))]
use whisking::State;

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
            pipeline.tick_by(call, listen, whisk, follow)
        },
        |call| call, Pipeline::new(&R::START_24));
}

/// Not inlined, as the next two: each counts its addresses from its own part.
#[cfg(not(machine = "microbit"))]
#[inline(never)]
fn listen<R: Format>(channel: &mut Channel<R>, number: u32, strongest: R) -> (u32, R) {
    channel.listen(number, strongest)
}

#[cfg(not(machine = "microbit"))]
#[inline(never)]
fn whisk<R: Format>(state: &mut State<R, 2, 12>, contact: [R; 2]) {
    pipeline::whisk(state, contact);
}

#[cfg(not(machine = "microbit"))]
#[inline(never)]
fn follow<R: Format>(channels: &mut [[Channel<R>; 12]; 2], state: &State<R, 2, 12>) -> u32 {
    pipeline::follow(channels, state)
}
