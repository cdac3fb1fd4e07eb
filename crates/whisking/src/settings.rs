//! Settings in physical units, and their check.

use serde::{Deserialize, Serialize};

use crate::step::Config;
use crate::{Error, Parameter, Real};
use crate::{gate, muscle, noise, oscillator, ranges};

/// How oscillators, muscles and gates are stepped.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Integrator {
    /// The papers' forward Euler, step for step.
    Euler,
    /// Structure preserving: exact linear parts, exact decays, fourth-order muscle.
    Exact,
}

/// Gain and time constant of a modulation by contact.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GateSettings {
    /// σ_z or σ_g, within [`ranges::GATE_GAIN`].
    pub gain: f64,
    /// τ_z or τ_g in seconds, within [`ranges::GATE_TAU_S`].
    pub tau_s: f64,
}

/// The pattern generator and its modulation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Settings {
    /// Control rate 1/T in Hz, within [`ranges::TICK_HZ`].
    pub tick_hz: f64,
    /// Whisk frequency f_W in Hz, within [`ranges::FREQUENCY_HZ`].
    pub frequency_hz: f64,
    /// Which integrator.
    pub integrator: Integrator,
    /// Whether the sides are coupled (eq. 4).
    pub coupling: bool,
    /// σ_η of eq. 5, within [`ranges::NOISE`]; 0 leaves the noise out.
    pub noise: f64,
    /// RCP (eq. 10); `None` leaves it out.
    pub rcp: Option<GateSettings>,
    /// CIA (eqs. 12 to 14); `None` leaves it out.
    pub cia: Option<GateSettings>,
}

impl GateSettings {
    fn check(self, parameter: Parameter) -> Result<(), Error> {
        Error::check(parameter, self.gain, &ranges::GATE_GAIN)?;
        Error::check(parameter, self.tau_s, &ranges::GATE_TAU_S)?;
        Ok(())
    }
}

impl Settings {
    /// Whisks per tick, f_W T.
    pub(crate) fn cycles(&self) -> f64 {
        self.frequency_hz / self.tick_hz
    }

    pub(crate) fn check(&self) -> Result<(), Error> {
        Error::check(Parameter::TickHz, self.tick_hz, &ranges::TICK_HZ)?;
        Error::check(
            Parameter::Frequency,
            self.frequency_hz,
            &ranges::FREQUENCY_HZ,
        )?;
        Error::check(Parameter::Noise, self.noise, &ranges::NOISE)?;
        for (gate, parameter) in [(self.rcp, Parameter::Rcp), (self.cia, Parameter::Cia)] {
            if let Some(gate) = gate {
                gate.check(parameter)?;
            }
        }
        Ok(())
    }

    /// The constants of the tick in number format `R`.
    ///
    /// # Errors
    /// The first parameter outside its range.
    pub fn build<R: Real>(&self) -> Result<Config<R>, Error> {
        self.check()?;
        let cycles = self.cycles();
        let (oscillators, muscle) = match self.integrator {
            Integrator::Euler => (
                oscillator::Config::Euler(oscillator::Euler::new(cycles, self.coupling)),
                muscle::Config::Euler(muscle::Euler::new(cycles)),
            ),
            Integrator::Exact => (
                oscillator::Config::Exact(oscillator::Exact::new(cycles, self.coupling)),
                muscle::Config::Exact(muscle::Exact::new(cycles)),
            ),
        };
        let decay = |settings: GateSettings| {
            gate::Decay::new(settings.tau_s * self.tick_hz, self.integrator)
        };
        Ok(Config {
            oscillators,
            muscle,
            peak_gain: R::from_f64(muscle::PEAK_GAIN),
            rcp: self.rcp.map(|rcp| gate::Rcp {
                decay: decay(rcp),
                gain: R::coefficient(rcp.gain),
            }),
            cia: self.cia.map(|cia| gate::Cia {
                decay: decay(cia),
                gain: R::coefficient(cia.gain),
            }),
            noise: (self.noise > 0.0)
                .then(|| noise::Config::new(self.noise, self.tick_hz))
                .transpose()?,
        })
    }
}
