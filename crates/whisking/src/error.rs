//! What is wrong with settings: one small value that names the parameter.

use core::fmt;

/// A setting that can be refused.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Parameter {
    /// Control rate, Hz.
    TickHz,
    /// Whisk frequency f_W, Hz.
    Frequency,
    /// Standard deviation σ_η of the oscillators' noise.
    Noise,
    /// A nominal gain g.
    Gain,
    /// A start state ψ.
    Start,
    /// Gain or time constant of RCP.
    Rcp,
    /// Gain or time constant of CIA.
    Cia,
    /// Corner frequency of the low-pass filter, Hz.
    Corner,
    /// A gain of the position control.
    Pd,
}

/// A setting is not finite or outside its range.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Error {
    /// Which one.
    pub parameter: Parameter,
}

impl Error {
    /// `value` when it lies within `lo..=hi` (a NaN lies nowhere), otherwise the error.
    pub(crate) fn check(parameter: Parameter, value: f64, lo: f64, hi: f64) -> Result<f64, Self> {
        if (lo..=hi).contains(&value) {
            Ok(value)
        } else {
            Err(Self { parameter })
        }
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (name, allowed) = match self.parameter {
            Parameter::TickHz => ("tick rate", "200 to 20,000 Hz"),
            Parameter::Frequency => ("whisk frequency", "0.05 to 25 Hz"),
            Parameter::Noise => ("noise", "0 to 1"),
            Parameter::Gain => ("nominal gain", "0 to 2"),
            Parameter::Start => ("start state", "-1.5 to 1.5"),
            Parameter::Rcp => (
                "RCP",
                "a gain of 0 to 100, a time constant of 1e-6 to 1e5 s",
            ),
            Parameter::Cia => (
                "CIA",
                "a gain of 0 to 100, a time constant of 1e-6 to 1e5 s",
            ),
            Parameter::Corner => ("corner frequency", "above zero, below half the tick rate"),
            Parameter::Pd => (
                "position control",
                "finite, not negative, minimum below maximum",
            ),
        };
        write!(f, "{name} out of range: allowed is {allowed}")
    }
}

impl core::error::Error for Error {}
