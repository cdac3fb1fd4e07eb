//! Runs of Figs. 6 to 9 with the product's own equations in f64, as the paper
//! has them: forward Euler, 2 kHz, 2 Hz, no noise, both sides started at
//! ψ = (1, 0).

use anyhow::Result;
use whisking::{GateSettings, Integrator, Settings, State, degrees, filter};

use crate::paper::biotact::{Figure, OBSTACLES_DEG, OVERLAP_GAIN};

pub(super) const TICK_HZ: f64 = 2_000.0;
pub(super) const FREQUENCY_HZ: f64 = 2.0;
/// Ten seconds.
const RUN_TICKS: usize = 20_000;

/// A gate of the paper, whose time constant is a share of the whisk period.
fn gate((gain, whisks): (f64, f64)) -> GateSettings {
    GateSettings {
        gain,
        tau_s: whisks / FREQUENCY_HZ,
    }
}

/// θ' of both sides at each tick, degrees.
pub(super) fn run(figure: &Figure) -> Result<Vec<[f64; 2]>> {
    let settings = Settings {
        tick_hz: TICK_HZ,
        frequency_hz: FREQUENCY_HZ,
        integrator: Integrator::Euler,
        coupling: true,
        noise: 0.0,
        rcp: figure.rcp.map(gate),
        cia: figure.cia.map(gate),
    };
    let config = settings.build::<f64>()?;
    let start = settings.start(&[[1.0, 0.0]; 2], &[&[figure.gain][..]; 2]);
    let mut state = State::new(&start?, 1);
    let h50 = filter::Config::<f64>::new(filter::CORNER_HZ, TICK_HZ)?;
    let mut filters = [filter::State::default(); 2];
    let mut angles = [50.0; 2];
    let tick = |_| {
        let mut contact = [0.0; 2];
        if figure.obstacles {
            let sides = contact.iter_mut().zip(&mut filters);
            for ((contact, filter), (angle, at)) in sides.zip(angles.iter().zip(OBSTACLES_DEG)) {
                let x = (OVERLAP_GAIN * (angle - at).max(0.0)).min(1.0);
                *contact = h50.process(filter, x).abs();
            }
        }
        config.step(&mut state, &contact);
        for (angle, theta) in angles.iter_mut().zip(state.theta()) {
            *angle = degrees(theta);
        }
        angles
    };
    Ok((0..RUN_TICKS).map(tick).collect())
}
