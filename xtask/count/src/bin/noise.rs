//! The noise of the oscillators.
#![cfg_attr(target_os = "none", no_std, no_main)]

use count::format::parts;
use whisking::noise;

type Noisy<'c, R> = (&'c noise::Config<R>, noise::State<R>, [[R; 2]; 2]);

count::program!(R, parts = parts::<R>(R::NOISY),
    ("noise of 2 sides",
        (_: u32, (config, state, out): &mut Noisy<R>) { *out = config.step(state); },
        |call| call,
        (
            parts.motion.whisking.noise.as_ref().expect("noise"),
            noise::State::new(2, 1), [[R::ZERO; 2]; 2],
        )),
);
