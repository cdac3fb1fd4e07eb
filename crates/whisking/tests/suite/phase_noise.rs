//! The noise of eq. 5 reaches the oscillators, and as strongly as it should.
//!
//! White noise of one standard deviation σ a tick of T₀ = 1/2000 s moves each state as a random
//! walk, by a variance of σ² T₀ a second (the tick rate does not matter, and whisks are far below
//! 50 Hz). Across the unit circle ψ is pulled back; along it nothing does, so the phase of a side
//! alone walks with that variance, in rad².

use crate::settings::plain;
use whisking::{Integrator, Settings, State};

/// Mean square of the phase after ten seconds, over `SEEDS` runs of two sides.
fn variance(integrator: Integrator, tick_hz: f64) -> f64 {
    const SEEDS: u32 = 60;
    let settings = |noise| Settings {
        noise,
        ..plain(integrator, tick_hz, 2.0)
    };
    let phases = |noise, seed| {
        let config = settings(noise).build::<f64>().unwrap();
        let start = settings(noise).start::<f64>(&[[1.0, 0.0]; 2], &[&[][..]; 2]);
        let mut state = State::new(&start.unwrap(), seed);
        for _ in 0..(10.0 * tick_hz) as usize {
            config.step(&mut state, &[]);
        }
        let psi = config.oscillators.psi(&state.oscillators);
        psi.into_iter().map(|[a, b]: [f64; 2]| b.atan2(a))
    };
    let still = phases(0.0, 1).next().unwrap();
    let moved = (0..SEEDS).flat_map(|seed| phases(0.1, u64::from(seed)));
    let squares = moved.map(|phase| (phase - still).powi(2));
    squares.sum::<f64>() / f64::from(2 * SEEDS)
}

#[test]
fn the_phase_walks_with_the_variance_of_the_noise() {
    let expected = 0.1 * 0.1 / 2_000.0 * 10.0;
    // Of 120 squares the mean is within 13 per cent, one standard deviation.
    let found = variance(Integrator::Exact, 1_000.0) / expected;
    assert!((found - 1.0).abs() < 0.35, "exact: {found}");
    // The papers' limit cycle is 4.1 per cent wider, its phase steadier.
    let found = variance(Integrator::Euler, 2_000.0) / expected * 1.041_f64.powi(2);
    assert!((found - 1.0).abs() < 0.35, "Euler: {found}");
}
