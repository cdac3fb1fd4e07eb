//! An input of the network on IMP, 33-33-8 units (PSIK section 3.2.1). The
//! mean is over all inputs of a row; the worst is the last, which decides.
#![cfg_attr(target_os = "none", no_std, no_main)]

use classifiers::mlp::Mlp;
use count::networks::{Single, single};
use count::samples::spread;

static SINGLE: Mlp<33, 33, 8> = single();

count::program!(
    ("f32": "network push 33-33-8",
        (input: f32, network: &mut Single<33, 33, 8>) -> u32 { network.push(input) },
        |call| spread(call, 0.0, 1000.0) as f32, Single::new(&SINGLE)),
);
