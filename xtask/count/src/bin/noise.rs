//! The noise of the oscillators.
#![cfg_attr(target_os = "none", no_std, no_main)]

use count::format::in_memory;
use whisking::noise;

count::program!(R,
    ("noise of 2 sides",
        (_: u32, (state, out): &mut (noise::State<R, 2>, [[R; 2]; 2])) {
            *out = in_memory(R::NOISE).step(state);
        },
        |call| call, (noise::State::new(1), [[R::ZERO; 2]; 2])),
);
