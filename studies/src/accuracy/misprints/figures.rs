//! Runs of the papers' figures, with one formula as printed.

use serde::Deserialize;
use whisking::gate::{Cia, Gate};
use whisking::{
    GateSettings, Integrator, PatternGenerator, Settings, State, degrees, filter, muscle,
};

use crate::accuracy::schemes::PAPERS;
use crate::paper::biotact::{FIG6, FIG9, Figure, OBSTACLES_DEG, OVERLAP_GAIN};
use crate::refused::refused;
use host_sim::Error;

/// Of all runs, Hz.
pub(crate) const TICK_HZ: f64 = PAPERS.tick_hz;
/// Whisk frequency of all runs, Hz.
pub(crate) const FREQUENCY_HZ: f64 = PAPERS.frequency_hz;
const RUN_TICKS: usize = 20_000;
/// One formula as printed; the others as read.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
pub(crate) enum Printed {
    Nothing,
    /// Eq. 7: m = f_W²/100.
    Mass,
    /// Eq. 12: contact lifts g to σ_g ζ.
    Lift,
    /// Eq. 13: g* = g + T/(τ_g (1 − g)).
    Decay,
}

/// A gate of the paper, whose time constant is a share of the whisk period.
fn gate((gain, whisks): (f64, f64)) -> GateSettings {
    GateSettings {
        gain,
        tau_s: whisks / FREQUENCY_HZ,
    }
}

/// Free whisking with CIA that nothing excites.
pub(super) const FREE: Figure = Figure {
    gain: 1.0,
    cia: FIG9.cia,
    ..FIG6
};

/// A tick: θ' in degrees, π and g of both sides.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Row {
    pub(crate) theta_deg: [f64; 2],
    pub(crate) contact: [f64; 2],
    pub(crate) g: [f64; 2],
}

/// One tick of what lifts g of a whisker above `nominal`; the share of the
/// decay is T/τ_g.
fn excite(cia: &Cia<f64>, lift: &mut Gate<f64>, nominal: f64, zeta: f64, printed: Printed) {
    let g = nominal + lift.value;
    let [mut step, mut lifted] = [nominal - g, nominal + cia.gain * zeta];
    match printed {
        Printed::Nothing | Printed::Mass => return cia.step(lift, nominal, zeta),
        Printed::Lift => lifted = cia.gain * zeta,
        Printed::Decay => step = 1.0 / (1.0 - g),
    }
    let g = (g + cia.decay.tick * step).max(lifted).clamp(0.0, 2.0);
    *lift = Gate::new(g - nominal);
}

/// Ten seconds of `figure`.
pub(crate) fn run(figure: &Figure, printed: Printed) -> Result<Vec<Row>, Error> {
    let settings = Settings {
        rcp: figure.rcp.map(gate),
        cia: figure.cia.map(gate),
        ..PAPERS.settings(Integrator::Euler)
    };
    let mut config = settings.build::<f64>().map_err(refused)?;
    let cia = config.cia.take();
    if printed == Printed::Mass {
        // h = √(k/m) T; ν = 4 √(k m) keeps 4 h.
        let h = 10.0 / (FREQUENCY_HZ * TICK_HZ);
        config.muscle = muscle::Config::Euler(muscle::Euler {
            spring: h,
            damping: 4.0 * h,
        });
    }
    let start = settings.start([[1.0, 0.0]; 2], [[figure.gain]; 2]);
    let mut state = State::<f64, 2, 1>::new(&start.map_err(refused)?, 1);
    let h50 = filter::Config::<f64>::new(filter::CORNER_HZ, TICK_HZ).map_err(refused)?;
    let mut filters = [filter::State::default(); 2];
    let tick = |_| {
        let angles = state.theta().map(|[theta]| degrees(theta));
        let mut contact = [0.0; 2];
        if figure.obstacles {
            let sides = contact.iter_mut().zip(&mut filters);
            for ((contact, filter), (angle, at)) in sides.zip(angles.iter().zip(OBSTACLES_DEG)) {
                let x = (OVERLAP_GAIN * (angle - at).max(0.0)).min(1.0);
                *contact = h50.process(filter, x).abs();
            }
        }
        let zeta = contact.iter().copied().fold(0.0, f64::max);
        if let Some(cia) = &cia {
            for whisker in state.whiskers.iter_mut().flatten() {
                excite(cia, &mut whisker.lift, figure.gain, zeta, printed);
            }
        }
        config.step(&mut state, contact);
        let gains = state.whiskers.each_ref();
        Row {
            theta_deg: state.theta().map(|[theta]| degrees(theta)),
            contact,
            g: gains.map(|[whisker]| whisker.gain()),
        }
    };
    Ok((0..RUN_TICKS).map(tick).collect())
}
