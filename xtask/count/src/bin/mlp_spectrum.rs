//! An input of the network on spectra, 120-20-4 units (LEP12 section 5.2). The
//! mean is over all inputs of a row; the worst is the last, which decides.
#![cfg_attr(target_os = "none", no_std, no_main)]

use classifiers::mlp::Mlp;
use count::networks::{Single, single};
use count::samples::spread;

static SINGLE: Mlp<120, 20, 4> = single();

count::program!(
    ("f32": "network push 120-20-4",
        (input: f32, network: &mut Single<120, 20, 4>) -> u32 { network.push(input) },
        |call| spread(call, 0.0, 1000.0) as f32, Single::new(&SINGLE)),
);
