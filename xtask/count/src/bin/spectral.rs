//! A sample under spectral templates, and in a bank of resonators alone; the
//! last one of a block decides.
#![cfg_attr(target_os = "none", no_std, no_main)]

use classifiers::spectral_template::{SpectralState, SpectralTemplate};
use classifiers::spectrum::{Bank, BankState, Measure};
use count::arguments::Two;
use count::samples::pair;

/// Samples in a block (LEP12: 400 ms at 2 kHz).
const BLOCK: u32 = 800;

/// Factors as of low frequencies.
const fn bank<const B: usize>() -> Bank<B> {
    let mut factors = [0.0; B];
    let mut i = 0;
    while i < B {
        factors[i] = -1e-5 * ((i + 1) * (i + 1)) as f32;
        i += 1;
    }
    Bank::from_parts(factors, B, BLOCK)
}

/// 2.5 Hz to 120 Hz.
static MEANS: [[[f32; 48]; 2]; 4] = [
    [[1.0; 48]; 2],
    [[2.0; 48]; 2],
    [[3.0; 48]; 2],
    [[4.0; 48]; 2],
];
static TEMPLATES: SpectralTemplate<'_, 2, 48, 4> =
    SpectralTemplate::new(bank(), Measure::Power, &MEANS);

/// 1 Hz to 120 Hz.
static BANK: Bank<120> = bank();

count::program!(
    ("f32": "spectral template push C=2 B=48 K=4",
        (x: Two<f32>, state: &mut SpectralState<2, 48>) -> u32 {
            let choice = TEMPLATES.push(state, &[x.0, x.1]);
            choice.map_or(0, |choice| choice.samples())
        },
        pair::<f32>(-1.0, 1.0), TEMPLATES.state()),
    ("f32": "spectrum push B=120",
        (x: Two<f32>, state: &mut BankState<120>) -> bool { BANK.push(state, x.0) },
        pair::<f32>(-1.0, 1.0), BANK.state()),
    ("f32": "spectrum power B=120",
        (_: u32, (state, powers): &mut (BankState<120>, [f32; 120])) {
            *powers = BANK.read(state, Measure::Power);
        },
        |call| call, (driven(), [0.0; 120])),
    ("f32": "spectrum magnitude B=120",
        (_: u32, (state, magnitudes): &mut (BankState<120>, [f32; 120])) {
            *magnitudes = BANK.read(state, Measure::Magnitude);
        },
        |call| call, (driven(), [0.0; 120])),
);

/// A state in which no bin is nothing, whose root would be had for less.
fn driven() -> BankState<120> {
    let mut state = BANK.state();
    for _ in 0..9 {
        BANK.push(&mut state, 1.0);
    }
    state
}
